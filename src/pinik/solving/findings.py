"""What a search for all answers came to."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..problem.tolerance import TargetError, largest_of

__all__ = ["Findings", "Found"]

Array = NDArray[np.float64]


@dataclass
class Found:
    """One answer.

    Attributes:
        q: The configuration (nq,).
        is_inside: Whether it is inside the limits.
        start: The number of the start from which it was found.
        hits: How many starts led to it.
        dimension: The dimension of the set of answers around it.
        basin: The distance from which a run that comes nearer is taken to end here.
        collides: Whether something touches that is to be avoided; None if that is not known yet.
    """

    q: Array
    is_inside: bool
    start: int
    hits: int = 1
    dimension: int = 0
    basin: float = 0.0
    collides: bool | None = None


@dataclass
class Findings:
    """What a search came to.

    Attributes:
        q: The answers inside the limits (n, nq), ordered by `distance`.
        distance: The largest change of a joint from the start to each (n,) [rad or m].
        position_error, orientation_error: Their largest errors (n,) [m, rad] by plain Pinocchio; NaN where none is
            asked for.
        found_at: The numbers of the starts from which they were found (n,); 0 is the given one.
        hits: How many starts led to each (n,).
        dimension: The dimension of the set of answers around each (n,): 0 for an isolated one; −1 if it is not known.
        colliding: The number of answers inside the limits at which something touches that is to be avoided.
        outside: The number of answers outside the limits; they are not looked for where answers are not isolated.
        starts: The number of starts.
        arrived: How many of these led to an answer, inside the limits or not.
        iterations: The iterations of all runs.
        redundancy: The largest dimension of the set of answers: 0 if all that were found are isolated; None if none was
            found, so that it is not known.
        ended_early: Whether the time limit ended the search.
        time: The duration of the search [s].
    """

    q: Array
    distance: Array
    position_error: Array
    orientation_error: Array
    found_at: NDArray[np.int64]
    hits: NDArray[np.int64]
    dimension: NDArray[np.int64]
    colliding: int
    outside: int
    starts: int
    arrived: int
    iterations: int
    redundancy: int | None
    ended_early: bool
    time: float

    @classmethod
    def nothing(cls, nq: int) -> Findings:
        """What no search comes to, for configurations of `nq` numbers."""
        none, counts = np.zeros(0), np.zeros(0, dtype=np.int64)
        return cls(np.zeros((0, nq)), none, none, none, counts, counts, counts, 0, 0, 0, 0, 0, None, False, 0.0)

    def with_answer(
        self,
        q: Array,
        distance: float,
        errors: Sequence[TargetError],
        *,
        found_at: int = 0,
        hits: int = 1,
        dimension: int = -1,
    ) -> Findings:
        """These findings and one more answer (nq,), the farthest; found from the given start unless told otherwise."""
        position, orientation = largest_of(errors)
        return dataclasses.replace(
            self,
            q=np.vstack([self.q, q]),
            distance=np.append(self.distance, distance),
            position_error=np.append(self.position_error, np.nan if position is None else position),
            orientation_error=np.append(self.orientation_error, np.nan if orientation is None else orientation),
            found_at=np.append(self.found_at, found_at),
            hits=np.append(self.hits, hits),
            dimension=np.append(self.dimension, dimension),
        )
