"""How far a joint moves from one configuration to another, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from pinik.solving.changes import joint_change
from robots import load_quietly
from urdf_texts import pair


def joint_of(robot: pinik.Robot, index: int = 0):
    """A joint of a robot, root joints first."""
    return robot.joint(robot.model.names[index + 1])


def test_a_slide_counts_metres_per_length():
    robot = load_quietly(pair(kind="prismatic"))
    assert joint_change(joint_of(robot), np.array([0.1]), np.array([0.6]), 2.0) == pytest.approx(0.25)


@pytest.mark.parametrize(("turn", "change"), [(0.5, 2.5), (3.0, 3.0), (-3.0, 3.0)])
def test_a_planar_joint_counts_the_larger_of_its_way_per_length_and_its_turn(turn, change):
    robot = pinik.load("two_link", root="planar")
    before, after = robot.neutral(), robot.neutral()
    after[:4] = [3.0, 4.0, math.cos(turn), math.sin(turn)]
    assert joint_change(joint_of(robot), before, after, 2.0) == pytest.approx(change)


@pytest.mark.parametrize(("turn", "change"), [(0.5, 3.5), (4.0, 3.5), (3.0, 3.5)])
def test_a_floating_joint_counts_the_larger_of_its_way_per_length_and_its_turn(turn, change):
    robot = pinik.load("two_link", root="free_flyer")
    before, after = robot.neutral(), robot.neutral()
    after[:7] = [2.0, 3.0, 6.0, math.sin(turn / 2.0), 0.0, 0.0, math.cos(turn / 2.0)]
    assert joint_change(joint_of(robot), before, after, 2.0) == pytest.approx(change)
    assert joint_change(joint_of(robot), before, after, 70.0) == pytest.approx(min(turn, 2.0 * math.pi - turn))
