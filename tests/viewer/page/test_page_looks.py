"""The page's looks: pictures are not empty and move; dark and light, wide and narrow; every input has a name."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from desk import HALF, METHODS, PHONE, WIDE

WAIT_FOR_PICTURES = """async (count) => {
    for (let k = 0; k < count; k++) await new Promise(requestAnimationFrame);
}"""


def unlike_background(picture):
    """The fraction of a picture that differs from its own upper edge, column by column."""
    return (np.abs(picture - picture[:1]).max(axis=2) > 40).mean()


def luminance(picture):
    return float((picture @ np.array([0.2126, 0.7152, 0.0722])).mean())


def whole(desk):
    return np.asarray(Image.open(io.BytesIO(desk.page.screenshot())).convert("RGB")).astype(int)


def still_picture(desk):
    """The canvas once it has stopped changing and has been drawn in full detail."""
    pictures = []

    def look():
        frames, settled = desk.runs("[pinik.frames, pinik.settled]")
        pictures[:] = [desk.picture()]
        return settled and desk.runs("pinik.frames") == frames

    desk.wait(look)
    return pictures[0]


def test_a_robot_is_drawn_with_its_own_shapes_and_colours(open_desk):
    desk = open_desk("panda", ("dls",), viewport=HALF)
    picture = still_picture(desk)
    assert 0.01 < unlike_background(picture) < 0.9
    assert len(np.unique((picture // 16).reshape(-1, 3), axis=0)) > 30, "hardly any colours"


def test_a_running_picture_moves_and_a_stopped_one_stands(open_desk):
    desk = open_desk(methods=("dls", "ccd"), motion="curve", running=True, viewport=HALF)
    first = desk.picture()
    desk.wait(lambda: (np.abs(desk.picture() - first).max(axis=2) > 40).sum() > 100)
    desk.click("start")
    desk.until(lambda s: not s["running"])
    desk.agree()
    desk.settle()

    picture, frames = still_picture(desk), desk.runs("pinik.frames")
    desk.page.evaluate(WAIT_FOR_PICTURES, 40)  # chances to draw
    assert desk.runs("pinik.frames") == frames
    assert (desk.picture() == picture).all()


def test_more_instances_show_more_robots(open_desk):
    desk = open_desk(methods=METHODS, view=1, viewport=HALF)
    dark = []
    for count in (1, 4):
        desk.click(f"view-{count}")
        desk.until(lambda s, count=count: s["view"] == count)
        desk.shows(f"pinik.state.view === {count}")
        desk.settle()
        red = (np.abs(still_picture(desk) - [216, 31, 47]) < 60).all(axis=2).any(axis=0)
        dark.append((np.diff(red.astype(int)) == 1).sum())
    assert dark[1] > dark[0] >= 1


def test_the_system_and_the_button_make_it_dark(open_desk):
    desk = open_desk(methods=("dls",), color_scheme="dark")
    corner = (slice(0, 40), slice(-60, -10))
    assert luminance(desk.picture()[corner]) < 60
    assert luminance(whole(desk)[:, -10:]) < 60
    desk.page.emulate_media(color_scheme="light")
    desk.wait(lambda: luminance(desk.picture()[corner]) > 170)
    assert luminance(whole(desk)[:, -10:]) > 200
    desk.click("theme")
    desk.click("theme")
    desk.wait(lambda: luminance(desk.picture()[corner]) < 60)
    desk.page.reload()
    desk.shows("window.pinik?.ready")
    assert luminance(desk.picture()[corner]) < 60, "the choice was forgotten"


@pytest.mark.parametrize(("size", "touch"), [(WIDE, False), (PHONE, True)], ids=["1280x720", "390x844"])
def test_nothing_is_cut_off(open_desk, size, touch):
    desk = open_desk("lion", METHODS, viewport=size, has_touch=touch, is_mobile=touch)
    assert desk.runs("innerWidth") == size["width"], "the page made itself wider than the screen"
    assert desk.runs("[document.documentElement, document.body, ...document.querySelectorAll('.app, .panel, .stage')]"
                     ".every(e => e.scrollWidth <= e.clientWidth)")  # fmt: skip
    box = desk.page.locator("#canvas").bounding_box()
    assert box["width"] >= 0.5 * size["width"]
    assert box["height"] >= 230
    assert unlike_background(still_picture(desk)) > 0.01
    cut = desk.runs(
        """[...document.querySelectorAll(".panel :is(button, select, input, summary), .views button")]
            .filter((e) => e.checkVisibility({ visibilityProperty: true }))
            .filter((e) => {
                e.scrollIntoView({ block: "center", inline: "nearest" });
                const { left, right, top, bottom, width, height } = e.getBoundingClientRect();
                const at = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
                const covered = !(at && (e === at || e.contains(at) || at.closest("label")?.contains(e)));
                return left < 0 || right > innerWidth + 0.5 || width < 8 || height < 8 || covered;
            })
            .map((e) => e.outerHTML.slice(0, 160))"""
    )
    assert cut == []


def test_the_labels_do_not_cover_each_other_nor_leave_the_picture(open_stage):
    desk = open_stage(methods=METHODS)

    def well_placed():
        stage = desk.page.locator("#canvas").bounding_box()
        boxes = [desk.part(f"label-{i}").bounding_box() for i in range(4)]
        left, right = min(b["x"] for b in boxes), max(b["x"] + b["width"] for b in boxes)
        inside = left >= stage["x"] - 1 and right <= stage["x"] + stage["width"] + 1
        return inside and not any(overlap(a, b) for i, a in enumerate(boxes) for b in boxes[:i])

    for size in (WIDE, PHONE, {"width": 900, "height": 600}):
        desk.page.set_viewport_size(size)
        desk.settle()
        desk.wait(well_placed)
    box = desk.page.locator("#canvas").bounding_box()
    desk.page.mouse.move(box["x"] + 20, box["y"] + box["height"] - 20)
    desk.page.mouse.down()
    for k in range(1, 7):  # until the robots stand behind each other
        desk.page.mouse.move(box["x"] + 20 + 0.25 * k / 6 * box["height"], box["y"] + box["height"] - 20)
        desk.wait(well_placed)
    desk.page.mouse.up()


def overlap(a, b):
    return all(a[x] < b[x] + b[size] - 1 and b[x] < a[x] + a[size] - 1 for x, size in (("x", "width"), ("y", "height")))


def test_everything_that_can_be_operated_has_a_name_to_be_read_aloud(open_panel):
    desk = open_panel("arm", METHODS)
    for i in range(4):
        desk.part(f"parameters-{i}").locator("summary").click()
    desk.click("level-0-all")
    desk.choose("param-0-stiffness", "bone3_x")
    desk.part("orientation").check()
    desk.expect("param-0-stiffness-bone3_x").to_be_visible()
    desk.expect("target-yaw").to_be_visible()
    desk.type("speed", 1e6)
    desk.expect(desk.toasts).to_have_count(1)
    session = desk.page.context.new_cdp_session(desk.page)
    operated = {"button", "combobox", "spinbutton", "slider", "checkbox", "link", "textbox", "DisclosureTriangle"}
    found, nameless = 0, []
    for node in session.send("Accessibility.getFullAXTree")["nodes"]:
        if not node["ignored"] and node["role"]["value"] in operated:
            found += 1
            if not node.get("name", {}).get("value", "").strip():
                nameless.append(node)
    assert found > 60
    assert nameless == []
    assert desk.page.locator("h1").count() == 1
    assert desk.runs("document.documentElement.lang") == "en"
    ids = desk.runs("[...document.querySelectorAll('[id]')].map(({ id }) => id)")
    assert len(ids) == len(set(ids))
    testids = desk.runs("[...document.querySelectorAll('[data-testid]')].map(e => e.dataset.testid)")
    assert len(testids) == len(set(testids))


def test_meshcats_one_command_that_evaluates_text_does_nothing_here(open_stage):
    desk = open_stage("two_link", ("dls",))
    desk.runs("pinik.viewer.set_control('evil', 'window.evil = 1')")
    assert desk.runs("window.evil === undefined")


def test_no_figure_of_the_statistics_is_cut_short(open_stage):
    """With the widest texts that a row can contain, at every width. The iterations are the page's own."""
    desk = open_stage("two_link", ("two_bone", "ccd", "jt", "dls"), viewport=WIDE)
    desk.expect("status-0").to_be_visible()
    widest = [None, "0.85 mm short", "87.1 µs", None, "98.3 %", "0.099 mm", "44.4°"]
    for width, height in ((2560, 1440), (1920, 1080), (1280, 800), (1110, 800), (900, 800), (762, 800), (390, 800)):
        desk.page.set_viewport_size({"width": width, "height": height})
        cut = desk.page.evaluate(
            """texts => {
                const cells = [...document.querySelector("#table tbody tr").cells];
                cells.forEach((cell, k) => texts[k] && cell.replaceChildren(texts[k]));
                const room = document.querySelector(".figures").getBoundingClientRect();
                const isCut = (cell) => {
                    const box = cell.getBoundingClientRect();
                    const hides = getComputedStyle(cell).overflow !== "visible" && cell.scrollWidth > cell.clientWidth;
                    return hides || !box.width || box.left < room.left - 1 || box.right > room.right + 1;
                };
                return cells.filter(isCut).map((cell) => cell.textContent);
            }""",
            widest,
        )
        assert cut == [], f"{width} px"
        assert desk.runs("document.documentElement.scrollWidth") <= width
        assert width < 1280 or desk.part("engine-1").is_visible()
