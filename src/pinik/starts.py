"""Where restarts begin: numbers that depend on seed, target and attempt alone, the same in every engine."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics
from .limits import Limits

__all__ = ["random_start", "uniform"]

Array = NDArray[np.float64]

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15


def uniform(seed: int, target: int, attempt: int, index: int) -> float:
    """The number in [0, 1) that belongs to these four, by SplitMix64 (Steele, Lea and Flood 2014)."""
    state = seed & _MASK
    for key in (target, attempt, index):
        state = _mix((state + _GOLDEN * (key + 1)) & _MASK)
    return float((state >> 11) * 2.0**-53)


def random_start(kinematics: Kinematics, limits: Limits, q0: Array, *, seed: int, target: int, attempt: int) -> Array:
    """A configuration with every free one-axis joint drawn anew, and all others as in `q0`.

    Angles are uniform in `Joint.range_to_draw_from`, slides without limits about `q0`.
    """
    q = q0.copy()
    robot = kinematics.robot
    for joint in robot.joints:
        if not (joint.has_one_axis and joint.nv and kinematics.free[joint.idx_v]):
            continue
        u = uniform(seed, target, attempt, joint.idx_v)
        entry = joint.idx_q
        low, high = joint.range_to_draw_from(float(limits.lower[entry]), float(limits.upper[entry]), float(q0[entry]))
        joint.set_angle(q, low + u * (high - low))
    return q


def _mix(z: int) -> int:
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _MASK
    return z ^ (z >> 31)
