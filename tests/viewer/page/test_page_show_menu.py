"""What the picture shows besides robots and balls: the menu, the link, robots in one place, the presentation."""

from __future__ import annotations

import re
import threading

import numpy as np
import pinocchio
import pytest

from desk import METHODS, PHONE
from pinik.viewer.simulation.looks import LOOKS
from pinik.viewer.web import exhibit
from urdf_texts import joint, link, robot

MENU = [name for name in LOOKS if name != "overlay"]
PLACES = "pinik.show.cast.instances.map(({ group }) => group.position.toArray())"


def test_each_look_of_the_menu_is_kept_by_the_session_and_the_link(open_panel):
    desk = open_panel("panda", ("dls",))
    desk.click("show-menu")
    for name in MENU:
        desk.part(f"look-{name}").check()
        desk.until(lambda s, name=name: name in s["looks"])
    address = desk.address()
    assert f"looks={','.join(MENU)}" in address
    desk.shows("pinik.show.look._extras.collisions?.length > 5 && pinik.show.look._extras.reach?.length === 1")
    desk.shows("document.querySelectorAll('.names span').length > 0")
    for name in MENU:
        desk.part(f"look-{name}").uncheck()
    desk.until(lambda s: s["looks"] == [])
    desk.shows("document.querySelectorAll('.names span').length === 0")
    desk.page.keyboard.press("Escape")
    desk.expect("look-axes").to_be_hidden()
    desk.visit(desk.view, address, until="window.pinik?.ready")
    desk.until(lambda s: s["looks"] == MENU)


def test_robots_in_one_place_share_the_ball_and_have_a_legend(open_panel):
    desk = open_panel("arm", METHODS)
    desk.wait(lambda: len({tuple(place) for place in desk.runs(PLACES)}) == 4)
    desk.page.keyboard.press("0")
    desk.until(lambda s: s["looks"] == ["overlay"])
    desk.wait(lambda: len({tuple(place) for place in desk.runs(PLACES)}) == 1)
    assert desk.runs("pinik.show.ballsOnScreen().length") == 1
    assert desk.runs("pinik.show.cast.instances.map(i => i._targets.visible)") == [True, False, False, False]
    colors = desk.runs("pinik.show.cast.instances.map(i => i.robot._parts[0].fine.color.getHexString())")
    assert len(set(colors)) == 4, "the ghosts have one colour"
    desk.wait(lambda: len({desk.part(f"label-{i}").bounding_box()["x"] for i in range(4)}) == 1)
    desk.click("overlay")
    desk.until(lambda s: s["looks"] == [])
    desk.wait(lambda: len({tuple(place) for place in desk.runs(PLACES)}) == 4)
    assert desk.runs("pinik.show.cast.instances.every(i => i._targets.visible)")
    desk.click("view-1")
    desk.expect("overlay").to_be_disabled()


@pytest.mark.parametrize(("name", "root"), [("panda", "fixed"), ("tiago", "planar")])
def test_the_singular_values_are_those_of_pinocchios_jacobian(open_panel, name, root):
    desk = open_panel(name, ("dls",), root=root, setup=f"robot={name}&root={root}&looks=ellipsoid")
    machine = desk.view.robot
    desk.shows("pinik.show.cast.instances[0].note !== ''")
    state = desk.agree()
    angles = {joint: a for joint, a in state["instances"][0]["angles"].items() if joint not in machine.mimics}
    frame, q = machine.frame_id(state["balls"][0]["frame"]), machine.configuration(angles)
    J = pinocchio.computeFrameJacobian(
        machine.model, machine.model.createData(), q, frame, pinocchio.LOCAL_WORLD_ALIGNED
    )[:3]
    kept = [joint for joint in machine.joints if joint.has_one_axis and joint.leader is None]
    wanted = np.linalg.svd(J[:, [joint.idx_v for joint in kept]], compute_uv=False)
    found = [float(text) for text in re.findall(r"[\d.]+", desk.runs("pinik.show.cast.instances[0].note"))]
    np.testing.assert_allclose(found, wanted, atol=1e-3, rtol=5e-3)


def test_a_removed_balls_ellipsoid_is_removed_too(open_panel):
    desk = open_panel("lion", ("dls",), view=1, setup="robot=lion&looks=ellipsoid")
    seen = "pinik.show.cast.instances[0]._decor._ellipsoids.group.children.length"
    count = len(desk.state["balls"])
    desk.shows(f"{seen} === {count}")
    desk.view.send("remove_effector", index=0)
    desk.shows(f"{seen} === {count - 1}")


