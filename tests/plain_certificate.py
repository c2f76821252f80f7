"""The errors of targets at a configuration as it stands, by Pinocchio's own functions on `robot.model` alone.

The judge reads a robot's file himself and therefore rounds otherwise. Where a tolerance is as small as rounding, only
the same model and the same q can decide; this is what a user of Pinocchio computes from `robot.model` and `solution.q`.
"""

from __future__ import annotations

import math
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio

import pinik

AT_THE_POINT = 1e-6  # [m]: docs/targets.md
_DATA: weakref.WeakKeyDictionary[pinik.Robot, pinocchio.Data] = weakref.WeakKeyDictionary()


def plain_errors(
    robot: pinik.Robot, targets: Sequence[pinik.Target], q: np.ndarray, tolerance: Any
) -> list[tuple[float | None, float | None, tuple[float, float, float] | None]]:
    """(metres, radians, errors along the axes of a box) of each target."""
    if robot not in _DATA:
        _DATA[robot] = robot.model.createData()
    data = _DATA[robot]
    pinocchio.framesForwardKinematics(robot.model, data, q)
    return [_errors(robot, data, target, target.tolerance or tolerance) for target in targets]


def _errors(robot: pinik.Robot, data: pinocchio.Data, target: pinik.Target, tolerance: Any) -> Any:
    found = data.oMf[robot.frame_id(target.frame)]
    if target.relative_to is not None:
        found = data.oMf[robot.frame_id(target.relative_to)].actInv(found)
    if target.tool is not None:
        found = found * target.tool
    position = orientation = offset = None
    if target.position is not None:
        left = [0.0 if math.isnan(a) else a - b for a, b in zip(target.position, found.translation, strict=True)]
        position = length(left)
        if np.ndim(tolerance[0]) == 1:
            box = pinocchio.SE3.Identity() if target.rotation is None else pinocchio.SE3(target.rotation, np.zeros(3))
            offset = tuple(box.actInv(np.array(left)).tolist())
    if target.rotation is not None:
        turn = pinocchio.SE3(target.rotation, np.zeros(3)) * pinocchio.SE3(found.rotation, np.zeros(3)).inverse()
        orientation = length(pinocchio.log3(turn.rotation).tolist())
    elif target.axis is not None:
        pointing = pinocchio.SE3(found.rotation, np.zeros(3)).act(target.axis)
        line = target.direction if target.at is None else target.at - found.translation
        orientation = 0.0
        if target.at is None or length(line.tolist()) >= AT_THE_POINT:
            (a, b, c), (x, y, z) = pointing.tolist(), line.tolist()
            sine = length([b * z - c * y, c * x - a * z, a * y - b * x])
            orientation = math.atan2(sine, a * x + b * y + c * z)
    return position, orientation, offset


def length(vector: Sequence[float]) -> float:
    x, y, z = vector
    return math.sqrt(x * x + y * y + z * z)
