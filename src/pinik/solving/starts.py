"""The starts of attempts, from random numbers that depend only on seed, target and attempt, equal in both engines."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from ..problem.problem import Problem
from ..problem.rows import Rows
from ..problem.targets import Target

__all__ = ["Starts", "random_start", "uniform"]

Array = NDArray[np.float64]

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15

SIZE = 256  # configurations in the table
NEAREST = 32  # configurations of the table that are tried before others are drawn
OF_THE_TABLE = _MASK  # the key that replaces a target's index when the table is drawn


class Starts:
    """The starts of restarts.

    The first starts come from a table of configurations, ordered by the distance of their frames from the targets; the
    others are drawn at random. The table is drawn when it is first needed, and used for all targets.
    """

    def __init__(self, kinematics: Kinematics, limits: Limits, seed: int) -> None:
        self._kinematics = kinematics
        self._limits = limits
        self._seed = seed
        problem = kinematics.problem
        drawn = [joint for joint in problem.robot.joints if _is_drawn(joint, problem)]
        is_drawn = np.zeros(problem.model.nq, dtype=bool)
        for joint in drawn:
            is_drawn[joint.idx_q : joint.idx_q + joint.nq] = True
        needed = np.zeros_like(is_drawn)
        for term in problem.terms:
            for joint in problem.robot.joints:
                if joint.id in term.chain.frame_support | term.chain.reference_support:
                    needed[joint.idx_q : joint.idx_q + joint.nq] = True
        self._drawn = np.flatnonzero(is_drawn)
        self._still = np.flatnonzero(needed & ~is_drawn)  # the table is valid for the present values of these entries
        self._table: Array | None = None  # (size, nq)
        self._lengths: Array = np.zeros(SIZE)
        self._seen: Array = np.zeros((SIZE, 0))
        self._order: NDArray[np.intp] = np.zeros(0, dtype=np.intp)

    @property
    def draws(self) -> bool:
        """Whether any joint is drawn at random; otherwise all starts are equal."""
        return self._drawn.size > 0

    def next(self, q0: Array, *, target: int, number: int) -> Array:
        """Start `number` (1, 2, …) for the current targets, whose index is `target`; the first call must be number 1.

        Joints that are not drawn keep their values in `q0`.
        """
        if number > NEAREST:
            return random_start(
                self._kinematics.problem, self._limits, q0, seed=self._seed, target=target, attempt=number
            )
        if number == 1:
            self._rank(q0)
        assert self._table is not None
        q = q0.copy()
        q[self._drawn] = self._table[self._order[number - 1], self._drawn]
        return q

    def _rank(self, q0: Array) -> None:
        """Order the table by squared distance from the targets.

        A radian counts as in `Linearization.distance`, and a squared angle as 2 − 2 cos, so that the score is linear in
        the numbers of the targets. The direction towards a point (`at`) is not linear, and is left out.
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
                random_start(kinematics.problem, self._limits, about, seed=self._seed, target=OF_THE_TABLE, attempt=k)
                for k in range(SIZE)
            ]
        )
        rows = []
        for k, q in enumerate(self._table):
            pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
            for own in kinematics.rows:
                own.update_placements()
            of_a_radian = kinematics.problem.squared_metres_per_radian
            parts = [_seen(own, of_a_radian) for own in kinematics.rows]
            self._lengths[k] = sum(length for length, _ in parts)
            rows.append(np.concatenate([row for _, row in parts]))
        self._seen = np.array(rows)


def _wanted(target: Target) -> Array:
    parts = [
        np.zeros(0) if target.position is None else target.position[list(target.along)],
        np.zeros(0) if target.rotation is None else target.rotation.ravel(),
        np.zeros(0) if target.direction is None else target.direction,
    ]
    return np.concatenate(parts)


def _seen(rows: Rows, of_a_radian: float) -> tuple[float, Array]:
    """One target's part of a score: a constant, and the factors on `_wanted`; `of_a_radian` in [m²/rad²]."""
    target, weight = rows.target, rows.term.weight**2
    p, R = rows.seen_from_reference()
    length, parts = 0.0, [np.zeros(0)]
    if target.position is not None:
        p = p[list(target.along)]
        length = weight * float(p.dot(p))
        parts.append(-2.0 * weight * p)
    if target.rotation is not None:
        parts.append(-weight * of_a_radian * R.ravel())
    elif target.axis is not None and target.direction is not None:
        parts.append(-2.0 * weight * of_a_radian * R.dot(target.axis))
    return length, np.concatenate(parts)


def _is_drawn(joint: Joint, problem: Problem) -> bool:
    return bool(joint.has_one_axis and joint.nv and problem.free[joint.idx_v])


def uniform(seed: int, target: int, attempt: int, index: int) -> float:
    """The random number in [0, 1) for these four keys, by SplitMix64 (Steele, Lea and Flood 2014)."""
    state = seed & _MASK
    for key in (target, attempt, index):
        state = _mix((state + _GOLDEN * (key + 1)) & _MASK)
    return float((state >> 11) * 2.0**-53)


def random_start(problem: Problem, limits: Limits, q0: Array, *, seed: int, target: int, attempt: int) -> Array:
    """A configuration (nq,) with every free one-axis joint drawn at random and all others as in `q0`.

    Joint values are uniform in `Joint.range_to_draw_from`; for prismatic joints without limits, this range is around
    `q0`.
    """
    q = q0.copy()
    for joint in problem.robot.joints:
        if not _is_drawn(joint, problem):
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
