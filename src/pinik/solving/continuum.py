"""Whether an answer belongs to a continuum, although answers to such a question are usually isolated.

Where the Jacobian has its full rank, an answer is isolated. At a singular one it may be isolated too, as that of a
stretched arm, at which two answers meet; or it may be a point of a curve or a surface, as that of a wrist with two axes
in line. To tell them apart, solutions are looked for a little way along the kernel. A step along the kernel is followed
by Newton steps that leave the kernel alone: on a curve they reach the targets again, and beside two answers that meet
they cannot.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from .metric import joint_scales

__all__ = ["Continuum"]

Array = NDArray[np.float64]

SINGULAR = 1e-4
"""Singular values at an answer below this part of the largest count as 0; rounding and merging answers blur them."""

ASIDE = 0.02
"""The length of the step along the kernel [rad, or lengths of the chain]."""

ITERATIONS = 8
"""The largest number of Newton steps back to the targets."""

PARTS = 8
"""The number of directions in each plane of a kernel of two or more dimensions, in half a turn."""


class Continuum:
    """Finds the dimension of the set of answers around one of them, for the free coordinates of one problem."""

    def __init__(self, kinematics: Kinematics, limits: Limits) -> None:
        """Prepare; the tolerances of the kinematics' problem tell what reaches the targets."""
        self._kinematics, problem = kinematics, kinematics.problem
        single = (limits.entry >= 0) & (limits.lower == limits.upper)[limits.entry]
        self._free = np.flatnonzero(problem.free & ~single)
        self._scales = joint_scales(problem)[self._free]

    def kernel(self, q: Array) -> Array:
        """An orthonormal basis (k, n) of the kernel of the Jacobian at an answer (nq,), in the joint metric."""
        _, sigma, V = self._decomposed(self._kinematics.linearize(q).J)
        return V[int((sigma > SINGULAR * sigma.max(initial=0.0)).sum()) :]

    def dimension(self, q: Array, kernel: Array) -> int:
        """The dimension of the set of answers around one of them (nq,) with a kernel (k, n); 0 if it is isolated.

        It is that of the kernel beside the answer, and at most that of the directions in which there are others.
        """
        most = len(kernel)
        ways: list[Array] = []
        least = most
        for direction in _directions(most):
            for left in {1, most}:
                found = self._beside(q, ASIDE * direction @ kernel, left)
                if found is None:
                    continue
                ways.append(pinocchio.difference(self._kinematics.model, q, found)[self._free] * self._scales)
                least = min(least, len(self.kernel(found)))
                if most == 1:
                    return 1
        if not ways:
            return 0
        spanned = int((np.linalg.svd(np.array(ways), compute_uv=False) > 0.3 * ASIDE).sum())
        return max(1, min(spanned, least))

    def _decomposed(self, J: Array) -> tuple[Array, Array, Array]:
        U, sigma, V = np.linalg.svd(J[:, self._free] / self._scales, full_matrices=False)
        return U, sigma, V

    def _beside(self, q: Array, aside: Array, left: int) -> Array | None:
        """The answer (nq,) near to q after a motion (n,), by Newton steps without the `left` smallest singular values.

        None if there is none that is still at least half as far away.
        """
        here, last = self._moved(q, aside), math.inf
        for _ in range(ITERATIONS):
            at = self._kinematics.linearize(here)
            terms = self._kinematics.problem.terms
            if all([error.within(term.tolerance) for error, term in zip(at.errors, terms, strict=True)]):
                away = pinocchio.difference(self._kinematics.model, q, here)[self._free] * self._scales
                return here if float(np.linalg.norm(away)) > 0.5 * ASIDE else None
            if not at.residual < last:
                return None
            last = at.residual
            U, sigma, V = self._decomposed(at.J)
            rank = len(sigma) - left
            if not (sigma[:rank] > 0.0).all():
                return None
            here = self._moved(here, ((at.e @ U[:, :rank]) / sigma[:rank]) @ V[:rank])
        return None

    def _moved(self, q: Array, step: Array) -> Array:
        """The configuration (nq,) after a motion (n,)."""
        problem = self._kinematics.problem
        dq = np.zeros(problem.model.nv)
        dq[self._free] = step / self._scales
        return problem.moved(q, dq)


def _directions(dimension: int) -> list[Array]:
    """Unit directions in a space of some dimensions: both along each axis, and more in the plane of each two."""
    axes = np.eye(dimension)
    directions = [sign * axis for axis in axes for sign in (1.0, -1.0)]
    for a, b in itertools.combinations(axes, 2):
        for k in range(2 * PARTS):
            turn = math.pi * k / PARTS
            directions.append(math.cos(turn) * a + math.sin(turn) * b)
    return directions
