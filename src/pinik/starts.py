"""Where restarts begin: numbers that depend on seed, target and attempt alone, the same in every engine."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics
from .limits import Limits

__all__ = ["random_start", "uniform"]

Array = NDArray[np.float64]

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15
_HALF_TURN = math.pi
_HALF_SLIDE = 1.0  # [m] for a slide without limits


def uniform(seed: int, target: int, attempt: int, index: int) -> float:
    """The number in [0, 1) that belongs to these four, by SplitMix64 (Steele, Lea and Flood 2014)."""
    state = seed & _MASK
    for key in (target, attempt, index):
        state = _mix((state + _GOLDEN * (key + 1)) & _MASK)
    return float((state >> 11) * 2.0**-53)


def random_start(kinematics: Kinematics, limits: Limits, q0: Array, *, seed: int, target: int, attempt: int) -> Array:
    """A configuration with every free one-axis joint drawn anew, and all others as in `q0`.

    Angles are uniform inside the limits; in ±π about zero for a hinge without, ±1 m about `q0` for a slide without.
    """
    q = q0.copy()
    robot = kinematics.robot
    for joint in robot.joints:
        if not (joint.has_one_axis and joint.nv and kinematics.free[joint.idx_v]):
            continue
        u = uniform(seed, target, attempt, joint.idx_v)
        low, high = float(limits.lower[joint.idx_q]), float(limits.upper[joint.idx_q])
        if joint.kind == "prismatic":
            centre, half = float(q0[joint.idx_q]), _HALF_SLIDE
        else:
            centre, half = 0.0, _HALF_TURN
        if joint.nq == 2 or (not math.isfinite(low) and not math.isfinite(high)):
            low, high = centre - half, centre + half
        elif not math.isfinite(low):
            low = high - 2.0 * half
        elif not math.isfinite(high):
            high = low + 2.0 * half
        robot.set_angle(q, joint, min(low + u * (high - low), high))  # the sum may be rounded past the end
    return q


def _mix(z: int) -> int:
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _MASK
    return z ^ (z >> 31)
