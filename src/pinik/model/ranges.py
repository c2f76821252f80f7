"""Limits of the joints: each one's own, cut by those of the joints that mimic it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.flaw import Flaw
from ..description.reader import Description
from .joint import Joint

__all__ = ["configuration_limits", "set_position_limits", "velocity_limits"]

Array = NDArray[np.float64]

_ONE_VALUE = 1e-9  # [rad or m]: a range this narrow holds a single value
_FREE_TRANSLATION = {"floating": 3, "planar": 2}  # entries of q


def set_position_limits(model: pinocchio.Model, joints: Sequence[Joint], description: Description) -> tuple[Flaw, ...]:
    """Set `model.lowerPositionLimit` and `model.upperPositionLimit` to the limits of the robot.

    The limits of a joint with one entry in q are its own, cut so that its followers stay inside theirs, and infinite
    where there are none. The translations of floating and planar joints have infinite limits too: with the largest
    double, which Pinocchio sets for root joints, `pinocchio.randomConfiguration` returns infinite positions, while for
    infinite limits it raises an error. Quaternions and (cos, sin) pairs keep the limits that Pinocchio sets, which
    exclude no orientation.

    Args:
        model: The model; it is modified.
        joints: All joints of the model.
        description: The checked URDF, whose lines the warnings name.

    Returns:
        A warning for each follower whose limits are ignored because they would stop its leader.
    """
    lower, upper = np.array(model.lowerPositionLimit), np.array(model.upperPositionLimit)
    lines = {tag.name: tag.line for tag in description.joints}
    warnings: list[Flaw] = []
    for joint in joints:
        if joint.nq == 1:
            followers = (follower for follower in joints if follower.leader == joint.name)
            lower[joint.idx_q], upper[joint.idx_q] = _cut_by_followers(joint, followers, lines, warnings)
        elif joint.kind in _FREE_TRANSLATION:
            translation = slice(joint.idx_q, joint.idx_q + _FREE_TRANSLATION[joint.kind])
            lower[translation], upper[translation] = -math.inf, math.inf
    model.lowerPositionLimit, model.upperPositionLimit = lower, upper
    return tuple(warnings)


def configuration_limits(model: pinocchio.Model, joints: Iterable[Joint]) -> tuple[Array, Array]:
    """The model's lower and upper limits (nq,) [rad or m], infinite for entries that are not the angle of a joint."""
    lower, upper = np.full(model.nq, -np.inf), np.full(model.nq, np.inf)
    for joint in joints:
        if joint.nq == 1:
            lower[joint.idx_q] = model.lowerPositionLimit[joint.idx_q]
            upper[joint.idx_q] = model.upperPositionLimit[joint.idx_q]
    return lower, upper


def velocity_limits(names: Sequence[str], joints: Iterable[Joint], description: Description) -> Array:
    """The largest velocities (n,) of the named joints [rad/s or m/s], cut by those of their followers.

    They are infinite where the file gives none, or 0.

    Args:
        names: The names of joints that are not followers.
        joints: All joints of the model.
        description: The checked URDF.
    """
    own = {tag.name: tag.velocity or math.inf for tag in description.joints}
    limits = {name: own.get(name, math.inf) for name in names}
    for joint in joints:
        if joint.leader in limits and joint.multiplier != 0.0:
            cut = own.get(joint.name, math.inf) / abs(joint.multiplier)
            limits[joint.leader] = min(limits[joint.leader], cut)
    return np.array(list(limits.values()), dtype=np.float64)


def _cut_by_followers(
    joint: Joint, followers: Iterable[Joint], lines: Mapping[str, int | None], warnings: list[Flaw]
) -> tuple[float, float]:
    """The limits of a joint [rad or m], cut so that its followers stay inside theirs.

    A follower that would leave the joint no value, or a single value of a range, is ignored and named in `warnings`,
    which is appended to; `lines` are those of the joints.
    """
    lower, upper = joint.lower, joint.upper
    for follower in followers:
        if follower.multiplier == 0.0:
            continue
        ends = [(limit - follower.offset) / follower.multiplier for limit in (follower.lower, follower.upper)]
        low, high = max(lower, min(ends)), min(upper, max(ends))
        if low > high or high - low <= _ONE_VALUE < joint.upper - joint.lower:
            room = "no room" if low > high else f"only the value {low + 0.0:g}"
            own = f"its limits {follower.lower:g}…{follower.upper:g} are ignored, because they would leave"
            cause = f"{own} {joint.name!r}, which it mimics, {room}"
            common = (
                "its limits are ignored, because they would leave the joint that it mimics no room, or a single value"
            )
            line = lines.get(follower.name)
            flaw = Flaw(f"joint {follower.name!r}", cause, code="follower-limits", line=line, common=common)
            warnings.append(flaw)
        else:
            lower, upper = low, high
    return lower + 0.0, upper + 0.0  # no −0, which a negative multiplier makes of 0
