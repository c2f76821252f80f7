"""A session's frame message: where everything is at this step."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...robot import Robot
from ..simulation.instance import Instance
from ..simulation.session import Session
from ..simulation.standing import STATUSES
from .packing import InstanceBlock, JointPlacements, pack_frame

__all__ = ["FrameMaker"]

Array = NDArray[np.float64]

_SIDES = {"lower": -1.0, "upper": 1.0, "both": 2.0}


class FrameMaker:
    """Makes the frame messages of one robot's session; `generation` is the robot's number in messages."""

    def __init__(self, robot: Robot, generation: int) -> None:
        self._robot = robot
        self._generation = generation
        self._placements = JointPlacements(robot)
        self._joint_ids = {joint.name: joint.id for joint in robot.joints}

    def frame(self, session: Session) -> bytes:
        """Return the frame message of the session's current step; docs/live-protocol.md describes its layout."""
        balls = np.array([ball.placement for ball in session.balls])
        frames = [self._robot.frame_id(ball.frame) for ball in session.balls]
        blocks = [self._block(instance, frames) for instance in session.seen]
        return pack_frame(self._generation, session.steps, balls, blocks)

    def _block(self, instance: Instance, frames: list[int]) -> InstanceBlock:
        joints = self._placements.at(instance.q)
        sides = np.zeros(len(joints))
        for name, side in instance.limit_sides().items():
            sides[self._joint_ids[name]] = _SIDES[side]
        return InstanceBlock(_figures(instance), joints, sides, self._placements.points(frames))


def _figures(instance: Instance) -> tuple[float, ...]:
    status, last = float(STATUSES.index(instance.status)), instance.last
    if last is None:
        return (status, math.nan, math.nan, 0.0, 0.0, 0.0, 0.0, 0.0)
    orientation = instance.orientation_error
    return (
        status,
        math.nan if last.error is None else last.error,
        math.nan if orientation is None else orientation,
        last.time,
        float(last.iterations),
        float(last.joint_updates),
        last.jump,
        float(instance.counted),
    )
