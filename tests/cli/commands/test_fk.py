from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from pinik.description.catalog import find


def test_the_tip_of_the_straight_arm(run):
    frame = run("fk", "arm", "--frame", "tip", "--json").json["frames"][0]
    straight = pinocchio.buildModelFromUrdf(str(find("arm").urdf))
    data = straight.createData()
    pinocchio.framesForwardKinematics(straight, data, pinocchio.neutral(straight))
    tip = data.oMf[straight.getFrameId("tip", pinocchio.BODY)]
    assert frame["position"] == pytest.approx(tip.translation, abs=1e-12)


def test_two_links_by_hand(run):
    answer = run("fk", "two_link", "--frame", "tip", "--json").json
    first, second = answer["angles"]
    straight = np.linalg.norm(answer["frames"][0]["position"])
    folded = run("fk", "two_link", "--frame", "tip", "--set", f"{second}=90", "--deg", "--json").json
    x, y, z = folded["frames"][0]["position"]
    assert folded["angles"][second] == pytest.approx(math.pi / 2)
    # Two links at a right angle: their squares add up to the hypotenuse's.
    upper = max(abs(x), abs(y), abs(z))
    assert math.hypot(upper, straight - upper) == pytest.approx(math.hypot(x, y, z), abs=1e-9)
    turned = run("fk", "two_link", "--frame", "tip", "--set", f"{first}=1.0", "--json").json
    assert np.linalg.norm(turned["frames"][0]["position"]) == pytest.approx(straight, abs=1e-9)


def test_quaternion_and_rpy_are_one_orientation(run):
    answer = run("fk", "panda", "--set", "panda_joint4=-1.5", "--set", "panda_joint2=0.4", "--json").json
    for frame in answer["frames"]:
        from_quaternion = pinocchio.Quaternion(np.array(frame["quat_xyzw"])).toRotationMatrix()
        assert np.allclose(from_quaternion, pinocchio.rpy.rpyToMatrix(*frame["rpy"]), atol=1e-9)
    assert [frame["frame"] for frame in answer["frames"]] == list(pinik.load("panda").frame_names)


def test_solve_and_fk_agree(run):
    solved = run("solve", "arm", "--frame", "tip", "--position", 0.3, 0.1, 0.8, "--json").json
    settings = [text for name, angle in solved["angles"].items() for text in ("--set", f"{name}={angle!r}")]
    placed = run("fk", "arm", "--frame", "tip", *settings, "--json").json
    assert placed["q"] == pytest.approx(solved["q"], abs=1e-15)
    missed = np.linalg.norm(np.subtract(placed["frames"][0]["position"], [0.3, 0.1, 0.8]))
    assert missed == pytest.approx(solved["position_error_m"], abs=1e-12)


def test_a_pose_and_another_frame(run):
    robot = pinik.load("arm")
    q = robot.poses["reach"]
    answer = run("fk", "arm", "--frame", "tip", "--pose", "reach", "--relative-to", "bone3_x", "--json").json
    expected = robot.placement("bone3_x", q).actInv(robot.placement("tip", q))
    assert answer["frames"][0]["position"] == pytest.approx(expected.translation, abs=1e-12)


def test_a_pose_leaves_stdout_to_the_data(run):
    romeo = run("fk", "romeo", "--pose", "half_sitting", "--frame", "torso", "--json")
    assert romeo.status == 0
    assert romeo.out.count("\n") == 1
    assert all(line.startswith("warning: romeo: ") for line in romeo.err.splitlines())


def test_the_table_shows_the_frames(run):
    lines = run("fk", "arm", "--frame", "tip", "--frame", "base", "--set", "bone1_x=-30", "--deg").out.splitlines()
    assert lines[0].split()[:2] == ["frame", "x"]
    assert [line.split()[0] for line in lines[1:]] == ["tip", "base"]
    pitch = float(lines[1].split()[5])
    assert abs(pitch) == pytest.approx(30.0, abs=1e-3)


def test_a_value_outside_the_limits_is_said_and_taken(run):
    result = run("fk", "arm", "--frame", "tip", "--set", "bone1_x=2", "--json")
    assert result.err == "note: --set bone1_x=2 is outside the limits -0.78540 … 0.78540 rad; used as given\n"
    assert result.json["angles"]["bone1_x"] == 2.0


def test_a_joints_name_may_hold_an_equals_sign(run, tmp_path):
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    ends = '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    file = tmp_path / "r.urdf"
    file.write_text(
        '<robot name="r"><link name="a"/><link name="b"/>'
        f'<joint name="q=1" type="revolute">{ends}{limit}</joint></robot>'
    )
    assert run("fk", file, "--set", "q=1=0.5", "--json").json["angles"] == {"q=1": 0.5}


def test_minus_zero_is_zero(run):
    out = run("fk", "arm", "--set", "bone1_x=-0.0", "--json").out
    assert not any(f"-0.0{end}" in out for end in ",]}")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--frame", "tipp"), "did you mean 'tip'"),
        (("--set", "bone=1"), "no joint 'bone'"),
        (("--set", "bone1_x"), "JOINT=ANGLE"),
        (("--set", "bone1_x=inf"), "finite"),
        (("--root", "free_flyer", "--set", "root_joint=1"), "floating"),
        (("--relative-to", "tipp"), "did you mean 'tip'"),
    ],
)
def test_wrong_input_is_status_2(run, arguments, words):
    result = run("fk", "arm", *arguments)
    assert (result.status, result.out) == (2, "")
    assert words in result.err


def test_a_follower_cannot_be_set(run):
    result = run("fk", "panda", "--set", "panda_finger_joint2=0.01")
    assert result.status == 2
    assert "set 'panda_finger_joint1'" in result.err
