"""The balls in the page's panel: frame, mode, position and orientation."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

from desk import METHODS
from judge import plain_placement


def ball(state, k=0):
    return state["balls"][k]


def test_a_ball_is_selected_and_leads_is_pinned_or_off(open_panel):
    desk = open_panel("lion", methods=("dls",), running=True, motion="curve", root="free_flyer")
    modes = [b["mode"] for b in desk.state["balls"]]
    assert modes == ["on", "pinned", "pinned", "pinned", "off", "off"], "the lion stands on its other paws"
    frames = [b["frame"] for b in desk.state["balls"]]
    assert [desk.text(f"ball-{k}") for k in range(len(frames))] == frames
    for k in (4, 1):
        desk.click(f"ball-{k}")
        pressed = [desk.part(f"ball-{j}").get_attribute("aria-pressed") for j in range(len(frames))]
        assert pressed == [str(j == k).lower() for j in range(len(frames))]
        for axis, coordinate in zip("xyz", ball(desk.state, k)["position"], strict=True):
            assert desk.value(f"target-{axis}") == pytest.approx(coordinate, abs=6e-4)
    desk.choose("ball-mode-4", "on")
    desk.until(lambda s: ball(s, 4)["mode"] == "on" and ball(s, 4)["curve"])
    desk.choose("ball-mode-0", "pinned")
    held = ball(desk.until(lambda s: ball(s)["mode"] == "pinned"))["position"]
    step = desk.state["step"]
    state = desk.until(lambda s: s["step"] > step + 10)
    assert ball(state)["position"] == held
    desk.choose("ball-mode-4", "off")
    desk.until(lambda s: ball(s, 4)["mode"] == "off")
    desk.expect("ball-mode-4").to_have_value("off")


def test_balls_are_added_on_free_frames_and_removed(open_panel, arm):
    desk = open_panel(methods=("dls",), running=True)
    offered = desk.part("add-effector").locator("option").evaluate_all("all => all.map(({ value }) => value)")
    assert offered[0] == ""
    assert {"bone1", "bone3", "gripper"} <= set(offered[1:]) <= set(arm.frame_names) - {"tip"}
    desk.choose("add-effector", "bone3")
    state = desk.until(lambda s: len(s["balls"]) == 2)
    assert [(b["frame"], b["mode"]) for b in state["balls"]] == [("tip", "on"), ("bone3", "on")]
    desk.expect("ball-1").to_have_text("bone3")
    desk.expect("add-effector").to_have_value("")
    desk.expect(desk.part("add-effector").locator("option[value=bone3]")).to_have_count(0)
    desk.click("ball-remove-1")
    assert desk.until(lambda s: len(s["balls"]) == 1)["balls"][0]["frame"] == "tip"
    desk.expect("ball-1").to_have_count(0)
    desk.expect("ball-remove-0").to_be_disabled()
    assert len(desk.state["balls"]) == 1


def test_a_typed_place_is_reached_by_all_four(open_panel):
    desk = open_panel(methods=METHODS, running=True)
    goal = [0.45, 0.2, 0.75]
    for axis, coordinate in zip("xyz", goal, strict=True):
        desk.type(f"target-{axis}", coordinate)
        desk.shows(f"pinik.state.balls[0].position[{'xyz'.index(axis)}] === {coordinate}")
    state = desk.until(desk.is_followed)
    assert ball(state)["position"] == goal


def test_a_place_typed_without_a_pause_arrives_as_a_whole(open_panel):
    desk = open_panel(methods=("dls",), running=True)
    desk.stop_clock()
    desk.part("target-x").fill("0.45")
    for coordinate in ("0.2", "0.75"):
        desk.page.keyboard.press("Tab")
        desk.page.keyboard.insert_text(coordinate)
    desk.page.keyboard.press("Enter")
    assert ball(desk.until(lambda s: ball(s)["position"][2] == 0.75))["position"] == [0.45, 0.2, 0.75]


def test_a_typed_place_ends_the_curve(open_panel):
    desk = open_panel(methods=("dls",), running=True, motion="curve")
    desk.type("target-z", 0.7)
    assert desk.until(lambda s: ball(s)["position"][2] == 0.7)["motion"] == "hand"
    desk.expect("motion").to_have_value("hand")


def test_an_orientation_is_asked_for_in_degrees_and_reached(open_panel):
    desk = open_panel("panda", methods=("dls",), running=True)
    desk.expect("target-roll").to_be_hidden()
    desk.part("orientation").check()
    desk.until(lambda s: ball(s)["oriented"] and s["instances"][0]["orientation_error"] is not None)
    turned = np.degrees(ball(desk.state)["rpy"])
    for name, degrees in zip(("roll", "pitch", "yaw"), turned, strict=True):
        desk.expect(f"target-{name}").to_be_visible()
        assert desk.value(f"target-{name}") == pytest.approx(degrees, abs=0.06)
    wanted = np.array([170.0, 10.0, 25.0])
    for k, name in enumerate(("roll", "pitch", "yaw")):
        desk.type(f"target-{name}", wanted[k])
        desk.shows(f"Math.abs(pinik.state.balls[0].rpy[{k}] * 180 / Math.PI - {wanted[k]}) < 1e-6")
    state = desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    (hand,) = desk.effectors(state)
    assert np.linalg.norm(pinocchio.log3(hand.rotation.T @ pinocchio.rpy.rpyToMatrix(*np.radians(wanted)))) < 1e-3
    desk.part("orientation").uncheck()
    desk.until(lambda s: not ball(s)["oriented"])
    desk.expect("target-roll").to_be_hidden()


def test_an_axis_is_left_free_and_asked_for_again(open_panel):
    desk = open_panel(methods=("dls",), running=True)
    desk.view.move_ball([9.0, -9.0, 0.6])  # out of reach, were x and y not free
    for axis, axes in (("y", "y"), ("x", "xy")):
        desk.click(f"target-{axis}-free")
        desk.until(lambda s, axes=axes: ball(s)["free"] == axes)
        desk.expect(f"target-{axis}-free").to_have_attribute("aria-pressed", "true")
    desk.expect("target-z-free").to_be_disabled()
    state = desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    (hand,) = desk.effectors(state)
    assert hand.translation[2] == pytest.approx(0.6, abs=1e-4)
    assert ball(state)["position"] == [9.0, -9.0, 0.6]
    desk.expect("status-0").to_have_text("reached")
    desk.expect("label-0").to_contain_text("reached")
    desk.type("target-z", 0.7)
    assert ball(desk.until(lambda s: ball(s)["position"][2] == 0.7))["free"] == "xy"
    for axis, axes in (("x", "y"), ("y", "")):
        desk.click(f"target-{axis}-free")
        desk.until(lambda s, axes=axes: ball(s)["free"] == axes)
    desk.until(lambda s: s["instances"][0]["status"] == "UNREACHABLE")


def test_two_axes_freed_without_a_pause_are_both_free(open_panel):
    desk = open_panel(methods=("dls",))
    desk.stop_clock()
    desk.runs("['x', 'z'].forEach((axis) => document.getElementById(`target-${axis}-free`).click())")
    desk.until(lambda s: ball(s)["free"] == "xz")


def test_all_axes_are_free_only_with_an_orientation(open_panel):
    desk = open_panel("panda", methods=("dls",), running=True)
    desk.part("orientation").check()
    desk.until(lambda s: ball(s)["oriented"])
    for axis in "xyz":
        desk.click(f"target-{axis}-free")
    desk.until(lambda s: ball(s)["free"] == "xyz" and s["instances"][0]["position_error"] is None)
    desk.expect("orientation").to_be_disabled()
    desk.click("target-y-free")
    desk.until(lambda s: ball(s)["free"] == "xz")
    desk.expect("orientation").to_be_enabled()


def test_a_ball_of_another_frame_has_free_axes_of_its_own(open_panel):
    desk = open_panel(methods=("dls",))
    desk.choose("add-effector", "bone3")
    desk.until(lambda s: len(s["balls"]) == 2)
    desk.click("ball-1")
    desk.click("target-x-free")
    state = desk.until(lambda s: ball(s, 1)["free"] == "x")
    assert ball(state, 0)["free"] == ""
    desk.click("ball-0")
    desk.expect("target-x-free").to_have_attribute("aria-pressed", "false")


def test_free_axes_are_seen_in_the_picture_and_kept_in_the_address(open_desk):
    desk = open_desk(methods=("dls",))
    pictures = []
    for axes in ("", "x", "xy", ""):
        desk.view.send("free", index=0, axes=axes)
        desk.shows(f"pinik.state.balls[0].free === '{axes}' && pinik.settled")
        pictures.append(desk.picture())
        assert ("free" in desk.address()) == bool(axes)
    changed = [(np.abs(picture - pictures[0]).max(axis=2) > 8).mean() for picture in pictures]
    assert changed[3] == 0.0
    assert 0.0005 < changed[1] < changed[2] < 0.2


def test_a_ball_with_a_free_axis_is_dragged_like_any_other(open_stage):
    desk = open_stage(methods=("dls",), running=True)
    desk.view.send("free", index=0, axes="y")
    before = ball(desk.until(lambda s: ball(s)["free"] == "y"))["position"]
    desk.settle()
    x, y = desk.ball_on_screen()
    desk.page.mouse.move(x, y)
    desk.page.mouse.down()
    desk.page.mouse.move(x - 40, y - 30, steps=4)
    desk.page.mouse.up()
    state = desk.until(lambda s: np.linalg.norm(np.subtract(ball(s)["position"], before)) > 0.01)
    assert ball(state)["free"] == "y"
    state = desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    (hand,) = desk.effectors(state)
    assert np.linalg.norm((hand.translation - ball(state)["position"])[[0, 2]]) < 1e-4


def test_a_balls_own_tolerance_is_what_the_page_calls_reached(open_panel):
    """Five joints and a pose that they reach, turned by 12 degrees."""
    desk = open_panel("so101", methods=("dls",), running=True)
    M = plain_placement(desk.view.robot, ball(desk.state)["frame"], np.full(6, 0.2))
    turned = M.rotation @ pinocchio.exp3(np.full(3, 0.12))
    desk.view.send("orientation", index=0, on=True, rpy=pinocchio.rpy.matrixToRpy(turned))
    desk.view.move_ball(M.translation)
    desk.expect("status-0").to_contain_text("short")
    desk.view.send("ball_tolerance", index=0, tolerance=[1e-4, 0.35])
    state = desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    for part in ("status-0", "label-0"):
        desk.expect(part).to_contain_text("reached")
    (hand,) = desk.effectors(state)
    assert 1e-3 < np.linalg.norm(pinocchio.log3(turned @ hand.rotation.T)) <= 0.35


def test_a_ball_that_is_moved_while_stopped_is_not_called_reached(open_panel):
    desk = open_panel(methods=("dls",))
    desk.click("step")
    desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    desk.expect("label-0").to_contain_text("reached")
    z = desk.state["balls"][0]["position"][2]
    desk.type("target-z", z - 0.25)
    state = desk.until(lambda s: s["instances"][0]["status"] == "IDLE")
    assert state["instances"][0]["position_error"] == pytest.approx(0.25, abs=2e-3)
    desk.expect("message-0").to_contain_text("no step has been taken since a ball changed")
    for part in ("label-0", "status-0"):
        desk.expect(part).to_contain_text("cm away")
    desk.click("step")
    desk.until(lambda s: s["instances"][0]["status"] == "CONVERGED")
    desk.expect("label-0").to_contain_text("reached")
