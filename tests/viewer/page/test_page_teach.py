"""The drawer to teach with in a real browser: explanations, race, lessons, the thesis's table; and larger charts."""

from __future__ import annotations

import re

import numpy as np
import pinocchio
import pytest

from judge import plain_placement
from pinik.model.home import home_configuration
from pinik.viewer.protocol.lessons import LESSONS
from pinik.viewer.protocol.setup import read_setup

PLACE = [0.45, 0.25, 0.75]


def error_in_millimetres(text):
    number, unit = re.search(r"Next: ([\d.]+) (cm|mm)", text).groups()
    return float(number) * {"cm": 10, "mm": 1}[unit]


def test_one_iteration_after_the_other_by_key(open_panel):
    desk = open_panel(methods=("dls",))
    desk.view.move_ball(PLACE)
    desk.page.keyboard.press("e")
    desk.expect("teach-drawer").to_be_visible()
    text = desk.page.get_by_test_id("explain-errors")
    desk.expect("explain-errors").to_contain_text("promises")
    before = error_in_millimetres(text.inner_text())
    step = desk.state["step"]
    desk.page.keyboard.press(".")
    desk.wait(lambda: error_in_millimetres(text.inner_text()) < before / 2)
    assert desk.state["step"] == step
    desk.page.keyboard.press("e")
    desk.expect("teach-drawer").to_be_hidden()
    desk.page.keyboard.press(".")
    desk.until(lambda s: s["step"] == step + 1)


def test_singular_values_in_the_drawer_are_numpys(open_panel, arm):
    desk = open_panel(methods=("dls", "pinv"))
    desk.view.move_ball(PLACE)
    desk.click("teach")
    desk.expect("explain-errors").to_contain_text("promises")
    home = home_configuration(arm)
    data = arm.model.createData()
    J = pinocchio.computeFrameJacobian(
        arm.model, data, home, arm.model.getFrameId("tip"), pinocchio.LOCAL_WORLD_ALIGNED
    )
    sigma = np.linalg.svd(J[:3], compute_uv=False)
    shown = desk.page.locator(".explained .bars").nth(0).inner_text()
    found = [float(number) for number in re.findall(r"= ([\d.]+) m", shown)]
    np.testing.assert_allclose(found, sigma, rtol=5e-3)
    error = np.linalg.norm(np.array(PLACE) - plain_placement(arm, "tip", home).translation)
    assert float(re.search(r"λ = ([\d.]+) m", desk.text("explain-value"))[1]) == pytest.approx(
        np.sqrt(0.5) * error, rel=5e-3
    )
    dots = desk.page.locator(".gain .dot")
    assert dots.count() == 3
    assert desk.page.locator("[data-testid=formulas] math").count() == 2
    assert desk.page.locator("[data-testid=formulas] mfrac").first.bounding_box()["height"] > 15
    desk.click("explain-1")
    desk.expect("explain-value").to_contain_text("τ")
    cells = desk.page.locator(".heat i")
    assert cells.count() == 3 * 12 + 3 + 12
    shown = cells.first.get_attribute("title")
    assert float(re.search(r"[+−]([\d.]+)", shown)[1]) == pytest.approx(abs(J[0, 0]), rel=5e-3)
    assert desk.page.locator(".heat .column").first.inner_text() == "bone1_x"


def test_the_turns_of_a_sweep_play_slowly_in_the_scene(open_panel):
    desk = open_panel(methods=("ccd",))
    desk.view.move_ball(PLACE)
    desk.click("teach")
    rows = desk.page.locator("[data-testid=turns] li")
    desk.wait(lambda: rows.count() == 12)
    assert rows.first.inner_text().startswith("bone6_z")
    marks = "pinik.viewer.scene.getObjectByName('turn marks').children.map((mesh) => mesh.visible)"
    desk.shows(f"{marks}.some(Boolean)")
    desk.click("replay")
    desk.expect("replay").to_have_text("Stop")
    desk.shows("document.querySelectorAll('[data-testid=turns] li')[1].className === 'now'")
    desk.click("teach-close")
    desk.shows(f"!{marks}.some(Boolean)")


