"""The dimension of a set of solutions around a configuration, and a place from which it can be explored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .solution_set import Place, SolutionSet

__all__ = ["Isolated", "places_beside", "regular_place"]

Array = NDArray[np.float64]

_ASIDE = 0.02  # [rad]: how far from a singular place solutions are looked for
_DIRECTIONS = 4  # directions in the kernel, and as many opposite ones, for each of its dimensions


@dataclass(frozen=True, eq=False)
class Isolated:
    """A configuration of a set of solutions that has no others beside it.

    Attributes:
        solutions: The set.
        q: The configuration (nq,).
    """

    solutions: SolutionSet
    q: Array

    def reaches(self, q: Array, within: float) -> bool:
        """Whether a configuration (nq,) is this one, up to whole turns."""
        away = self.solutions.difference(self.q, self.solutions.turned(q, self.q))
        return float(np.linalg.norm(away)) <= within


def regular_place(solutions: SolutionSet, place: Place) -> Place | None:
    """A place of the set at which its dimension is seen, and from which it is explored: `place` itself, or one beside.

    Where the rank of the Jacobian is the usual one, the kernel is the tangent space of the set, and its dimension that
    of the set. Where it is lower, the kernel may be larger than the set is: solutions are looked for in many directions
    of the kernel, and `solutions.rank` becomes the largest rank found among them. Curves that cross at `place` have the
    usual rank beside it; a set of which every point is singular, such as that of a stretched wrist, has not.

    Args:
        solutions: The set; its rank becomes the rank at the place that is returned.
        place: A configuration of the set.

    Returns:
        The place; None if no other solutions are beside it, so that it is isolated.
    """
    rank = solutions.rank_at(place.q)
    if rank >= solutions.rank:
        solutions.rank = rank
        return solutions.at(place.q) if rank < solutions.n else None
    beside = places_beside(solutions, place.q, rank)
    if not beside:
        return None
    ranks = [solutions.rank_at(found.q) for found in beside]
    solutions.rank = max(ranks)
    return solutions.at(place.q if solutions.rank == rank else beside[ranks.index(solutions.rank)].q)


def places_beside(solutions: SolutionSet, q: Array, rank: int) -> list[Place]:
    """Solutions a little way from a singular one (nq,), in many directions of its kernel of dimension n − rank."""
    kernel = solutions.kernel_at(q, rank)
    rng = np.random.default_rng(0)
    directions = np.vstack((np.eye(len(kernel)), rng.normal(size=(_DIRECTIONS * len(kernel), len(kernel)))))
    found = []
    for direction in np.vstack((directions, -directions)):
        near = solutions.slide(solutions.step(q, _ASIDE * (direction / np.linalg.norm(direction)) @ kernel))
        if near is not None and np.linalg.norm(solutions.difference(q, near.q)) > 0.5 * _ASIDE:
            found.append(near)
    return found
