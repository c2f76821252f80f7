"""Frames as bytes: joint placements and effector points of every instance, packed for the page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...robot import Robot

__all__ = ["InstanceBlock", "JointPlacements", "pack_frame"]

Array = NDArray[np.float64]

_MAGIC = b"PNKF"


class JointPlacements:
    """Computes the world placements of a robot's joints, in working memory of its own.

    Args:
        robot: The robot. Use one `JointPlacements` per thread.
    """

    def __init__(self, robot: Robot) -> None:
        self._model = robot.model
        self._data = robot.model.createData()
        # These references stay valid and show each new result; indexing `oMi` again costs as much as reading it.
        self._joints = [self._data.oMi[joint_id] for joint_id in range(robot.model.njoints)]

    def at(self, q: Array) -> Array:
        """World placements (J, 7) of all joints at `q`, the universe first: x, y, z [m], qx, qy, qz, qw."""
        pinocchio.forwardKinematics(self._model, self._data, q)
        return np.array([pinocchio.SE3ToXYZQUATtuple(joint) for joint in self._joints])

    def points(self, frames: Sequence[int]) -> Array:
        """World origins (B, 3) [m] of the frames with these indices, at the `q` last given to `at`."""
        origins = [pinocchio.updateFramePlacement(self._model, self._data, frame).translation for frame in frames]
        return np.array(origins).reshape(-1, 3)


class InstanceBlock(NamedTuple):
    """One instance's part of a frame.

    Attributes:
        figures: The eight figures of docs/live-protocol.md.
        joints: World placements (J, 7).
        sides: The limit that each joint sits at (J,).
        points: The effectors' origins (B, 3) [m].
    """

    figures: Sequence[float]
    joints: Array
    sides: Array
    points: Array


def pack_frame(generation: int, step: int, balls: Array, blocks: Sequence[InstanceBlock]) -> bytes:
    """Pack one frame message.

    Args:
        generation: The number of the robot that the frame shows.
        step: The session's step counter; it is written as a whole number, as float32 loses some after three days.
        balls: Placements (B, 7): x, y, z [m], qx, qy, qz, qw.
        blocks: One block per instance, all of the same robot.

    Raises:
        ValueError: The blocks differ in their number of joints or points, or do not have eight figures.
    """
    joints = len(blocks[0].joints) if blocks else 0
    pieces = [np.array([generation, step, len(blocks), joints, len(balls)]), np.ravel(balls)]
    for block in blocks:
        pieces += [np.ravel(part) for part in block]
    numbers = np.concatenate(pieces, dtype="<f4", casting="same_kind")
    if numbers.size != 5 + 7 * len(balls) + len(blocks) * (8 + 8 * joints + 3 * len(balls)):
        raise ValueError("every block of a frame must have eight figures and the same number of joints and points")
    numbers.view("<u4")[1] = step % 2**32
    return _MAGIC + numbers.tobytes()
