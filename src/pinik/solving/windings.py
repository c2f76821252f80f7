"""Whole turns of hinges that stay inside the limits."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..model.limits import Limits
from ..model.robot_model import RobotModel
from ..problem.problem import Problem

__all__ = ["winding_ranges", "wound"]

Array = NDArray[np.float64]

_TURN = 2.0 * math.pi
_ROUNDING = 1e-9  # [rad]: an angle that a whole turn brings this far beyond its limit is at the limit


def winding_ranges(limits: Limits, problem: Problem, q: Array) -> NDArray[np.int64]:
    """The fewest and most whole turns of each joint at each configuration (n, n_joints, 2), inside the limits.

    Args:
        limits: The limits.
        problem: The problem; joints that are not free in it do not turn.
        q: The configurations (n, nq), inside the limits.
    """
    robot = limits.robot
    free = {coordinate.joint.name for coordinate in problem.coordinates}
    ranges = np.zeros((len(q), len(robot.joint_names), 2), dtype=np.int64)
    for column, name in enumerate(robot.joint_names):
        joint = robot.joint(name)
        entry = joint.idx_q
        if name not in free or joint.nq != 1 or not limits.turning[entry]:
            continue
        if not (math.isfinite(limits.lower[entry]) and math.isfinite(limits.upper[entry])):
            continue
        ranges[:, column, 0] = -np.floor((q[:, entry] - limits.lower[entry] + _ROUNDING) / _TURN)
        ranges[:, column, 1] = np.floor((limits.upper[entry] - q[:, entry] + _ROUNDING) / _TURN)
    return ranges


def wound(robot: RobotModel, q: Array, ranges: NDArray[np.int64]) -> Iterator[Array]:
    """Every configuration (nq,) that whole turns make of `q`, those with the fewest turns of each joint first.

    Args:
        robot: The robot.
        q: The configuration (nq,).
        ranges: The fewest and most turns of each joint (n_joints, 2).
    """
    entries = [robot.joint(name).idx_q for name in robot.joint_names]
    choices = [sorted(range(low, high + 1), key=lambda turns: (abs(turns), turns)) for low, high in ranges.tolist()]
    for turns in itertools.product(*choices):
        turned = q.copy()
        turned[entries] += _TURN * np.array(turns)
        yield turned
