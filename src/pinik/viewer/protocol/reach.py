"""The `reach` message: points that a frame can be at, for the cloud around a robot."""

from __future__ import annotations

from typing import Any

from ...model.home import home_configuration
from ...problem.targets import Target
from ...robot import Robot
from ...solving.sampling import Sampler

__all__ = ["POINTS", "reach_message"]

POINTS = 2000


def reach_message(robot: Robot, generation: int, frame: str) -> dict[str, Any]:
    """Return where a frame is at random configurations inside the limits, by forward kinematics.

    A robot on a floating or planar root carries its cloud: the points are relative to that root joint. Another thread
    may use the robot at the same time.

    Args:
        robot: The robot.
        generation: Its number in messages.
        frame: The frame.
    """
    model = robot.model
    root = next((joint for joint in robot.joints if not joint.has_one_axis and model.parents[joint.id] == 0), None)
    carried = None if root is None else robot.description.root
    sampler = Sampler(robot, Target(frame, (0.0, 0.0, 0.0), relative_to=carried), home_configuration(robot))
    points = sampler.placements(sampler.configurations(0, POINTS))[:, :3, 3]
    return {
        "type": "reach",
        "generation": generation,
        "frame": frame,
        "joint": 0 if root is None else root.id,
        "points": points.round(3).tolist(),
    }
