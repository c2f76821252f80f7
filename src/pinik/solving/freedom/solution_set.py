r"""The set of all configurations that reach the targets of a question exactly.

Where the Jacobian $J$ of the residual has rank $r$, the set is a smooth surface of dimension $n - r$ in the $n$ free
coordinates, and the kernel of $J$ is its tangent space. A configuration beside it is projected onto it by Newton steps
across given directions $B$, such as the tangents of a point nearby (Allgower and Georg 1990, chapter 10):

$$\begin{pmatrix} J \\ B \end{pmatrix} \delta = \begin{pmatrix} e \\ 0 \end{pmatrix}.$$
"""

from __future__ import annotations

import math
import threading
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...problem.kinematics import Kinematics
from ...problem.tolerance import TargetError
from ..aims import present
from ..metric import joint_scales
from ..question import Question

__all__ = ["EXACT", "RANK", "TURN", "Place", "SolutionSet", "worst"]

Array = NDArray[np.float64]

EXACT = 1e-8
"""The largest errors of a configuration that belongs to the set [m and rad]."""

RANK = 1e-6
"""Singular values below this part of the largest one count as 0."""

TURN = 2.0 * math.pi

_ENOUGH = 1e-13  # [m and rad]: no further Newton step is made; near singular places errors of 1e-9 are far from the set
_ITERATIONS = 12
_SAMPLES = 5  # random configurations at which the usual rank is found


class Place(NamedTuple):
    """The residual and its derivative at a configuration.

    Attributes:
        q: The configuration (nq,).
        e: The residual (r,), in the rows that `rows` combines.
        J: Its Jacobian (r, n) by the free coordinates, in the joint metric.
        rows: The r orthonormal combinations (r, m) of the m rows of the residual that are independent; None for all.
        miss: The largest error of a target [m or rad].
        left: The largest error of a target, or of whatever else holds on the set.
    """

    q: Array
    e: Array
    J: Array
    rows: Array | None
    miss: float
    left: float


