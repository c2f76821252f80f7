"""The balls in the page's panel: frame, mode, position and orientation."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

from desk import METHODS


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
    desk.click("ball-remove-0")
    desk.expect(desk.toasts).to_contain_text("last ball")
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
