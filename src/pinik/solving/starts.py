"""Where attempts begin: numbers that depend on seed, target and attempt alone, the same in every engine."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.limits import Limits
from ..problem.kinematics import SQUARED_METRES_PER_RADIAN, Kinematics
from ..problem.targets import Target
from ..problem.term import TargetTerm

__all__ = ["Starts", "random_start", "uniform"]

Array = NDArray[np.float64]

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15

SIZE = 256
NEAREST = 32  # how many of the table's configurations are tried before others are drawn
OF_THE_TABLE = _MASK  # the table's key in place of a target's number


class Starts:
    """Where attempts begin that are given no start: near the target, as far as a table knows.

    The first take the configurations of a table whose frames are nearest to their targets, the nearest first; the
    others are drawn anew. The table is drawn too, once for all targets, when it is first wanted.
    """

    def __init__(self, kinematics: Kinematics, limits: Limits, seed: int) -> None:
        self._kinematics = kinematics
        self._limits = limits
        self._seed = seed
        drawn = [joint for joint in kinematics.robot.joints if _is_drawn(joint, kinematics)]
        is_drawn = np.zeros(kinematics.model.nq, dtype=bool)
        for joint in drawn:
            is_drawn[joint.idx_q : joint.idx_q + joint.nq] = True
        needed = np.zeros_like(is_drawn)
        for term in kinematics.terms:
            for joint in kinematics.robot.joints:
                if joint.id in term.frame_support | term.reference_support:
                    needed[joint.idx_q : joint.idx_q + joint.nq] = True
        self._drawn = np.flatnonzero(is_drawn)
        self._still = np.flatnonzero(needed & ~is_drawn)  # the table is for these values of theirs
        self._table: Array | None = None  # (size, nq)
        self._lengths: Array = np.zeros(SIZE)
        self._seen: Array = np.zeros((SIZE, 0))
        self._order: NDArray[np.intp] = np.zeros(0, dtype=np.intp)

    @property
    def draws(self) -> bool:
        """Whether any joint is drawn: without one, all starts are the same."""
        return self._drawn.size > 0

    def next(self, q0: Array, *, target: int, number: int) -> Array:
        """Start number 1, 2, … for the targets of the kinematics, `target` their number; the first comes first.

        All that is not drawn stays as in `q0`.
        """
        if number > NEAREST:
            return random_start(self._kinematics, self._limits, q0, seed=self._seed, target=target, attempt=number)
        if number == 1:
            self._rank(q0)
        assert self._table is not None
        q = q0.copy()
        q[self._drawn] = self._table[self._order[number - 1], self._drawn]
        return q

    def _rank(self, q0: Array) -> None:
        """Order the table by squared distance from the targets.

        A radian counts as in `Linearization.distance`, its square as 2 - 2 cos; so all but a constant is linear in what
        is wanted. The direction of a point to look at, which is not, is left out.
        """
        if self._table is None or (self._table[0, self._still] != q0[self._still]).any():
            self._make(q0)
        wanted = np.concatenate([_wanted(target) for target in self._kinematics.targets])
        scores = self._lengths + self._seen @ wanted
        self._order = np.argsort(scores, kind="stable")[:NEAREST]

    def _make(self, q0: Array) -> None:
        kinematics = self._kinematics
        about = q0.copy()
        about[self._drawn] = kinematics.robot.neutral()[self._drawn]
        self._table = np.array(
            [
                random_start(kinematics, self._limits, about, seed=self._seed, target=OF_THE_TABLE, attempt=k)
                for k in range(SIZE)
            ]
        )
        rows = []
        for k, q in enumerate(self._table):
            pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
            for term in kinematics.terms:
                term.update_placements()
            parts = [_seen(term) for term in kinematics.terms]
            self._lengths[k] = sum(length for length, _ in parts)
            rows.append(np.concatenate([row for _, row in parts]))
        self._seen = np.array(rows)


def _wanted(target: Target) -> Array:
    parts = [
        np.zeros(0) if target.position is None else target.position,
        np.zeros(0) if target.rotation is None else target.rotation.ravel(),
        np.zeros(0) if target.direction is None else target.direction,
    ]
    return np.concatenate(parts)


def _seen(term: TargetTerm) -> tuple[float, Array]:
    """What one target adds: a number, and what is multiplied with `_wanted`."""
    target, weight = term.target, term.weight**2
    p, R = term.seen_from_reference()
    length, parts = 0.0, [np.zeros(0)]
    if target.position is not None:
        length = weight * float(p.dot(p))
        parts.append(-2.0 * weight * p)
    if target.rotation is not None:
        parts.append(-weight * SQUARED_METRES_PER_RADIAN * R.ravel())
    elif target.axis is not None and target.direction is not None:
        parts.append(-2.0 * weight * SQUARED_METRES_PER_RADIAN * R.dot(target.axis))
    return length, np.concatenate(parts)


def _is_drawn(joint: Joint, kinematics: Kinematics) -> bool:
    return bool(joint.has_one_axis and joint.nv and kinematics.free[joint.idx_v])


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
        if not _is_drawn(joint, kinematics):
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
