"""The turns of a sweep: which joint moves how far about which axis, and where that takes the effector."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...model.joint import Joint
from ...model.limits import Limits
from ...problem.coordinates import Coordinate
from ...problem.kinematics import Kinematics

__all__ = ["Passage", "Turn", "turns_of"]

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # [rad or m]; a change this near to the room that a limit leaves ends at the limit


class Passage(NamedTuple):
    """A sweep's change of one coordinate.

    Attributes:
        coordinate: The coordinate.
        change: Its change [rad or m].
        q: The configuration afterwards (nq,).
    """

    coordinate: Coordinate
    change: float
    q: Array


class Turn(NamedTuple):
    """One joint's part of a sweep.

    Attributes:
        joint: The joint's name.
        slides: Whether it slides instead of turning.
        change: Its change [rad or m].
        limited: Whether a limit ended the change.
        target: The number of the target whose effector is followed; the first one that the joint moves.
        axis, origin: The unit axis (3,) and a point on it (3,) [m], in the world, before the change.
        amount: How far the effector turns about that axis or slides along it [rad or m].
        before, after: The effector's point before and after the change (3,) [m].
        chain: Points of the chain after the change (k, 3) [m]: the origin of each of its joints, and the effector.
        moved: The number of the first of these points that the change moves; k if it moves none.
    """

    joint: str
    slides: bool
    change: float
    limited: bool
    target: int
    axis: Array
    origin: Array
    amount: float
    before: Array
    after: Array
    chain: Array
    moved: int


def turns_of(kinematics: Kinematics, q: Array, passages: Iterable[Passage], limits: Limits) -> tuple[Turn, ...]:
    """The turns of a sweep that began at `q` (nq,)."""
    turns = []
    for coordinate, change, after in passages:
        turns.append(_turn(kinematics, coordinate, change, (q, after), limits))
        q = after
    return tuple(turns)


def _turn(
    kinematics: Kinematics, coordinate: Coordinate, change: float, ends: tuple[Array, Array], limits: Limits
) -> Turn:
    mover, multiplier = coordinate.movers[0]
    target = _followed(kinematics, mover)
    model, data = kinematics.model, kinematics.data
    term = kinematics.problem.terms[target]

    def points() -> Array:
        effector = pinocchio.updateFramePlacement(model, data, term.frame).translation
        return np.array([*(data.oMi[joint.id].translation for joint in term.chain.joints), effector])

    pinocchio.forwardKinematics(model, data, ends[0])
    axis, origin = (np.array(part) for part in coordinate.line(data))
    before = points()
    low, high = coordinate.room(ends[0], limits)
    pinocchio.forwardKinematics(model, data, ends[1])
    after = points()
    moved = np.flatnonzero(abs(after - before).max(axis=1) > _ROUNDING)
    return Turn(
        joint=coordinate.joint.name,
        slides=coordinate.slides,
        change=change,
        limited=any(math.isfinite(end) and abs(change - end) < _ROUNDING for end in (low, high)),
        target=target,
        axis=axis,
        origin=origin,
        amount=change * multiplier,
        before=before[-1],
        after=after[-1],
        chain=after,
        moved=int(moved[0]) if moved.size else len(after),
    )


def _followed(kinematics: Kinematics, mover: Joint) -> int:
    """The number of the first target whose frame a joint moves."""
    chains = [term.chain.frame_support for term in kinematics.problem.terms]
    return next((k for k, support in enumerate(chains) if mover.id in support), 0)
