"""The compiled engine's copy of a robot, which is built once and then kept."""

from __future__ import annotations

import math
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from ..engine import load
from .limits import Limits
from .robot_model import RobotModel

__all__ = ["native_robot"]

_ROBOTS: WeakKeyDictionary[RobotModel, Any] = WeakKeyDictionary()


def native_robot(robot: RobotModel) -> Any:
    """The engine's copy of a robot, which is built once and then cached."""
    if robot not in _ROBOTS:
        _ROBOTS[robot] = _make_robot(robot)
    return _ROBOTS[robot]


def _make_robot(robot: RobotModel) -> Any:
    native, kinds = load().Robot(), load().JointKind
    turning = Limits.of(robot).turning
    model = robot.model
    for joint in robot.joints:
        placement = model.jointPlacements[joint.id]
        native.add_joint(
            kind=kinds[joint.kind],
            parent=model.parents[joint.id],
            rotation=placement.rotation,
            translation=placement.translation,
            axis=np.array(joint.axis),
            idx_q=joint.idx_q,
            nq=joint.nq,
            idx_v=joint.idx_v,
            nv=joint.nv,
            follows=joint.leader is not None,
            multiplier=joint.multiplier,
            offset=joint.offset,
            lower=float(robot.lower_q[joint.idx_q]) if joint.nq == 1 else -math.inf,
            upper=float(robot.upper_q[joint.idx_q]) if joint.nq == 1 else math.inf,
            turns=joint.nq == 1 and bool(turning[joint.idx_q]),
        )
    native.finish()
    return native
