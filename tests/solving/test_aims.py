"""Targets between where the frames are and where they should be."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
import pytest

import pinik
from pinik import Target
from pinik.problem.kinematics import Kinematics
from pinik.solving.aims import between, present

TIP, BASE = "panda_hand_tcp", "panda_link4"
TOOL = pinocchio.SE3(pinocchio.exp3(np.array([0.3, -0.2, 0.5])), np.array([0.02, 0.03, 0.1]))
ASKED = {
    "position": {"position": [0.4, 0.1, 0.5]},
    "two coordinates": {"position": [0.4, None, 0.5]},
    "pose": {"position": [0.4, 0.1, 0.5], "rpy": [3.0, 0.2, 0.1]},
    "direction": {"axis": [0.6, 0.0, 0.8], "direction": [0.0, 0.0, -1.0]},
    "point": {"axis": "z", "at": [0.7, 0.2, 0.1]},
}
PLACED = {"": {}, "of a tool": {"tool": TOOL}, "relative to a moving link": {"relative_to": BASE}}


def place_of(panda: pinik.Robot, q: np.ndarray, target: Target) -> pinocchio.SE3:
    """Where the target's frame or tool is, by plain Pinocchio."""
    model = panda.model
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    at = data.oMf[model.getFrameId(target.frame)]
    if target.relative_to is not None:
        at = data.oMf[model.getFrameId(target.relative_to)].actInv(at)
    return at if target.tool is None else at * target.tool


@pytest.mark.parametrize("placed", PLACED.values(), ids=PLACED)
@pytest.mark.parametrize("asked", ASKED.values(), ids=ASKED)
def test_the_present_aim_is_what_the_frame_meets(asked, placed, panda):
    target = Target(TIP, **asked, **placed)
    q = np.random.default_rng(1).uniform(panda.lower, panda.upper)
    (met,) = present(Kinematics.of(pinik.prepare(panda, target).question.problem), (target,), q)
    at = place_of(panda, q, target)
    if target.position is not None:
        np.testing.assert_allclose(met.position[list(target.along)], at.translation[list(target.along)], atol=1e-12)
    if target.rotation is not None:
        np.testing.assert_allclose(met.rotation, at.rotation, atol=1e-12)
    if target.direction is not None:
        np.testing.assert_allclose(met.direction, at.rotation @ target.axis, atol=1e-12)
    if target.at is not None:
        ahead = at.rotation @ target.axis * math.dist(target.at, at.translation)
        np.testing.assert_allclose(met.at, at.translation + ahead, atol=1e-12)


def test_positions_go_on_a_line():
    start, end = Target(TIP, [1.0, 0.0, 2.0]), Target(TIP, [3.0, 4.0, 0.0])
    (aim,) = between((start,), (end,), 0.25)
    np.testing.assert_allclose(aim.position, [1.5, 1.0, 1.5], atol=1e-15)


def test_rotations_go_about_one_axis():
    start, end = Target(TIP, rpy=[0.0, 0.0, 0.2]), Target(TIP, rpy=[0.0, 0.0, 1.0])
    (aim,) = between((start,), (end,), 0.25)
    np.testing.assert_allclose(aim.rotation, Target(TIP, rpy=[0.0, 0.0, 0.4]).rotation, atol=1e-12)


def test_half_way_between_two_directions_is_as_far_from_both():
    start, end = Target(TIP, axis="z", direction=[1.0, 0.0, 0.0]), Target(TIP, axis="z", direction=[0.0, 1.0, 0.0])
    (aim,) = between((start,), (end,), 0.5)
    np.testing.assert_allclose(aim.direction, [math.sqrt(0.5), math.sqrt(0.5), 0.0], atol=1e-15)


def test_half_way_between_opposite_directions_is_the_wanted_one():
    start, end = Target(TIP, axis="z", direction=[1.0, 0.0, 0.0]), Target(TIP, axis="z", direction=[-1.0, 0.0, 0.0])
    (aim,) = between((start,), (end,), 0.5)
    np.testing.assert_array_equal(aim.direction, [-1.0, 0.0, 0.0])


def test_points_to_point_at_go_on_a_line():
    start, end = Target(TIP, axis="z", at=[0.0, 0.0, 1.0]), Target(TIP, axis="z", at=[2.0, 0.0, 0.0])
    (aim,) = between((start,), (end,), 0.25)
    np.testing.assert_allclose(aim.at, [0.5, 0.0, 0.75], atol=1e-15)