class SolutionSet:
    """The configurations that reach the targets of one question exactly.

    Directions (n,) hold the free coordinates in the joint metric: radians, and metres per length of the chain.

    Attributes:
        question: The question.
        free: The indices (n,) of the free tangent coordinates, without those whose limits leave a single value.
        scales: The factors (n,) of the joint metric.
        rank: The rank r of the Jacobian on the set.
        shows_crossings: Whether the Jacobian shows where another curve crosses one of the set.
    """

    shows_crossings: ClassVar[bool] = True

    def __init__(self, question: Question) -> None:
        """The set for the targets of a question; its rank is the one that is usual for targets of these kinds."""
        problem = question.problem
        self.question = question
        self._local = threading.local()
        self.free = np.flatnonzero(problem.free & ~_single(question))
        self.scales = joint_scales(problem)[self.free]
        self._model = problem.model
        self._turning = np.flatnonzero(question.limits.turning)
        self.rank = self._usual_rank()

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_local"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _local=threading.local())

    @property
    def kinematics(self) -> Kinematics:
        """The residual and its Jacobian, for this thread."""
        own: Kinematics | None = getattr(self._local, "kinematics", None)
        if own is None:
            own = self._local.kinematics = Kinematics.of(self.question.problem)
        return own

    @property
    def n(self) -> int:
        """The number of free coordinates."""
        return len(self.free)

    def _usual_rank(self) -> int:
        """The rank of the Jacobian at random configurations, with targets that are met there."""
        rank, targets, kinematics = 0, self.question.problem.targets, self.kinematics
        for seed in range(_SAMPLES):
            q = self.question.robot.random(seed)
            kinematics.retarget(present(kinematics, targets, q))
            rank = max(rank, self.rank_at(q))
        kinematics.retarget(targets)
        return rank

    def rank_at(self, q: Array, least: float = RANK) -> int:
        """The rank of the Jacobian at a configuration: how many singular values exceed this part of the largest."""
        sigma = self.singular_values(q)
        return int((sigma > least * sigma.max(initial=0.0)).sum())

    def singular_values(self, q: Array) -> Array:
        """The singular values of the whole Jacobian in the joint metric, the largest first."""
        return np.array(np.linalg.svd(self._jacobian(self.kinematics.linearize(q).J), compute_uv=False))

    def _jacobian(self, J: Array) -> Array:
        return np.asarray(J[:, self.free] / self.scales)

    def at(self, q: Array) -> Place:
        """The residual and its Jacobian at `q` (nq,)."""
        found = self.kinematics.linearize(q)
        e, J, rows = found.e, self._jacobian(found.J), None
        if self.rank < len(e):
            rows = np.linalg.svd(J, full_matrices=False)[0][:, : self.rank].T
            e, J = rows @ e, rows @ J
        miss = worst(found.errors)
        return Place(q, e, J, rows, miss, miss)

    def step(self, q: Array, direction: Array) -> Array:
        """`q` after a motion (n,)."""
        dq = np.zeros(self._model.nv)
        dq[self.free] = direction / self.scales
        return self.question.problem.moved(q, dq)

    def difference(self, a: Array, b: Array) -> Array:
        """The motion (n,) from one configuration to another."""
        return np.asarray(pinocchio.difference(self._model, a, b)[self.free] * self.scales)

    def turned(self, q: Array, near: Array) -> Array:
        """Configurations (…, nq) with their hinges at the whole turns nearest to `near` (…, nq), limits or not."""
        q, entries = q.copy(), self._turning
        q[..., entries] -= TURN * np.round((q[..., entries] - near[..., entries]) / TURN)
        return q

    def project(self, q: Array, across: Array) -> Place | None:
        """The point of the set that Newton steps across some directions (n − r, n) lead to; None if to none."""
        best: Place | None = None
        for _ in range(_ITERATIONS):
            place = self.at(q)
            if best is not None and not place.left < best.left:
                break
            best = place
            if place.left <= _ENOUGH:
                break
            try:
                q = self.step(q, self._newton(place, across))
            except np.linalg.LinAlgError:
                break
        return best if best is not None and best.miss <= EXACT else None

    def _newton(self, place: Place, across: Array) -> Array:
        return np.linalg.solve(np.vstack((place.J, across)), np.concatenate((place.e, np.zeros(len(across)))))

    def slide(self, q: Array, enough: float = _ENOUGH) -> Place | None:
        """The point of the set that the shortest Newton steps lead to, also near a singular place; None if to none.

        Args:
            q: The configuration (nq,) to begin with.
            enough: The largest error at which no further step is made [m and rad].
        """
        best, least = q, math.inf
        for _ in range(3 * _ITERATIONS):
            found = self.kinematics.linearize(q)
            miss = worst(found.errors)
            if not miss < least:
                break
            best, least = q, miss
            if miss <= enough:
                break
            q = self.step(q, np.linalg.pinv(self._jacobian(found.J), rcond=RANK) @ found.e)
        return self.at(best) if least <= EXACT else None

    def kernel_at(self, q: Array, rank: int) -> Array:
        """An orthonormal basis (n − rank, n) of the kernel at any configuration."""
        return np.array(np.linalg.svd(self._jacobian(self.kinematics.linearize(q).J))[2][rank:])

    def kernel(self, place: Place) -> Array:
        """An orthonormal basis (n − r, n) of the tangents at a point of the set."""
        return np.array(np.linalg.svd(place.J)[2][self.rank :])

    def tangent(self, place: Place, near: Array) -> Array:
        """The unit tangent (n,) of a curve at one of its points, in the sense of the tangent `near` of a point nearby.

        Raises:
            LinAlgError: A singular place.
        """
        right = np.zeros(self.n)
        right[-1] = 1.0
        tangent = np.linalg.solve(np.vstack((place.J, near)), right)
        return np.asarray(tangent / math.sqrt(tangent.dot(tangent)))


def worst(errors: list[TargetError] | tuple[TargetError, ...]) -> float:
    """The largest error of all targets, in metres or radians."""
    return max((part for error in errors for part in error if part is not None), default=0.0)


def _single(question: Question) -> NDArray[np.bool_]:
    """Whether the limits leave each tangent coordinate (nv,) a single value."""
    limits = question.limits
    return np.asarray((limits.entry >= 0) & (limits.lower == limits.upper)[limits.entry])
