"""The length of what moves a frame, measured by hand."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from pinik import Target
from pinik.model.chains import chain_of
from pinik.model.home import robot_size
from pinik.problem.problem import Problem
from robots import load_quietly

HINGE = '<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>'
SLIDE = '<axis xyz="1 0 0"/><limit lower="-0.25" upper="0.5" effort="1" velocity="1"/>'


def arm(mount: str = '<origin xyz="0 0 0"/>', second: str = "revolute", inside: str = HINGE) -> pinik.Robot:
    """base –fixed– foot –hinge– a –(0.3 m) joint– b –fixed (0.4 m)– tip; and a hinge with a hand beside the foot."""
    return pinik.load(
        f"""<robot name="arm">
        <link name="base"/><link name="foot"/><link name="a"/><link name="b"/><link name="tip"/><link name="hand"/>
        <joint name="mount" type="fixed"><parent link="base"/><child link="foot"/>{mount}</joint>
        <joint name="one" type="revolute"><parent link="foot"/><child link="a"/>
          <origin xyz="0 0 0.2"/>{HINGE}</joint>
        <joint name="two" type="{second}"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0"/>{inside}</joint>
        <joint name="end" type="fixed"><parent link="b"/><child link="tip"/><origin xyz="0 0.4 0"/></joint>
        <joint name="three" type="revolute"><parent link="foot"/><child link="hand"/>
          <origin xyz="0 1.0 0.2"/>{HINGE}</joint>
        </robot>"""
    )


def length(robot: pinik.Robot, frame: str, relative_to: str | None = None, **options) -> float:
    reference = None if relative_to is None else robot.frame_id(relative_to)
    chain = chain_of(robot.model, robot.joints, robot.frame_id(frame), reference, options.pop("tool", None))
    return chain.length(**options)


@pytest.mark.parametrize("mount", ['<origin xyz="0 0 0"/>', '<origin xyz="50 -30 10" rpy="1 2 3"/>'])
def test_the_way_to_the_first_joint_does_not_count(mount):
    assert length(arm(mount), "tip") == pytest.approx(0.7)
    assert robot_size(arm(mount)) == pytest.approx(0.7)


def test_the_tool_counts():
    lance = pinocchio.SE3(np.eye(3), np.array([0.0, 0.6, 0.0]))
    assert length(arm(), "tip", tool=lance) == pytest.approx(0.3 + 1.0)
    assert Problem(arm(), Target("tip", [1, 0, 0], tool=[0, 0.6, 0])).size_of_chain == pytest.approx(1.3)


def test_slides_count_drawn_out():
    assert length(arm(second="prismatic", inside=SLIDE), "tip") == pytest.approx(0.7 + 0.5)


def test_joints_that_hold_still_at_the_base_are_part_of_the_mount():
    robot = arm()
    assert length(robot, "tip", still={robot.joint("one").id}) == pytest.approx(0.4)
    assert Problem(robot, Target("tip", [1, 0, 0]), locked=["one"]).size_of_chain == pytest.approx(0.4)
    assert Problem(robot, Target("tip", [1, 0, 0]), locked=["two"]).size_of_chain == pytest.approx(0.7)


def test_a_reference_on_another_branch_adds_that_branch_and_the_gap():
    assert length(arm(), "tip", relative_to="hand") == pytest.approx(0.7 + 1.0)
    assert length(arm(), "tip", relative_to="a") == pytest.approx(0.4)
    assert length(arm(), "tip", relative_to="base") == pytest.approx(0.7)


def test_the_offsets_go_from_joint_to_joint_and_on_to_the_tool():
    robot, lance = arm(), pinocchio.SE3(np.eye(3), np.array([0.0, 0.0, 0.6]))
    frames = {name: robot.frame_id(name) for name in ("base", "a", "tip", "hand")}
    chain = chain_of(robot.model, robot.joints, frames["tip"], tool=lance)
    np.testing.assert_allclose(chain.offsets, [(0.3, 0.0, 0.0), (0.0, 0.4, 0.6)])
    for reference, expected in ((frames["a"], [(0.0, 0.4, 0.0)]), (frames["hand"], [(0.3, 0.0, 0.0), (0.0, 0.4, 0.0)])):
        np.testing.assert_allclose(chain_of(robot.model, robot.joints, frames["tip"], reference).offsets, expected)
    assert chain_of(robot.model, robot.joints, frames["base"]).offsets == ()


def test_where_nothing_has_a_length_it_is_one():
    robot = arm()
    assert length(robot, "base") == 0.0
    assert Problem(robot, Target("hand", rpy=[0, 0, 1])).size_of_chain == 1.0


@pytest.mark.parametrize("name", ["arm", "lion", "panda", "ur5", "tiago"])
def test_no_frame_is_farther_from_its_first_joint_than_its_chain_is_long(name):
    robot = load_quietly(name)
    rng = np.random.default_rng(0)
    configurations = [robot.random(rng) for _ in range(20)]
    for frame in robot.frame_names[::5]:
        chain = chain_of(robot.model, robot.joints, robot.frame_id(frame))
        if chain.joints and chain.joints[0].has_one_axis and chain.joints[0].kind != "prismatic":
            for q in configurations:
                place = robot.placement(frame, q).translation
                first = robot.data.oMi[chain.joints[0].id].translation
                assert np.linalg.norm(place - first) <= chain.length() + 1e-9
