r"""A set of solutions every place of which is singular, such as that of an arm that stays stretched.

There the Jacobian $J$ has a smaller rank $r$ than usual, and its kernel is larger than the set, so that the residual
alone does not lead onto the set. What holds on the set besides is that the rank stays $r$. With orthonormal bases $U$
of the left kernel and $K$ of the kernel at a place nearby, that is, to first order,

$$U^\top J K = 0,$$

which takes the place of the rows of the residual that vanish with $J$ (deflation: Leykin, Verschelde and Zhao 2006).
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..question import Question
from .solution_set import Place, SolutionSet, worst

__all__ = ["SingularSet"]

Array = NDArray[np.float64]

_ASIDE = 1e-6  # [rad]: the step of the differences that give the derivative of J
_SEEN = 1e-3  # singular values of all equations below this part of the largest count as 0


class SingularSet(SolutionSet):
    """The solutions at which the Jacobian has one rank that is lower than usual. Curves that cross it are not found."""

    shows_crossings: ClassVar[bool] = False

    def __init__(self, question: Question, jacobian_rank: int, dimension: int) -> None:
        """The set for the targets of a question.

        Args:
            question: The question.
            jacobian_rank: The rank r of the Jacobian at all its places.
            dimension: The dimension of the set.
        """
        super().__init__(question)
        self._jacobian_rank, self.rank = jacobian_rank, self.n - dimension

    def at(self, q: Array) -> Place:
        """As for every set, with the condition on the rank among the equations."""
        found, r = self.kinematics.linearize(q), self._jacobian_rank
        J = self._jacobian(found.J)
        U, _, V = np.linalg.svd(J)
        along, left, kernel = U[:, :r].T, U[:, r:].T, V[r:].T
        vanishing = left @ J @ kernel
        slopes = np.array([(left @ (self._beside(q, k) - J) @ kernel).ravel() / _ASIDE for k in range(self.n)]).T
        e, all_J = np.concatenate((along @ found.e, -vanishing.ravel())), np.vstack((along @ J, slopes))
        rows = np.linalg.svd(all_J, full_matrices=False)[0][:, : self.rank].T
        miss = worst(found.errors)
        return Place(q, rows @ e, rows @ all_J, None, miss, max(miss, float(np.abs(vanishing).max(initial=0.0))))

    def _beside(self, q: Array, k: int) -> Array:
        """The Jacobian a little way along one free coordinate."""
        return self._jacobian(self.kinematics.linearize(self.step(q, _ASIDE * np.eye(self.n)[k])).J)

    def is_smooth_at(self, place: Place) -> bool:
        """Whether the equations have the rank at one of its places that makes the set smooth there."""
        sigma = np.linalg.svd(place.J, compute_uv=False)
        return bool(sigma[-1] > _SEEN * sigma[0]) if len(sigma) else False
