"""Single coordinates: their axes by moving the joint a little, their room by going there."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from by_hand import ZOO, axis, limit, origin
from pinik import Target
from pinik.model.limits import Limits
from pinik.problem.coordinates import Coordinate
from pinik.problem.problem import Problem
from robots import load_quietly
from urdf_texts import joint, link, robot

STEP = 1e-7
# Which coordinates of a joint slide; every other joint of the zoo is a hinge.
SLIDES = {"root_joint": (0, 1, 2), "drift": (0, 1, 2), "s_plane": (0, 1), "m_slide": (0,)}
HINGE_AND_SLIDE = robot(
    *(link(name) for name in "abc"),
    joint("hinge", "a", "b", axis(0, 0, 1), limit=limit(-1.0, 2.0)),
    joint("slide", "b", "c", origin((0.5, 0, 0)), axis(1, 0, 0), kind="prismatic", limit=limit(-0.25, 0.5)),
)


def zoo() -> pinik.Robot:
    return load_quietly(ZOO, root="free_flyer")


def coordinates(robot: pinik.Robot, *frames: str) -> tuple[Coordinate, ...]:
    return Problem(robot, [Target(frame, (1, 2, 3)) for frame in frames]).coordinates


def step_along(coordinate: Coordinate, robot: pinik.Robot, change: float) -> np.ndarray:
    """The tangent vector (nv,) that changes one coordinate."""
    return change * np.eye(robot.model.nv)[coordinate.joint.idx_v + coordinate.index]


def placed(robot: pinik.Robot, q: np.ndarray, joint_id: int) -> pinocchio.SE3:
    data = robot.model.createData()
    pinocchio.forwardKinematics(robot.model, data, q)
    return pinocchio.SE3(data.oMi[joint_id])


def test_the_joint_moves_along_or_about_the_line_and_only_slides_move_along_it():
    robot, rng = zoo(), np.random.default_rng(1)
    q = robot.random(rng)
    data = robot.model.createData()
    pinocchio.forwardKinematics(robot.model, data, q)
    seen = set()
    for coordinate in coordinates(robot, "tip", "d"):
        (joint, multiplier), *_ = coordinate.movers
        direction, point = coordinate.line(data)
        before = placed(robot, q, joint.id)
        after = placed(robot, pinocchio.integrate(robot.model, q, step_along(coordinate, robot, STEP)), joint.id)
        turn = pinocchio.log3(after.rotation @ before.rotation.T) / STEP
        shift = (after.translation - before.translation) / STEP
        slides = coordinate.index in SLIDES.get(joint.name, ())
        assert coordinate.slides is slides
        np.testing.assert_allclose(shift if slides else turn, multiplier * direction, atol=1e-6)
        np.testing.assert_allclose(turn if slides else shift, 0.0, atol=1e-6)
        np.testing.assert_allclose(point, before.translation, atol=1e-12)
        seen.add((joint.name, coordinate.index))
    assert {("root_joint", 5), ("drift", 5), ("s_plane", 2), ("k_turn", 0), ("m_slide", 0)} <= seen


def test_advancing_a_joint_of_several_coordinates_moves_that_joint_alone_as_integrating_does():
    robot, rng = zoo(), np.random.default_rng(2)
    free = Limits.of(robot, False)
    for coordinate in coordinates(robot, "tip", "d"):
        q = robot.random(rng)
        moved = q.copy()
        coordinate.advance(moved, 0.3, robot.model, free)
        wanted = pinocchio.integrate(robot.model, q, step_along(coordinate, robot, 0.3))
        np.testing.assert_allclose(moved, wanted, atol=1e-12)
        assert np.abs(moved - q).max() > 0.01
        joint = coordinate.joint
        others = np.delete(np.arange(robot.model.nq), np.arange(joint.idx_q, joint.idx_q + joint.nq))
        np.testing.assert_array_equal(moved[others], q[others])


def test_advancing_leaves_other_joints_to_the_last_bit_also_where_integrating_would_round_them():
    robot = zoo()
    free, q = Limits.of(robot, False), robot.random(3)
    q[3:7] *= 1.0 + 1e-9  # the root's quaternion, which integrating a step of zero makes a unit one
    for coordinate in coordinates(robot, "d"):
        joint, moved = coordinate.joint, q.copy()
        coordinate.advance(moved, 0.3, robot.model, free)
        others = np.delete(np.arange(robot.model.nq), np.arange(joint.idx_q, joint.idx_q + joint.nq))
        np.testing.assert_array_equal(moved[others], q[others])


@pytest.mark.parametrize(("change", "reached"), [(5.0, [2.0, 0.5]), (-5.0, [-1.0, -0.25])])
def test_advancing_past_a_limit_ends_on_it(change, reached):
    robot = load_quietly(HINGE_AND_SLIDE)
    limits = Limits.of(robot)
    slide, hinge = coordinates(robot, "c")
    q = np.array([0.2, 0.2])
    hinge.advance(q, change, robot.model, limits)
    assert q.tolist() == [reached[0], 0.2]
    slide.advance(q, change, robot.model, limits)
    assert q.tolist() == reached


def test_the_room_of_a_joint_is_the_way_to_its_limits():
    robot = load_quietly(HINGE_AND_SLIDE)
    slide, hinge = coordinates(robot, "c")
    q = np.array([0.5, 0.1])
    assert hinge.room(q, Limits.of(robot)) == pytest.approx((-1.5, 1.5))
    assert slide.room(q, Limits.of(robot)) == pytest.approx((-0.35, 0.4))
    for coordinate in (hinge, slide):
        assert coordinate.room(q, Limits.of(robot, False)) == (-math.inf, math.inf)


def test_outside_its_limits_a_joint_has_room_towards_them_alone():
    robot = load_quietly(HINGE_AND_SLIDE)
    slide, hinge = coordinates(robot, "c")
    q = np.array([2.5, -0.75])
    assert hinge.room(q, Limits.of(robot)) == pytest.approx((-3.5, 0.0))
    assert slide.room(q, Limits.of(robot)) == pytest.approx((0.0, 1.25))


def test_a_joint_of_several_coordinates_has_room_without_end():
    robot = zoo()
    limits = Limits.of(robot)
    several = [coordinate for coordinate in coordinates(robot, "tip", "d") if coordinate.joint.nv > 1]
    assert len(several) == 6 + 6 + 3
    for coordinate in several:
        assert coordinate.room(robot.neutral(), limits) == (-math.inf, math.inf)


@pytest.mark.parametrize("held", [(), ("first",), ("spin",), ("last",), ("first", "spin")])
def test_the_held_entries_of_q_are_those_of_joints_that_do_not_move_the_frame_or_are_locked(held):
    """A continuous joint has two entries of q, so that entries and tangent coordinates are counted differently."""
    arm = pinik.load(
        robot(
            *(link(name) for name in "abcde"),
            joint("first", "a", "b"),
            joint("spin", "b", "c", kind="continuous", limit=""),
            joint("last", "c", "d", origin((0.5, 0, 0))),
            joint("beyond", "d", "e", origin((0.5, 0, 0))),
        )
    )
    ids = {name: arm.model.joints[arm.model.getJointId(name)] for name in ("first", "spin", "last", "beyond")}
    still = [j for name, j in ids.items() if name in held or name == "beyond"]
    entries = sorted(entry for j in still for entry in range(j.idx_q, j.idx_q + j.nq))
    assert Problem(arm, Target("d", (1, 2, 3)), locked=held).held_entries.tolist() == entries
