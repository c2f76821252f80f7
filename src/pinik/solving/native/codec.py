"""The conversion of targets into rows of numbers for the compiled engine, and back."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ...checks import FARTHEST
from ...engine import load
from ...problem.targets import Target
from .module import why_not

__all__ = ["goals_of", "read_places", "targets_of"]

Array = NDArray[np.float64]


def goals_of(targets: tuple[Target, ...]) -> Array:
    """Encode targets as rows (n, 18): position (3), rotation matrix by rows (9), direction (3), point to look at (3).

    Numbers that a target does not constrain are zero.
    """
    goals = np.zeros((len(targets), 18))
    for row, target in zip(goals, targets, strict=True):
        if target.position is not None:
            row[:3] = np.where(target.along, target.position, 0.0)
        if target.rotation is not None:
            row[3:12] = target.rotation.ravel()
        if target.direction is not None:
            row[12:15] = target.direction
        if target.at is not None:
            row[15:] = target.at
    return goals


def read_places(places: object, threads: int) -> tuple[Array, NDArray[np.int64]] | None:
    """Encode places as rows (N, 18) in threads, and find those that must still be checked.

    Args:
        places: Contiguous float64 arrays (N, 4, 4) or (N, 3) are read; of anything else there is no result.
        threads: The number of threads.

    Returns:
        (the rows, the indices of places that are not exact rotations or may be faulty); None without the engine.
    """
    read: tuple[Array, NDArray[np.int64]] | None = None
    if not why_not():
        read = load().read_places(places, FARTHEST, threads)
    return read


def targets_of(pattern: tuple[Target, ...], goals: Iterable[Array]) -> tuple[Target, ...]:
    """Decode rows that `goals_of` made: targets of the same kind as `pattern`, with the numbers of `goals` (n, 18)."""
    return tuple(
        target.with_numbers(goal[:3], goal[3:12].reshape(3, 3), goal[12:15], goal[15:])
        for target, goal in zip(pattern, goals, strict=True)
    )
