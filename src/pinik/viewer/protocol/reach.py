"""The `reach` message: points that a frame can be at, for the cloud around a robot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio

from ...model.home import home_configuration
from ...robot import Robot

__all__ = ["POINTS", "reach_message"]

POINTS = 2000


def reach_message(robot: Robot, generation: int, frame: str) -> dict[str, Any]:
    """Return where a frame is at random configurations inside the limits, by plain forward kinematics.

    A robot on a floating or planar root carries its cloud: the points are relative to that root joint. The function
    works on memory of its own, so another thread may use the robot at the same time.

    Args:
        robot: The robot.
        generation: Its number in messages.
        frame: The frame.
    """
    model, data = robot.model, robot.model.createData()
    frame_id = robot.frame_id(frame)
    root = next((joint for joint in robot.joints if not joint.has_one_axis and model.parents[joint.id] == 0), None)
    home, rng = home_configuration(robot), np.random.default_rng(0)
    points = np.empty((POINTS, 3))
    for row in points:
        q = robot.random(rng)
        if root is not None:
            q[root.idx_q : root.idx_q + root.nq] = home[root.idx_q : root.idx_q + root.nq]
        pinocchio.forwardKinematics(model, data, q)
        place = pinocchio.updateFramePlacement(model, data, frame_id)
        row[:] = (data.oMi[root.id].inverse() * place if root is not None else place).translation
    return {
        "type": "reach",
        "generation": generation,
        "frame": frame,
        "joint": 0 if root is None else root.id,
        "points": points.round(3).tolist(),
    }
