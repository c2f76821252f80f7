"""The `reach` message: real places of the frame, for real configurations."""

from __future__ import annotations

import json

import numpy as np
import pytest

from judge import plain_placement
from pinik.viewer.protocol.reach import POINTS, reach_message
from robots import load_quietly


def test_two_hinges_reach_a_ring_and_nothing_outside_it(two_link):
    message = json.loads(json.dumps(reach_message(two_link, 3, "tip"), allow_nan=False))
    points = np.array(message.pop("points"))
    assert message == {"type": "reach", "generation": 3, "frame": "tip", "joint": 0}
    assert points.shape == (POINTS, 3)
    away = np.linalg.norm(points, axis=1)
    assert away.max() <= 0.9 + 1e-3
    assert away.min() >= 0.1 - 1e-3
    assert away.max() > 0.89, "the cloud does not come near the end of the reach"
    assert np.abs(points[:, 2]).max() == 0
    assert len(np.unique(points, axis=0)) > 0.9 * POINTS


@pytest.mark.parametrize("root", ["free_flyer", "planar"])
def test_a_robot_that_moves_carries_its_cloud(root):
    robot = load_quietly("two_link", root=root)
    message = reach_message(robot, 1, "tip")
    carried = robot.joints[0]
    assert (message["joint"], carried.kind in ("floating", "planar")) == (carried.id, True)
    assert np.linalg.norm(message["points"], axis=1).max() <= 0.9 + 1e-3


def test_the_cloud_is_where_plain_pinocchio_puts_the_frame(panda):
    """The nearest point of the cloud is within the mean spacing of a random place."""
    points = np.array(reach_message(panda, 1, "panda_hand_tcp")["points"])
    for seed in range(5):
        place = plain_placement(panda, "panda_hand_tcp", panda.random(seed)).translation
        assert np.linalg.norm(points - place, axis=1).min() < 0.2


def test_the_session_may_use_the_robot_meanwhile(arm):
    """It works on memory of its own: what the robot computed last stays as it was."""
    before = arm.placement("tip", arm.random(1)).copy()
    reach_message(arm, 1, "tip")
    np.testing.assert_array_equal(arm.placement("tip", arm.random(1)).homogeneous, before.homogeneous)
