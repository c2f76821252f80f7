"""The dimension of a set of solutions around a configuration, and a place from which it can be explored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..continuum import largest_part
from .singular_set import SingularSet
from .solution_set import Place, SolutionSet

__all__ = ["Lone", "places_beside", "regular_place"]

Array = NDArray[np.float64]

_ROUNDING = 1e-14  # [m and rad]
_ASIDE = 0.02  # [rad]: how far from a singular place solutions are looked for
_BESIDE = 1e-4  # singular values beside a singular place below this part of the largest count as 0
_DIRECTIONS = 4  # directions in the kernel, and as many opposite ones, for each of its dimensions


@dataclass(frozen=True, eq=False)
class Lone:
    """A configuration of a set of solutions that is not explored further.

    Attributes:
        solutions: The set.
        q: The configuration (nq,).
        dimension: The dimension of the set there: 0 if the configuration has no others beside it.
    """

    solutions: SolutionSet
    q: Array
    dimension: int

    def reaches(self, q: Array, within: float) -> bool:
        """Whether a configuration (nq,) is this one, up to whole turns."""
        away = self.solutions.difference(self.q, self.solutions.turned(q, self.q))
        return float(np.linalg.norm(away)) <= within


def regular_place(solutions: SolutionSet, place: Place) -> tuple[SolutionSet, Place] | Lone:
    """A place of the set at which its dimension is seen, and from which it is explored: `place` itself, or one beside.

    Where the rank of the Jacobian is the usual one, the kernel is the tangent space of the set, and its dimension that
    of the set. Where it is lower, the kernel may be larger than the set is: solutions are looked for in many directions
    of the kernel. Several parts of the set may meet there, and the one of the largest dimension is explored. Curves
    that cross at `place` have the usual rank beside it; a set of which every place is singular, such as that of a wrist
    with two joints in line, has not. If such a set does not fill the kernel, as that of a stretched arm, it is a
    `SingularSet`.

    Args:
        solutions: The set; its rank becomes the rank at the place that is returned.
        place: A configuration of the set.

    Returns:
        The set and the place; or why there is none to explore the set from.
    """
    rank = solutions.rank_at(place.q)
    if rank >= solutions.rank:
        solutions.rank = rank
        return (solutions, solutions.at(place.q)) if rank < solutions.n else Lone(solutions, place.q, 0)
    beside: dict[int, list[Array]] = {}
    for found in places_beside(solutions, place.q, rank):
        beside.setdefault(solutions.n - solutions.rank_at(found.q, _BESIDE), []).append(found.q)
    ways = {kernel: [solutions.difference(place.q, q) for q in own] for kernel, own in beside.items()}
    dimension = largest_part(ways, _ASIDE)
    if dimension in beside:
        solutions.rank = solutions.n - dimension
        return solutions, solutions.at(place.q if rank == solutions.rank else beside[dimension][0])
    if dimension:
        kernel, (q, *_) = max(beside.items())
        singular = SingularSet(solutions.question, solutions.n - kernel, dimension)
        begin = singular.project(q, singular.kernel(singular.at(q)))
        if begin is not None and singular.is_smooth_at(begin):
            return singular, begin
    return Lone(solutions, place.q, dimension)


def places_beside(solutions: SolutionSet, q: Array, rank: int) -> list[Place]:
    """Solutions a little way from a singular one (nq,), in many directions of its kernel of dimension n − rank."""
    kernel = solutions.kernel_at(q, rank)
    rng = np.random.default_rng(0)
    directions = np.vstack((np.eye(len(kernel)), rng.normal(size=(_DIRECTIONS * len(kernel), len(kernel)))))
    found = []
    for direction in np.vstack((directions, -directions)):
        aside = solutions.step(q, _ASIDE * (direction / np.linalg.norm(direction)) @ kernel)
        near = solutions.slide(aside, _ROUNDING)  # where errors grow with a square, small ones are not near
        if near is not None and np.linalg.norm(solutions.difference(q, near.q)) > 0.5 * _ASIDE:
            found.append(near)
    return found