def test_a_click_keeps_automatic_framing_and_a_drag_ends_it(open_panel):
    desk = open_panel("arm", ("dls",))
    box = desk.page.locator("#canvas").bounding_box()
    x, y = box["x"] + 20, box["y"] + box["height"] - 20
    desk.page.mouse.click(x, y)
    desk.expect("camera-iso").to_have_attribute("aria-pressed", "true")
    assert not desk.runs("pinik.show.camera.moved")
    desk.page.mouse.move(x, y)
    desk.page.mouse.down()
    desk.page.mouse.move(x + 40, y, steps=4)
    desk.page.mouse.up()
    desk.shows("pinik.show.camera.moved")
    desk.expect("camera-iso").to_have_attribute("aria-pressed", "false")

    desk.expect("pointer").to_have_count(0)
    desk.type("target-x", 9)
    desk.expect("pointer").to_have_count(1)
    ball, arrow = desk.ball_on_screen(), desk.part("pointer").bounding_box()
    assert (ball[0] > box["x"] + box["width"] / 2) == (arrow["x"] + arrow["width"] / 2 > box["x"] + box["width"] / 2)
    desk.click("pointer")
    desk.expect("pointer").to_have_count(0)
    assert not desk.runs("pinik.show.camera.moved")


def test_the_camera_comes_back_with_a_ball_that_was_far_away(open_panel):
    desk = open_panel("arm", ("dls",))
    radius = "pinik.show.camera.sphere.radius"
    near = desk.runs(radius)
    desk.type("target-x", 30)
    desk.shows(f"{radius} > {5 * near}")
    desk.type("target-x", 0.3)
    desk.shows(f"{radius} < {2 * near}")


def test_an_arrow_to_a_ball_covers_no_button(open_stage):
    desk = open_stage(methods=("dls",))
    desk.settle()
    box = desk.page.locator("#canvas").bounding_box()
    desk.page.mouse.move(box["x"] + 20, box["y"] + box["height"] - 20)
    desk.page.mouse.down()
    desk.page.mouse.move(box["x"] + 40, box["y"] + box["height"] - 20, steps=4)
    desk.page.mouse.up()
    desk.shows("pinik.show.camera.moved")
    desk.type("target-z", 20)
    desk.expect("pointer").to_have_count(1)
    desk.settle()
    buttons = desk.page.locator(".views").bounding_box()
    assert desk.part("pointer").bounding_box()["y"] >= buttons["y"] + buttons["height"]


def test_the_presentation_shows_the_stage_alone_and_is_in_the_link(open_panel):
    desk = open_panel("arm", ("dls", "ccd"))
    before = desk.part("label-0").bounding_box()["height"]
    desk.page.keyboard.press("h")
    desk.expect("start").to_be_hidden()
    desk.wait(lambda: desk.page.locator("#canvas").bounding_box()["width"] == desk.runs("innerWidth"))
    desk.wait(lambda: desk.part("label-0").bounding_box()["height"] > 1.4 * before)
    desk.wait(lambda: desk.page.url.endswith("&present=on"))
    desk.visit(desk.view, desk.page.url.partition("#")[2], until="window.pinik?.ready")
    desk.expect("start").to_be_hidden()
    assert desk.toasts.count() == 0, "the session was told of the presentation"
    desk.page.keyboard.press("w")
    desk.shows("document.fullscreenElement === document.documentElement")
    desk.page.keyboard.press("w")
    desk.shows("document.fullscreenElement === null")
    desk.page.keyboard.press("?")
    desk.page.keyboard.press("Escape")
    desk.expect("start").to_be_hidden()
    desk.page.keyboard.press("Escape")
    desk.expect("start").to_be_visible()
    desk.wait(lambda: "present" not in desk.page.url)


def test_what_belongs_to_the_tab_is_in_its_link(open_panel):
    desk = open_panel("arm", ("dls", "ccd"))
    desk.view.send("orientation", index=0, on=True, rpy=[0, 0, 0])
    desk.click("teach")
    desk.click("tab-lessons")
    desk.click("ring-world")
    desk.wait(lambda: {"learn=lessons", "rings=world"} <= set(desk.page.url.partition("#")[2].split("&")))
    link = desk.page.url.partition("#")[2]
    desk.visit(desk.view, link.replace("motion=hand", "motion=curve"), until="window.pinik?.ready")
    desk.until(lambda s: s["motion"] == "curve")
    desk.expect("tab-lessons").to_have_attribute("aria-selected", "true")
    desk.expect("ring-world").to_have_attribute("aria-pressed", "true")
    assert desk.toasts.count() == 0, "the session was told of what belongs to the tab"
    desk.click("teach-close")
    desk.wait(lambda: "learn" not in desk.page.url)
    desk.visit(desk.view, "learn=nothing", until="window.pinik?.ready")
    desk.expect("teach-drawer").to_be_hidden()


