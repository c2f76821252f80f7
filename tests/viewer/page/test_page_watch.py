"""A robot's file is edited while the page shows it: camera and angles stay, and a fault is said in words."""

from __future__ import annotations

import math

import pytest

from urdf_texts import joint, link, robot

BAR = '<visual><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.05 0.05"/></geometry></visual>'


def arm(length: float, limit: float = 3.0) -> str:
    bounds = f'<limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/>'
    return robot(
        link("base", BAR), link("one", BAR), link("tip"),
        joint("turn", "base", "one", '<origin xyz="0 0 0.3"/>', limit=bounds),
        joint("end", "one", "tip", f'<origin xyz="{length} 0 0"/>', kind="fixed", limit=""),
    )  # fmt: skip


def test_camera_and_angles_stay_and_a_fault_is_said_over_the_last_good_robot(open_stage, tmp_path):
    path = tmp_path / "own.urdf"
    path.write_text(arm(0.4))
    desk = open_stage(path, methods=("dls",), running=True, view=1, watch=True)
    desk.part("joints").locator("summary").click()
    desk.type("joint-number-turn", 100)
    desk.until(lambda s: s["instances"][0]["angles"]["turn"] == pytest.approx(math.radians(100)))
    desk.runs("pinik.show.camera._take()")  # as a drag does
    where = "pinik.viewer.camera.position.toArray()"
    camera = desk.runs(where)
    generation = desk.state["generation"]

    path.write_text(arm(0.7))
    state = desk.until(lambda s: s["generation"] == generation + 1)
    assert state["instances"][0]["angles"]["turn"] == pytest.approx(math.radians(100))
    assert math.hypot(*state["balls"][0]["position"][:2]) == pytest.approx(0.7, abs=1e-3)
    desk.shows(f"pinik.state.generation === {generation + 1} && pinik.drawn === 'shapes'")
    assert desk.runs(where) == pytest.approx(camera)

    path.write_text(arm(0.7).replace('<child link="tip"/>', '<child link="top"/>'))
    desk.expect("watched").to_contain_text("top")
    desk.expect("watched").to_contain_text("You see the robot as it last was")
    assert desk.state["generation"] == generation + 1
    assert desk.runs("pinik.drawn") == "shapes"

    path.write_text(arm(0.7, limit=1.0))
    desk.expect("watched").to_have_text("own.urdf is good again.")
    state = desk.until(lambda s: s["generation"] == generation + 2)
    assert state["instances"][0]["angles"]["turn"] == pytest.approx(1.0), "inside the new limits"
    desk.expect("watched").to_be_hidden()
    assert desk.runs(where) == pytest.approx(camera)


def test_captions_of_a_robot_without_shapes_stay_with_it(open_stage, tmp_path):
    path = tmp_path / "bare.urdf"
    path.write_text(arm(0.4).replace(BAR, ""))
    desk = open_stage(path, methods=("dls",), view=1, watch=True, until="window.pinik?.drawn && pinik.still")
    path.write_text(arm(0.3).replace(BAR, ""))
    generation = desk.state["generation"]
    desk.until(lambda s: s["generation"] == generation + 1)
    desk.shows(f"pinik.state.generation === {generation + 1} && pinik.show.cast.instances.length === 1")
    assert desk.runs("pinik.show.cast.base.length") > 0, "captions stand below what a robot stands on"


def test_a_fault_says_whether_the_robot_or_another_one_is_seen_meanwhile(open_panel, tmp_path):
    path = tmp_path / "own.urdf"
    path.write_text(arm(0.4))
    desk = open_panel(path, methods=("dls",), watch=True)
    own = desk.state["robot"]
    path.write_text("<robot/>")
    desk.expect("watched").to_contain_text("You see the robot as it last was.")
    desk.choose("robot", "two_link")
    desk.expect("watched").to_contain_text("You see another robot meanwhile.")
    desk.choose("robot", own)
    desk.expect("watched").to_contain_text("You see the robot as it last was.")
