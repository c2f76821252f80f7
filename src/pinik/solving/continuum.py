"""How many dimensions the set of answers has around one of them: 0 if it is isolated, 1 on a curve, and so on.

Where the Jacobian has the rank that is usual for such a question, the set is smooth, and its dimension is the usual
one: that of the kernel. At a singular answer the kernel is larger, and the set may be as large or not. An answer of a
stretched arm may be isolated, as two answers meet there, or one of a curve; a wrist with two axes in line has a curve
or a surface. To tell them apart, answers are looked for a little way along the kernel, by Newton steps back to the
targets. On a curve they arrive at another answer; beside two answers that meet, only at the same one again.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.kinematics import Kinematics, Linearization
from .metric import joint_scales

__all__ = ["Continuum", "largest_part"]

Array = NDArray[np.float64]

SINGULAR = 1e-4
"""Singular values at an answer below this part of the largest count as 0; rounding and merging answers blur them."""

RANK_THRESHOLD = 1e-6
"""Singular values elsewhere below this part of the largest count as 0."""

ASIDE = 0.02
"""The length of the step along the kernel [rad, or lengths of the chain]."""

ITERATIONS = 24
"""The largest number of Newton steps back to the targets; beside a double place each only halves the distance."""

PARTS = 8
"""The number of directions in each plane of a kernel of two dimensions, in half a turn."""

FEW_PARTS = 2
"""The same in a kernel of more dimensions, which has more planes."""


class Continuum:
    """Finds the dimension of the set of answers around one of them, for one problem.

    Attributes:
        free: The indices (n,) of the free tangent coordinates, without those whose limits leave a single value.
    """

    def __init__(self, kinematics: Kinematics, limits: Limits) -> None:
        """Prepare; the tolerances of the kinematics' problem tell what reaches the targets."""
        self._kinematics, problem = kinematics, kinematics.problem
        single = (limits.entry >= 0) & (limits.lower == limits.upper)[limits.entry]
        self.free = np.flatnonzero(problem.free & ~single)
        self._scales = joint_scales(problem)[self.free]

    def settled(self, q: Array) -> Array:
        """An answer (nq,) made as exact as Newton steps can: beside a double place errors of 1e-9 are far from it."""
        here, last = q, math.inf
        for _ in range(ITERATIONS):
            at = self._kinematics.linearize(here)
            if not at.residual < last:
                break
            q, last = here, at.residual
            here = self._nearer(here, at, 0)
        return q

    def kernel(self, q: Array) -> Array:
        """An orthonormal basis (k, n) of the kernel of the Jacobian at an answer (nq,), in the joint metric."""
        _, sigma, V = self._decomposed(self._kinematics.linearize(q).J)
        return V[_rank(sigma, SINGULAR) :]

    def rank(self, q: Array, threshold: float) -> int:
        """The rank of the Jacobian at any configuration (nq,): singular values above this part of the largest count."""
        return _rank(self._decomposed(self._kinematics.linearize(q).J)[1], threshold)

    def dimension(self, q: Array, kernel: Array, usual: int) -> int:
        """The dimension of the set of answers around one of them (nq,) with a kernel (k, n); 0 if it is isolated.

        Several parts of the set may meet there, whose dimensions differ: the largest counts. In each part it is that of
        the kernel beside the answer, and at most that of the directions in which there are other answers, of which only
        some may be found from a very singular answer: then those beside it are asked in turn.

        Args:
            q: The answer, at which the kernel is larger than usual.
            kernel: The kernel there.
            usual: The dimension that sets of answers to such a question usually have.
        """
        most = len(kernel)
        ways: dict[int, list[Array]] = {}
        places: dict[int, Array] = {}
        for direction in _directions(most):
            for left in {max(usual, 1), most}:
                found = self._beside(q, ASIDE * direction @ kernel, left)
                if found is None:
                    continue
                if most == 1:
                    return 1
                way = pinocchio.difference(self._kinematics.model, q, found)[self.free] * self._scales
                left_there = len(self.kernel(found))
                ways.setdefault(left_there, []).append(way)
                places.setdefault(left_there, found)
        largest = max(largest_part(ways, ASIDE), usual if usual in ways else 0)
        for beside in sorted(places, reverse=True):
            if largest < beside < most:
                largest = max(largest, self.dimension(places[beside], self.kernel(places[beside]), usual))
        return largest

    def _decomposed(self, J: Array) -> tuple[Array, Array, Array]:
        U, sigma, V = np.linalg.svd(J[:, self.free] / self._scales)
        return U, sigma, V

    def _beside(self, q: Array, aside: Array, left: int) -> Array | None:
        """The answer (nq,) near to q after a motion (n,), by Newton steps without the `left` last directions.

        None if there is none that is still at least a quarter as far away.
        """
        here, last = self._moved(q, aside), math.inf
        for _ in range(ITERATIONS):
            at = self._kinematics.linearize(here)
            terms = self._kinematics.problem.terms
            if all([error.within(term.tolerance) for error, term in zip(at.errors, terms, strict=True)]):
                away = pinocchio.difference(self._kinematics.model, q, here)[self.free] * self._scales
                return here if float(np.linalg.norm(away)) > 0.25 * ASIDE else None
            if not at.residual < last:
                return None
            last = at.residual
            here = self._nearer(here, at, left)
        return None

    def _nearer(self, q: Array, at: Linearization, left: int) -> Array:
        """The configuration (nq,) after a Newton step from q, without the `left` last directions."""
        U, sigma, V = self._decomposed(at.J)
        rank = min(len(V) - left, _rank(sigma, RANK_THRESHOLD))
        return self._moved(q, ((at.e @ U[:, :rank]) / sigma[:rank]) @ V[:rank])

    def _moved(self, q: Array, step: Array) -> Array:
        """The configuration (nq,) after a motion (n,)."""
        problem = self._kinematics.problem
        dq = np.zeros(problem.model.nv)
        dq[self.free] = step / self._scales
        return problem.moved(q, dq)


def _rank(sigma: Array, threshold: float) -> int:
    return int((sigma > threshold * sigma.max(initial=0.0)).sum())


def largest_part(ways: Mapping[int, Sequence[Array]], aside: float) -> int:
    """The largest dimension of the parts of a set that meet at one of its places; 0 if there are no others beside it.

    Args:
        ways: The motions (n,) from there to places of the set beside it, by the dimension of the kernel at these.
            Single places of a part may have larger kernels than most.
        aside: How far away they are.
    """
    largest, motions = 0, list[Array]()
    for kernel in sorted(ways, reverse=True):
        motions += ways[kernel]
        spanned = int((np.linalg.svd(np.array(motions), compute_uv=False) > 0.3 * aside).sum())
        largest = max(largest, min(kernel, spanned))
    return largest


def _directions(dimension: int) -> list[Array]:
    """Unit directions in a space of some dimensions: both along each axis, and more in the plane of each two."""
    axes, parts = np.eye(dimension), PARTS if dimension == 2 else FEW_PARTS
    directions = [sign * axis for axis in axes for sign in (1.0, -1.0)]
    for a, b in itertools.combinations(axes, 2):
        for k in range(2 * parts):
            turn = math.pi * k / parts
            directions.append(math.cos(turn) * a + math.sin(turn) * b)
    return directions
