"""Set the angles of several joints at once, followers among them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .joint import Joint

__all__ = ["set_angles"]

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # how far two angles that agree may differ, relative to the largest term, or to 1 rad or 1 m


def set_angles(q: Array, angles: Mapping[Joint, float]) -> None:
    """Set the angles of one-axis joints in `q`, in place.

    A follower that is given without its leader sets the leader. Joints that share an entry of q must agree to rounding.

    Args:
        q: The configuration (nq,).
        angles: Joint → finite angle [rad or m].

    Raises:
        InputError: A follower disagrees with its leader or with another follower, or a joint has no angle.
    """
    set_by: dict[str, tuple[Joint, float]] = {}  # leader → the joint that set it, and the angle of that joint
    # Leaders come first, then the followers with the largest multipliers, which determine their leader best.
    for joint, angle in sorted(angles.items(), key=_precedence):
        leader = joint.leader or joint.name
        if leader not in set_by and joint.multiplier != 0.0:
            joint.set_angle(q, angle)
            set_by[leader] = joint, angle
        else:
            _check_agreement(joint, angle, q, set_by.get(leader))


def _precedence(item: tuple[Joint, float]) -> tuple[bool, float]:
    joint, _ = item
    return joint.leader is not None, -abs(joint.multiplier)


def _check_agreement(follower: Joint, angle: float, q: Array, other: tuple[Joint, float] | None) -> None:
    expected = follower.angle(q)
    scale = max(1.0, abs(angle), abs(expected - follower.offset), abs(follower.offset))
    if abs(angle - expected) <= _ROUNDING * scale:
        return
    if other is None or follower.multiplier == 0.0:
        cause = f"it mimics {follower.leader!r} with multiplier 0 and stays at {follower.offset:.12g}"
    else:
        setter, its_angle = other
        cause = f"it mimics {follower.leader!r} and is at {expected:.12g} when {setter.name!r} is at {its_angle:.12g}"
    raise InputError(f"joint {follower.name!r} cannot be at {angle:.12g}: {cause}")
