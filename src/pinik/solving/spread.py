"""Starts that are spread over the configurations whose frames are near to the targets."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from .starts import OF_THE_TABLE, uniform
from .table import Table

__all__ = ["Spread"]

Array = NDArray[np.float64]

SIZE = 4096
"""The number of configurations in the table."""

NEAREST = 128
"""The number of configurations, those whose frames are nearest to the targets, that starts are chosen from."""


class Spread:
    """Chooses starts one after the other.

    Each is, of the configurations whose frames are nearest to the targets, the one that is farthest from everything
    marked: from the starts before and from the answers found. The configurations are a low-discrepancy sequence in the
    joints' ranges: the additive recurrence R_d (Roberts 2018, "The unreasonable effectiveness of quasirandom
    sequences"), shifted by the seed.
    """

    def __init__(self, kinematics: Kinematics, limits: Limits, seed: int) -> None:
        self._limits, self._size_of_chain = limits, kinematics.problem.size_of_chain
        self._table = Table(kinematics, limits, SIZE, lambda k: partial(self._share, k))
        drawn = self._table.drawn
        root = 2.0  # φ, where φ^(d+1) = φ + 1
        for _ in range(64):
            root = (1.0 + root) ** (1.0 / (len(drawn) + 1.0))
        steps = np.cumprod(np.full(len(drawn), 1.0 / root)).tolist()
        self._steps = {joint.name: step for joint, step in zip(drawn, steps, strict=True)}
        self._offsets = {joint.name: uniform(seed, OF_THE_TABLE, 0, joint.idx_v) for joint in drawn}
        self._candidates: NDArray[np.intp] = np.zeros(0, dtype=np.intp)

    def _share(self, k: int, joint: Joint) -> float:
        return float((self._offsets[joint.name] + k * self._steps[joint.name]) % 1.0)

    def begin(self, start: Array) -> int:
        """Prepare to choose starts for the current targets, and return how many there are.

        Joints that are not drawn will be as in `start` (nq,).
        """
        self._start = start
        table = self._table
        if not table.drawn:
            return 0
        table.rank(start)
        self._candidates = np.sort(np.argsort(table.scores, kind="stable")[:NEAREST])
        self._values = np.array([self._in_turns(table.configurations[k]) for k in self._candidates])
        self._least = np.full(len(self._candidates), np.inf)
        self._turns = np.array([joint.nq == 2 or self._limits.turning[joint.idx_q] for joint in table.drawn])
        return len(self._candidates)

    def take(self, index: int, start: Array) -> Array:
        """Configuration `index` of the table (nq,), with all that is not drawn as in `start`."""
        return self._table.take(index, start)

    def mark(self, q: Array) -> None:
        """Mark a configuration (nq,), from which later starts shall be far away."""
        if self._candidates.size:
            changes = self._values - self._in_turns(q)
            changes = np.where(self._turns, changes - np.round(changes), changes)
            self._least = np.minimum(self._least, np.sum(changes**2, axis=1))

    def next(self) -> Array:
        """The next start (nq,), which is marked."""
        chosen = int(np.argmax(self._least))
        q = self._table.take(int(self._candidates[chosen]), self._start)
        self.mark(q)
        self._least[chosen] = -1.0
        return q

    def _in_turns(self, q: Array) -> Array:
        """The values of the drawn joints in whole turns, or in 2π lengths of the chain."""
        values = [
            joint.angle(q) / (self._size_of_chain if joint.kind == "prismatic" else 1.0) for joint in self._table.drawn
        ]
        return np.array(values) / (2.0 * math.pi)