def test_a_race_names_who_arrived_first_and_its_card_is_copied(open_panel):
    desk = open_panel(methods=("ccd", "dls"))
    desk.click("teach")
    desk.click("tab-race")
    desk.click("race-ten")
    desk.expect("race-card").to_contain_text("pinik race: arm, tip, 10 random places")
    desk.expect("race-words").to_contain_text("arrived first at")
    table = desk.page.get_by_test_id("race-table")
    assert table.locator("tbody tr").count() == 11
    assert table.locator(".first").count() == 10
    firsts = [int(text) for text in table.locator(".total td").all_inner_texts()]
    assert sum(firsts) == 10
    desk.page.evaluate("navigator.clipboard.writeText = async (text) => { window.copied = text; }")
    desk.click("race-copy")
    desk.shows("window.copied?.startsWith('pinik race: arm')")
    desk.click("race-watch")
    desk.until(lambda s: any("between two iterations" in i["message"] for i in s["instances"]))
    desk.until(lambda s: s["instances"][1]["status"] == "CONVERGED")


def test_a_race_is_watched_only_by_those_who_ran_it(open_panel):
    desk = open_panel(methods=("ccd", "dls"))
    desk.click("teach")
    desk.click("tab-race")
    desk.click("race-here")
    desk.expect("race-card").to_contain_text("pinik race: arm, tip")
    desk.expect("race-watch").to_be_enabled()
    desk.choose("method-0", "jt")
    desk.expect("race-watch").to_be_disabled()
    desk.choose("method-0", "ccd")
    desk.expect("race-watch").to_be_enabled()
    desk.choose("robot", "panda")
    desk.expect("race-watch").to_be_disabled()
    desk.choose("ball-mode-0", "off")
    desk.until(lambda s: s["robot"] == "panda" and s["balls"][0]["mode"] == "off")
    desk.click("race-here")
    desk.expect("toasts").to_contain_text("a race needs a ball that is on")
    desk.expect("race-words").to_contain_text("Every method solves from the same pose")
    desk.expect("race-here").to_be_enabled()


def test_lessons_are_links_that_open_their_scenes(open_panel):
    desk = open_panel(methods=("dls",))
    desk.click("teach")
    desk.click("tab-lessons")
    links = desk.page.locator(".lessons a")
    assert [link.get_attribute("href") for link in links.all()] == [f"#{one.setup}" for one in LESSONS.values()]
    desk.click("lesson-curl")
    asked = read_setup(LESSONS["curl"].setup)
    state = desk.until(lambda s: s["running"] and s["view"] == 2)
    assert [one["method"] for one in state["instances"]] == ["ccd", "dls"]
    assert read_setup(desk.address())["methods"] == asked["methods"]
    desk.click("lesson-two-bones")
    desk.until(lambda s: s["robot"] == "two_link" and s["running"])


def test_robots_with_one_method_are_told_apart_everywhere(open_panel):
    desk = open_panel(methods=("dls",))
    desk.click("teach")
    desk.click("tab-lessons")
    desk.click("lesson-damping")
    names = [f"dls, λ\u00a0=\u00a0{damping}" for damping in ("0.001", "0.05", "0.3", "2")]
    for k, name in enumerate(names):
        desk.expect(f"label-{k}").to_contain_text(name)
        desk.expect(desk.part(f"instance-{k}").locator(".method-name")).to_have_text(name)
        desk.expect(desk.page.locator("#table th[scope=row]").nth(k)).to_contain_text(name)
    desk.click("tab-race")
    desk.click("race-ten")
    desk.expect("race-card").to_contain_text("dls, λ = 0.001")
    assert desk.page.locator("[data-testid=race-table] thead th").all_inner_texts() == ["", *names]
    assert_whole(desk, "[data-testid=race-table] :is(th, td)")
    desk.click("tab-explain")
    assert [desk.text(f"explain-{k}") for k in range(4)] == names
    assert_whole(desk, "[data-testid^=explain-]")
    desk.choose("method-1", "ccd")
    desk.expect(desk.part("instance-1").locator(".method-name")).to_have_text("Cyclic coordinate descent")


