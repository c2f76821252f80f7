"""The starts of attempts, from random numbers that depend only on seed, target and attempt, equal in both engines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from ..problem.problem import Problem
from .table import Share, Table, configuration_at

__all__ = ["OF_THE_TABLE", "Starts", "random_start", "uniform"]

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
        self._kinematics, self._limits, self._seed = kinematics, limits, seed
        self._table = Table(
            kinematics, limits, SIZE, lambda k: _random_share(seed=seed, target=OF_THE_TABLE, attempt=k)
        )
        self._order: NDArray[np.intp] = np.zeros(0, dtype=np.intp)

    @property
    def draws(self) -> bool:
        """Whether any joint is drawn at random; otherwise all starts are equal."""
        return bool(self._table.drawn)

    def next(self, q0: Array, *, target: int, number: int) -> Array:
        """Start `number` (1, 2, …) for the current targets, whose index is `target`; the first call must be number 1.

        Joints that are not drawn keep their values in `q0`.
        """
        if number > NEAREST:
            problem, keys = self._kinematics.problem, {"seed": self._seed, "target": target, "attempt": number}
            return random_start(problem, self._limits, q0, **keys)
        if number == 1:
            self._table.rank(q0)
            self._order = np.argsort(self._table.scores, kind="stable")[:NEAREST]
        return self._table.take(int(self._order[number - 1]), q0)


def uniform(seed: int, target: int, attempt: int, index: int) -> float:
    """The random number in [0, 1) for these four keys, by SplitMix64 (Steele, Lea and Flood 2014)."""
    state = seed & _MASK
    for key in (target, attempt, index):
        state = _mix((state + _GOLDEN * (key + 1)) & _MASK)
    return float((state >> 11) * 2.0**-53)


def random_start(problem: Problem, limits: Limits, q0: Array, *, seed: int, target: int, attempt: int) -> Array:
    """A configuration (nq,) with every free one-axis joint drawn at random and all others as in `q0`."""
    return configuration_at(problem, limits, q0, _random_share(seed=seed, target=target, attempt=attempt))


def _random_share(*, seed: int, target: int, attempt: int) -> Share:
    """The random part of each joint's range for these keys."""
    return lambda joint: uniform(seed, target, attempt, joint.idx_v)


def _mix(z: int) -> int:
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _MASK
    return z ^ (z >> 31)
