"""How far each joint may go: its own limits, cut by those of the joints that mimic it; written into the model."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .joint import Joint

__all__ = ["configuration_limits", "set_position_limits"]

Array = NDArray[np.float64]

_ONE_VALUE = 1e-9  # [rad or m]: a range this narrow holds a single value
_FREE_TRANSLATION = {"floating": 3, "planar": 2}  # entries of q


def set_position_limits(model: pinocchio.Model, joints: Sequence[Joint]) -> tuple[str, ...]:
    """Write the limits that hold on a robot into `model.lowerPositionLimit` and `model.upperPositionLimit`.

    Each joint with one entry in q gets its own limits, cut where a follower would leave its own; they are infinite
    where there are none. So are those of a free translation, where Pinocchio's largest double makes
    `pinocchio.randomConfiguration` return infinite positions; with infinite limits it refuses to draw, in words. The
    entries of unit length, (cos, sin) and quaternions, keep the limits that Pinocchio gives them: they exclude nothing.

    Args:
        model: The model; it is modified.
        joints: All of its joints.

    Returns:
        Warnings that name the followers whose limits are ignored, because they would stop their leader.
    """
    lower, upper = np.array(model.lowerPositionLimit), np.array(model.upperPositionLimit)
    warnings: list[str] = []
    for joint in joints:
        if joint.nq == 1:
            followers = (follower for follower in joints if follower.leader == joint.name)
            lower[joint.idx_q], upper[joint.idx_q] = _cut_by_followers(joint, followers, warnings)
        elif joint.kind in _FREE_TRANSLATION:
            translation = slice(joint.idx_q, joint.idx_q + _FREE_TRANSLATION[joint.kind])
            lower[translation], upper[translation] = -math.inf, math.inf
    model.lowerPositionLimit, model.upperPositionLimit = lower, upper
    return tuple(warnings)


def configuration_limits(model: pinocchio.Model, joints: Iterable[Joint]) -> tuple[Array, Array]:
    """The model's (lower, upper) limits (nq,), infinite for the entries that are no joint's angle [rad or m]."""
    lower, upper = np.full(model.nq, -np.inf), np.full(model.nq, np.inf)
    for joint in joints:
        if joint.nq == 1:
            lower[joint.idx_q] = model.lowerPositionLimit[joint.idx_q]
            upper[joint.idx_q] = model.upperPositionLimit[joint.idx_q]
    return lower, upper


def _cut_by_followers(joint: Joint, followers: Iterable[Joint], warnings: list[str]) -> tuple[float, float]:
    """The limits of a joint [rad or m] that keep its followers inside theirs.

    A follower whose limits would leave the joint nothing, or a single value out of a range, does not count;
    `warnings` (appended to) names it.
    """
    lower, upper = joint.lower, joint.upper
    for follower in followers:
        if follower.multiplier == 0.0:
            continue
        ends = [(limit - follower.offset) / follower.multiplier for limit in (follower.lower, follower.upper)]
        low, high = max(lower, min(ends)), min(upper, max(ends))
        if low > high or high - low <= _ONE_VALUE < joint.upper - joint.lower:
            room = "no room" if low > high else f"only the value {low + 0.0:g}"
            warnings.append(
                f"joint {follower.name!r}: its limits {follower.lower:g}…{follower.upper:g} are ignored, because they "
                f"would leave {joint.name!r}, which it mimics, {room}"
            )
        else:
            lower, upper = low, high
    return lower + 0.0, upper + 0.0  # a negative multiplier turns 0 into −0, which numpy holds to be below 0
