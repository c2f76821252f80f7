"""The page's panel, control by control: the server's state after each use."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import pinik
from desk import METHODS, need_browser

URDF = Path(__file__).parents[3] / "urdf"


def test_the_robot_menu_brings_another_robot_and_keeps_the_methods(open_panel):
    desk = open_panel(view=2)
    assert desk.part("robot").locator("option").all_inner_texts() == pinik.catalog()
    desk.choose("robot", "two_link")
    state = desk.until(lambda s: s["robot"] == "two_link")
    assert [i["method"] for i in state["instances"]] == ["ccd", "jt"]
    desk.settle()
    assert desk.runs("pinik.state.robot") == "two_link"
    assert "two_link" in desk.page.title()
    assert desk.text("ball-0") == state["balls"][0]["frame"]


def test_the_root_menu_frees_the_robot(open_panel):
    desk = open_panel("two_link", view=1)
    assert desk.part("root").locator("option").all_inner_texts() == ["fixed", "free flyer", "planar"]
    for root in ("free_flyer", "planar"):
        desk.choose("root", root)
        desk.until(lambda s, root=root: s["root"] == root)
        assert desk.view.robot.root == root
        desk.shows(f"pinik.state.root === '{root}'")
        desk.settle()
    assert desk.state["robot"] == "two_link"


def test_a_robot_of_ones_own_file_is_in_the_menu_and_can_be_come_back_to(open_panel, tmp_path):
    text = (URDF / "two_link.urdf").read_text("utf-8").replace('name="two_link"', 'name="my_own_robot"')
    path = tmp_path / "mine.urdf"
    path.write_text(text, "utf-8")
    shutil.copytree(URDF / "meshes", tmp_path / "meshes")
    desk = open_panel(path, view=1)
    own = desk.state["robot"]
    assert own not in pinik.catalog()
    desk.expect("robot").to_have_value(own)
    desk.choose("robot", "arm")
    desk.until(lambda s: s["robot"] == "arm")
    desk.expect("robot").to_have_value("arm")
    desk.choose("robot", own)
    desk.until(lambda s: s["robot"] == own)
    desk.settle()


def test_the_view_buttons_show_one_two_or_four_instances(open_panel):
    desk = open_panel(view=4)
    for count in (1, 2, 4):
        desk.click(f"view-{count}")
        desk.until(lambda s, count=count: s["view"] == count and len(s["instances"]) == count)
        desk.expect(f"view-{count}").to_have_attribute("aria-pressed", "true")
        for prefix in ("instance", "method", "status", "label"):
            desk.expect(desk.page.locator(f"[data-testid^='{prefix}-']")).to_have_count(count)
        desk.settle()
    assert [desk.part(f"view-{n}").get_attribute("aria-pressed") for n in (1, 2)] == ["false", "false"]


def test_each_method_menu_changes_its_own_instance(open_panel):
    desk = open_panel(view=4)
    wanted = ["dls", "ccd", "jt", "pinv"]
    for i, method in enumerate(wanted):
        assert desk.part(f"method-{i}").locator("option").all_inner_texts() == list(METHODS)
        desk.choose(f"method-{i}", method)
        desk.until(lambda s, i=i, method=method: s["instances"][i]["method"] == method)
    state = desk.state
    assert [i["method"] for i in state["instances"]] == wanted
    for i, instance in enumerate(state["instances"]):
        desk.expect(f"instance-{i}").to_contain_text(instance["title"])
        desk.expect(f"label-{i}").to_contain_text(re.compile(f"{instance['title']}|{instance['method']}"))
        desk.expect(desk.page.locator("#table tbody tr").nth(i)).to_contain_text(wanted[i])


def test_a_click_on_a_methods_name_opens_its_parameters(open_panel):
    desk = open_panel(view=2)
    for i, instance in enumerate(desk.state["instances"]):
        parameter = next(p["name"] for p in instance["parameters"] if p["level"] == 1)
        field = desk.part(f"param-{i}-{parameter}")
        desk.expect(field).to_be_hidden()
        name = desk.part(f"instance-{i}").get_by_text(desk.state["instances"][i]["title"], exact=True)
        name.click()
        desk.expect(field).to_be_visible()
        name.click()
        desk.expect(field).to_be_hidden()


def test_the_checkbox_of_the_limits_frees_the_joints(open_panel, arm):
    desk = open_panel(methods=("dls",), running=True)
    desk.view.move_ball([-0.5, 0.0, 0.2])
    desk.part("limits").uncheck()
    assert desk.until(lambda s: not s["limits"])["limits"] is False

    def beyond(state):
        q = np.array([state["instances"][0]["angles"][name] for name in arm.joint_names])
        return ((q < arm.lower - 1e-9) | (q > arm.upper + 1e-9)).any()

    desk.until(beyond)
    desk.part("limits").check()
    desk.until(lambda s: s["limits"] and not beyond(s))


def test_motion_and_curve_menus_move_the_ball(open_panel):
    desk = open_panel(methods=("dls",), running=True)

    def place(state):
        return state["balls"][0]["position"]

    assert desk.part("motion").locator("option").all_inner_texts() == ["By hand", "Along a curve", "At random"]
    still = place(desk.state)
    for motion in ("curve", "random"):
        desk.choose("motion", motion)
        begin = place(desk.until(lambda s, motion=motion: s["motion"] == motion))
        desk.until(lambda s, begin=begin: np.linalg.norm(np.subtract(place(s), begin)) > 0.05)
    assert np.linalg.norm(np.subtract(place(desk.state), still)) > 0.01
    desk.choose("motion", "hand")
    held = place(desk.until(lambda s: s["motion"] == "hand"))
    step = desk.state["step"]
    assert place(desk.until(lambda s: s["step"] > step + 20)) == held


def test_the_curve_menu_lays_another_curve(open_panel):
    desk = open_panel("two_link", methods=("dls",), motion="curve")
    options = desk.part("curve").locator("option").evaluate_all("all => all.map(({ value }) => value)")
    assert len(options) >= 4
    paths = set()
    for curve in options:
        desk.choose("curve", curve)
        state = desk.until(lambda s, curve=curve: s["curve"] == curve)
        paths.add(str(np.round(state["balls"][0]["curve"], 6).tolist()))
        desk.shows(f"pinik.state.curve === '{curve}'")
    assert len(paths) == len(options)


def test_start_stop_step_and_reset(open_panel):
    desk = open_panel(methods=("dls",), motion="curve")
    home = desk.state["balls"][0]["position"], desk.state["instances"][0]["angles"]
    desk.expect("start").to_have_text("Start")
    for count in (1, 2, 3):
        desk.click("step")
        assert desk.until(lambda s, count=count: s["step"] == count)["running"] is False
    desk.click("start")
    desk.until(lambda s: s["running"] and s["step"] > 20)
    desk.expect("start").to_have_text("Stop")
    desk.click("start")
    stopped = desk.until(lambda s: not s["running"])["step"]
    desk.expect("start").to_have_text("Start")
    assert desk.state["step"] == stopped
    moved = desk.state
    assert (moved["balls"][0]["position"], moved["instances"][0]["angles"]) != home
    desk.click("reset")
    state = desk.until(lambda s: s["step"] == 0)
    assert (state["balls"][0]["position"], state["instances"][0]["angles"]) == home
    assert state["instances"][0]["statistics"]["steps"] == 0


def test_one_step_stops_a_running_session(open_panel):
    desk = open_panel(methods=("dls",), motion="curve", running=True)
    desk.until(lambda s: s["step"] > 3)
    desk.click("step")
    stopped = desk.until(lambda s: not s["running"])
    desk.shows("!pinik.state.running")
    desk.click("step")
    assert desk.until(lambda s: s["step"] > stopped["step"])["step"] - stopped["step"] in (1, 2)


def test_the_speed_as_a_number_and_by_the_slider(open_panel):
    desk = open_panel(methods=("dls",), motion="curve")
    desk.type("speed", 2.5)
    desk.until(lambda s: s["speed"] == 2.5)
    desk.expect("speed-slider").not_to_have_value("0")
    before = desk.value("speed-slider")
    desk.part("speed-slider").fill("100")
    low = desk.until(lambda s: s["speed"] < 1.0)["speed"]
    desk.expect("speed").to_have_value(f"{low:g}")
    desk.part("speed-slider").fill("900")
    high = desk.until(lambda s: s["speed"] > 2.5)["speed"]
    desk.expect("speed").to_have_value(f"{high:g}")
    assert 100 < before < 900


def test_iterations_until_reached_or_so_many(open_panel):
    desk = open_panel(methods=("jt",), running=True)
    desk.part("until-reached").uncheck()
    desk.until(lambda s: not s["iterations"]["until_reached"])
    desk.type("iterations", 3)
    desk.until(lambda s: s["iterations"] == {"until_reached": False, "at_most": 3})
    desk.view.move_ball([0.0, 0.0, 5.0])
    desk.until(lambda s: (mean := s["instances"][0]["statistics"]["mean_iterations"]) and 0 < mean <= 3)
    desk.part("until-reached").check()
    desk.until(lambda s: s["iterations"]["until_reached"])


def test_the_tolerance_is_typed_in_millimetres_and_degrees(open_panel):
    desk = open_panel(methods=("dls",))
    desk.expect("tolerance").to_have_value("0.1")
    desk.type("tolerance", 20)
    desk.until(lambda s: s["tolerance"]["position"] == pytest.approx(0.02))
    desk.type("tolerance-angle", 5)
    state = desk.until(lambda s: s["tolerance"]["orientation"] == pytest.approx(np.radians(5)))
    assert state["tolerance"]["position"] == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("field", "text", "kind", "value"),
    [
        ("tolerance", "0.3", "position", 0.0003),
        ("tolerance", "1.5 cm", "position", 0.015),
        ("tolerance", "2e-3m", "position", 0.002),
        ("tolerance", "0,7 mm", "position", 0.0007),
        ("tolerance", "50 µm", "position", 0.00005),
        ("tolerance-angle", "2 °", "orientation", np.radians(2)),
        ("tolerance-angle", "0.01 rad", "orientation", 0.01),
    ],
)
def test_a_tolerance_takes_its_unit_and_stays_short(open_panel, field, text, kind, value):
    desk = open_panel("two_link", methods=("dls",))
    desk.type(field, text)
    state = desk.until(lambda s: s["tolerance"][kind] != (1e-4 if kind == "position" else 1e-3))
    assert state["tolerance"][kind] == pytest.approx(value, rel=1e-11)
    if kind == "position":
        assert state["tolerance"][kind] == value  # to the last digit, so that links stay short


def test_a_tolerance_out_of_range_is_refused_in_the_unit_that_was_typed(open_panel):
    desk = open_panel("two_link", methods=("dls",))
    for text in ("2000", "3 m", "five", ""):
        desk.type("tolerance", text)
        desk.expect(desk.toasts).to_have_count(1)
        desk.expect(desk.toasts).to_contain_text(f'The tolerance must be from 0.001 to 1000 mm; got "{text}".')
        desk.toasts.get_by_role("button").click()
        desk.expect("tolerance").to_have_value("0.1")
    assert desk.state["tolerance"]["position"] == 1e-4


def test_an_emptied_coordinate_comes_back_and_the_last_ball_cannot_go(open_panel):
    desk = open_panel("two_link", methods=("dls",))
    shown = desk.part("target-x").input_value()
    desk.type("target-x", "")
    desk.expect("target-x").to_have_value(shown)
    remove = desk.part("ball-remove-0")
    desk.expect(remove).to_be_disabled()
    desk.expect(remove).to_have_attribute("title", "The last ball stays; switch it off instead")
    desk.view.send("add_effector", frame="link2")
    desk.expect(remove).to_be_enabled()


def test_polish_goes_on_within_the_tolerance(open_panel, arm):
    desk = open_panel(methods=("dls",), running=True)
    desk.expect("polish").not_to_be_checked()
    desk.part("polish").check()
    desk.until(lambda s: s["polish"])
    desk.view.move_ball(arm.placement("tip", arm.random(np.random.default_rng(4))).translation)
    desk.until(lambda s: np.linalg.norm(desk.effectors(s)[0].translation - s["balls"][0]["position"]) < 1e-8)
    desk.part("polish").uncheck()
    desk.until(lambda s: not s["polish"])


def test_a_number_out_of_range_is_refused_in_words_and_changes_nothing(open_panel):
    desk = open_panel("two_link", methods=("dls",))
    before = desk.agree()
    for field, value in [("speed", 1000), ("iterations", 0), ("tolerance", -1), ("target-x", 1e6)]:
        shown = desk.part(field).input_value()
        desk.type(field, value)
        desk.expect(desk.toasts).to_have_count(1)
        assert len(desk.toasts.inner_text().split()) >= 5, "not said in words"
        desk.toasts.get_by_role("button").click()
        desk.expect(desk.toasts).to_have_count(0)
        assert desk.state == before
        desk.expect(field).to_have_value(shown)


def test_a_notice_goes_by_itself(open_panel):
    desk = open_panel("two_link", methods=("dls",))
    desk.type("speed", 1000)
    desk.expect(desk.toasts).to_have_count(1)
    desk.runs("longTimers.splice(0).forEach((act) => act())")
    desk.expect(desk.toasts).to_have_count(0)


def test_without_a_browser_the_tests_are_skipped_unless_one_is_required(monkeypatch, tmp_path):
    monkeypatch.delenv("PINIK_REQUIRE_BROWSER", raising=False)
    with pytest.raises(pytest.skip.Exception, match="chromium"):
        need_browser(tmp_path / "chromium")
    monkeypatch.setenv("PINIK_REQUIRE_BROWSER", "1")
    with pytest.raises(pytest.fail.Exception, match="chromium"):
        need_browser(tmp_path / "chromium")