@pytest.mark.parametrize("width", [1280, 1920, 2560])
def test_nothing_is_cut_beside_the_drawer(open_panel, width):
    desk = open_panel(viewport={"width": width, "height": width * 9 // 16})
    desk.click("teach")
    desk.expect("tab-explain").to_be_visible()
    assert_whole(desk, ".panel label > span, .method-name, .legend li, [role=tab], .views button")
    sizes = desk.runs("[...document.querySelectorAll('.panel h2, [role=tab]')].map((e) => e.offsetHeight * "
                      "(e.currentCSSZoom ?? 1))")  # fmt: skip
    assert min(sizes) > 15 * width / 1600, "it can be read from the back of a room"


def assert_whole(desk, found):
    """Each of these elements is as wide as its text, and nothing that does not scroll cuts it."""
    cut = desk.page.evaluate(
        """found => [...document.querySelectorAll(found)].filter((e) => e.checkVisibility()).filter((e) => {
            if (!e.children.length && e.scrollWidth > e.parentElement.clientWidth + 1) return true;
            const box = e.getBoundingClientRect();
            for (let around = e.parentElement; around !== document.body; around = around.parentElement) {
                const { overflowX, overflowY } = getComputedStyle(around);
                const { left, right, top, bottom } = around.getBoundingClientRect();
                if (overflowX !== "visible" && (box.left < left - 1 || box.right > right + 1)) return true;
                if (/auto|scroll/.test(overflowY)) return false;
                if (overflowY !== "visible" && (box.top < top - 1 || box.bottom > bottom + 1)) return true;
            }
            return false;
        }).map((e) => e.textContent)""",
        found,
    )
    assert cut == []


def test_table_4_1_fills_while_a_comparison_runs(open_panel):
    desk = open_panel(methods=("dls",))
    desk.click("teach")
    desk.click("tab-thesis")
    desk.expect("walk-1-dls-iterations").to_have_text("–")
    desk.click("comparison-1")
    for method in ("ccd", "jt", "pinv", "dls"):
        desk.expect(f"walk-1-{method}-time").to_contain_text("s")
        desk.expect(f"walk-1-{method}-efficiency").to_contain_text("%")
    desk.expect("walk-2-dls-efficiency").to_have_text("–")
    desk.page.get_by_test_id("limits").click()
    desk.expect("thesis-words").to_contain_text("A setting has changed")
    desk.click("comparison-3")
    desk.expect("walk-3-ccd-efficiency").to_contain_text("%")
    desk.expect("walk-1-ccd-efficiency").to_contain_text("%")


def test_a_chart_grows_on_a_click_and_says_values(open_panel):
    desk = open_panel(methods=("ccd", "dls"), motion="curve", running=True)
    chart = desk.page.get_by_test_id("time-chart")
    small = chart.bounding_box()
    chart.click()
    desk.wait(lambda: chart.bounding_box()["width"] > 3 * small["width"])
    large = chart.bounding_box()
    legend = desk.page.locator("figure.grown .legend")
    desk.page.mouse.move(large["x"] + large["width"] - 40, large["y"] + large["height"] / 2)
    desk.wait(lambda: re.fullmatch(r"ccd[\d.]+ [µm]s\s*dls[\d.]+ [µm]s", legend.inner_text().replace("\n", "")))
    desk.page.keyboard.press("Escape")
    desk.wait(lambda: chart.bounding_box() == small)
    desk.page.get_by_test_id("grow-error-chart").press("Enter")
    desk.wait(lambda: desk.page.locator("figure.grown [data-testid=error-chart]").count() == 1)
    desk.page.keyboard.press("Escape")


@pytest.mark.parametrize("tab", ["explain", "race", "lessons", "thesis"])
def test_the_tabs_work_by_keyboard(open_panel, tab):
    desk = open_panel(methods=("dls",))
    desk.click("teach")
    order = ["explain", "race", "lessons", "thesis"]
    desk.page.get_by_test_id("tab-explain").focus()
    for _ in range(order.index(tab)):
        desk.page.keyboard.press("ArrowRight")
    desk.shows(f"document.activeElement.id === 'tab-{tab}'")
    shown = desk.page.locator("[role=tabpanel]:visible")
    assert shown.count() == 1
    assert shown.get_attribute("aria-labelledby") == f"tab-{tab}"
