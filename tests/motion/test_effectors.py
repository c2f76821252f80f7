"""Which frames deserve a ball, where robots stand, and how large a curve they can follow."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import two_hinges
from judge import assert_good, is_inside, plain_placement
from pinik.model.home import home_configuration, lowest_point
from pinik.motion.curves import CURVES, polyline
from pinik.motion.effectors import principal_frames
from pinik.motion.tracks import curve_axes
from robots import load_quietly
from urdf_texts import joint, link, robot

SOME = ["arm", "lion", "two_link", "panda", "ur5", "z1", "tiago", "hector", "simple_humanoid", "solo12"]


@pytest.mark.parametrize("name", SOME)
@pytest.mark.parametrize("root", ["fixed", "free_flyer"])
def test_a_robot_stands_inside_its_limits(name, root):
    machine = load_quietly(name, root=root)
    q = home_configuration(machine)
    assert q.shape == (machine.model.nq,)
    assert np.allclose(pinocchio.normalize(machine.model, q), q)
    assert is_inside(machine, q)


def test_a_robot_with_a_resting_pose_rests(arm, lion, panda):
    for machine, pose in ((arm, "relaxed"), (lion, "relaxed"), (panda, "default")):
        assert np.allclose(home_configuration(machine), machine.poses[pose], atol=1e-12)


def test_a_robot_without_poses_is_slightly_bent_inside_its_limits():
    straight = load_quietly(two_hinges(1.0, 0.5, low=-2, high=0.1))
    angles = straight.angles(home_configuration(straight))
    assert angles["shoulder"] == pytest.approx(0.4)
    assert angles["elbow"] == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("name", "frames"),
    [
        ("arm", {"tip"}),
        ("two_link", {"tip"}),
        ("lion", {"left_fore_paw", "right_fore_paw", "left_hind_paw", "right_hind_paw", "nose", "tail_tip"}),
        ("panda", {"panda_hand_tcp"}),
        ("tiago_no_hand", {"wrist_ft_tool_link", "head_2_link"}),
    ],
)
def test_the_ends_of_known_robots_get_the_balls(name, frames):
    assert set(principal_frames(load_quietly(name))) == frames


@pytest.mark.parametrize("name", SOME)
def test_one_to_six_frames_that_exist_once_each(name):
    machine = load_quietly(name)
    frames = principal_frames(machine)
    assert 1 <= len(frames) <= 6
    assert len(set(frames)) == len(frames)
    assert set(frames) <= set(machine.frame_names)


def test_fingers_of_one_hand_are_one_end():
    fingers = "".join(
        joint(f"j{name}", "palm", name, f'<origin xyz="{x} 0 0.05"/>') + link(name)
        for name, x in (("left_finger", 0.02), ("right_finger", -0.02))
    )
    arm = "".join(
        joint(f"j{name}", base, name, '<origin xyz="0 0 0.3"/>') for base, name in (("base", "arm"), ("arm", "palm"))
    )
    text = robot(*map(link, ("base", "arm", "palm")), arm, fingers)
    assert len(principal_frames(load_quietly(text))) == 1


def test_a_foot_with_a_sensor_is_an_end_and_a_torso_that_turns_in_place_is_none():
    at = '<origin xyz="0 0 -0.4"/>'
    body = joint("spine", "pelvis", "torso") + joint("hip", "pelvis", "thigh") + joint("knee", "thigh", "foot", at)
    sensor = joint("fixing", "foot", "foot_imu", at, kind="fixed")
    text = robot(*map(link, ("pelvis", "torso", "thigh", "foot", "foot_imu")), body, sensor)
    assert principal_frames(load_quietly(text)) == ["foot"]


def test_the_end_of_an_arm_that_carries_only_a_camera_is_the_link_with_the_name_of_a_tool():
    arm = joint("raise", "base", "upper") + joint("bend", "upper", "wrist", '<origin xyz="0.4 0 0"/>')
    fixed = "".join(
        joint(f"to_{child}", parent, child, '<origin xyz="0.05 0 0"/>', kind="fixed")
        for parent, child in (("wrist", "flange"), ("flange", "tool0"), ("tool0", "camera"))
    )
    text = robot(*map(link, ("base", "upper", "wrist", "flange", "tool0", "camera")), arm, fixed)
    assert principal_frames(load_quietly(text)) == ["tool0"]


def test_a_hand_with_an_unknown_name_goes_before_the_head():
    out = '<origin xyz="0.3 0 0"/>'
    text = robot(
        *map(link, ("torso", "neck", "head", "upper", "nub")),
        joint("yaw", "torso", "neck", out) + joint("nod", "neck", "head", out),
        joint("raise", "torso", "upper", '<origin xyz="-0.3 0 0"/>') + joint("bend", "upper", "nub", out),
    )
    assert principal_frames(load_quietly(text)) == ["nub", "head"]


@pytest.mark.parametrize("name", ["arm", "lion", "tiago"])
def test_the_lowest_point_is_that_of_the_lowest_frame(name):
    machine = load_quietly(name)
    q = home_configuration(machine)
    heights = [plain_placement(machine, frame, q).translation[2] for frame in machine.frame_names]
    assert lowest_point(machine, q) == pytest.approx(min(heights), abs=1e-12)


@pytest.mark.parametrize("curve", sorted(CURVES))
def test_curves_stand_upright_facing_the_viewer(arm, curve):
    q = home_configuration(arm)
    axes = curve_axes(arm, "tip", q, plain_placement(arm, "tip", q).translation, CURVES[curve])
    size = np.linalg.norm(axes[0])
    assert size > 0.05
    assert np.allclose(axes / size, [[0, 1, 0], [0, 0, 1], [1, 0, 0]])


def test_a_planar_chain_gets_curves_in_its_plane(two_link):
    for machine, frame in ((two_link, "tip"), (load_quietly(two_hinges(0.7, 0.5)), "tip")):
        q = home_configuration(machine)
        plane_normal = plain_placement(machine, frame, q).rotation @ hinge_axis(machine)
        axes = curve_axes(machine, frame, q, plain_placement(machine, frame, q).translation, CURVES["wave"])
        u, v, w = axes
        assert np.linalg.norm(u) == pytest.approx(np.linalg.norm(v))
        assert np.linalg.norm(u) > 0.02
        assert [u @ v, u @ plane_normal, v @ plane_normal] == pytest.approx([0, 0, 0], abs=1e-9)
        assert not w.any()


def hinge_axis(machine):
    """The last hinge's axis in its link's frame."""
    return np.array(machine.joint(machine.joint_names[-1]).axis)


@pytest.mark.parametrize(("name", "frame"), [("arm", "tip"), ("panda", "panda_hand_tcp"), ("lion", "nose")])
def test_a_curve_is_as_large_as_the_chain_can_follow(name, frame):
    machine = load_quietly(name)
    q = home_configuration(machine)
    center = plain_placement(machine, frame, q).translation
    axes = curve_axes(machine, frame, q, center, CURVES["circle"])
    for point in polyline(CURVES["circle"], center, axes, count=16):
        solution = pinik.solve(machine, pinik.Target(frame, point), q0=q, tolerance=(1e-3, 1e-3))
        assert_good(solution, {"frame": frame, "position": point}, tolerance=(1e-3, 1e-3))
        q = solution.q