def test_captions_cover_no_ball(open_stage):
    desk = open_stage("lion", METHODS, root="free_flyer", motion="curve")
    stage = desk.page.locator("#canvas").bounding_box()
    chips = [desk.part(f"label-{i}").bounding_box() for i in range(4)]
    for ball in desk.runs("pinik.show.ballsOnScreen().map(({ at, radius }) => [at.x, at.y, radius])"):
        x, y, radius = ball[0] + stage["x"], ball[1] + stage["y"], ball[2]
        for chip in chips:
            dx = max(chip["x"] - x, 0, x - chip["x"] - chip["width"])
            dy = max(chip["y"] - y, 0, y - chip["y"] - chip["height"])
            assert np.hypot(dx, dy) > radius, f"{chip} covers the ball at {x}, {y}"


@pytest.mark.parametrize("size", [{"width": 1280, "height": 800}, {"width": 2560, "height": 1440}], ids=str)
def test_the_dock_leaves_the_height_to_the_robots(open_panel, size):
    desk = open_panel("two_link", METHODS, viewport=size)
    desk.wait(lambda: desk.page.locator(".dock").bounding_box()["height"] < 0.22 * size["height"])


def test_a_phones_document_ends_where_the_page_ends(open_panel):
    desk = open_panel("two_link", ("dls",), viewport=PHONE, has_touch=True, is_mobile=True)
    assert desk.runs("document.documentElement.scrollHeight <= innerHeight")


def test_a_menu_of_many_robots_is_searched_by_typing(open_panel):
    desk = open_panel("arm", ("dls",))
    desk.part("robot").focus()
    desk.page.keyboard.press("Enter")
    desk.part("robot-search").fill("two li")
    assert desk.page.locator(".finder[open] li").all_inner_texts() == ["two_link"]
    desk.page.keyboard.press("Enter")
    desk.until(lambda s: s["robot"] == "two_link")
    desk.part("robot").click()
    desk.part("robot-search").fill("no such robot")
    desk.page.keyboard.press("Enter")
    desk.expect("robot-search").to_be_hidden()
    assert desk.state["robot"] == "two_link"


def test_captions_say_that_shapes_are_loading(open_panel, monkeypatch):
    there = threading.Event()
    make = exhibit.shapes_of
    monkeypatch.setattr(exhibit, "shapes_of", lambda machine: there.wait() and make(machine))
    try:
        desk = open_panel("arm", ("dls",), until="window.pinik?.drawn === 'skeleton'")
        desk.expect("label-0").to_contain_text("loading its shapes")
        desk.expect(desk.page.locator("#loading-words")).to_have_text("Loading the shapes of arm …")
    finally:
        there.set()
    desk.settle()
    desk.expect("label-0").not_to_contain_text("loading")
    desk.expect(desk.page.locator("#loading")).to_be_hidden()


def test_a_robot_that_is_all_black_is_drawn_in_greys_and_a_notice_says_so(open_panel, tmp_path):
    black = (
        '<visual><geometry><box size="0.1 0.1 0.3"/></geometry><material name="m"><color rgba="0 0 0 1"/></material>'
    )
    file = tmp_path / "night.urdf"
    file.write_text(
        robot(link("base", f"{black}</visual>"), link("tip", f"{black}</visual>"), joint("j", "base", "tip"))
    )
    desk = open_panel(file, ("dls",))
    desk.expect(desk.toasts).to_contain_text("black")
    desk.expect("warnings").to_be_visible()
    assert desk.runs("pinik.show.cast.instances[0].robot._parts.every(({ fine }) => fine.color.r > 0.1)")


def test_a_lost_connection_says_how_to_start_again(open_panel):
    desk = open_panel("two_link", ("dls",))
    desk.faults.excuse("WebSocket")
    desk.view.close()
    desk.expect("banner").to_contain_text(f"pinik live two_link --port {desk.view.port}")
    desk.wait(lambda: float(desk.runs("getComputedStyle(document.querySelector('.panel')).opacity")) < 0.6)


def test_a_lost_connection_names_the_path_of_ones_own_file(open_panel, tmp_path):
    file = tmp_path / "my arm.urdf"
    file.write_text(robot(link("base"), link("tip"), joint("turn", "base", "tip")))
    desk = open_panel(file, ("dls",), watch=True)
    desk.faults.excuse("WebSocket")
    desk.view.close()
    desk.expect("banner").to_contain_text(f"pinik live '{file}' --watch --port {desk.view.port}")


def test_a_lost_connection_names_no_command_for_a_robot_without_a_file(open_panel):
    desk = open_panel(robot(link("base"), link("tip"), joint("turn", "base", "tip")), ("dls",))
    desk.faults.excuse("WebSocket")
    desk.view.close()
    desk.expect("banner").to_contain_text("start it again where you started it.")
    assert desk.part("banner").locator("code").count() == 0
