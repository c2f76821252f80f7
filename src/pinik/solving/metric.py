"""How far two configurations are apart."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.problem import Problem

__all__ = ["Metric"]

Array = NDArray[np.float64]

_TURN = 2.0 * math.pi


class Metric:
    """Changes of the free coordinates in radians, or in lengths of the chain; whole turns of hinges are no change."""

    def __init__(self, problem: Problem, limits: Limits) -> None:
        """Prepare for the free coordinates of a problem; limits tell which of them may make whole turns."""
        self._model = problem.model
        count = len(problem.coordinates)
        self._columns = np.zeros(count, dtype=np.intp)
        self._scales = np.ones(count)
        self._turns = np.zeros(count, dtype=bool)
        for number, coordinate in enumerate(problem.coordinates):
            joint = coordinate.joint
            self._columns[number] = joint.idx_v + coordinate.index
            self._scales[number] = 1.0 / problem.size_of_chain if joint.slides(coordinate.index) else 1.0
            self._turns[number] = joint.nq == 1 and bool(limits.turning[joint.idx_q])

    def changes(self, a: Array, b: Array) -> Array:
        """The change of each free coordinate from configuration a (nq,) to b [rad, or lengths of the chain]."""
        changes = pinocchio.difference(self._model, a, b)[self._columns]
        whole = _TURN * np.round(changes / _TURN)
        return np.asarray(self._scales * np.where(self._turns & (np.abs(changes) > math.pi), changes - whole, changes))

    def length(self, a: Array, b: Array) -> float:
        """The root of the sum of the squared changes."""
        return float(np.linalg.norm(self.changes(a, b)))

    def largest(self, a: Array, b: Array) -> float:
        """The largest change."""
        return float(np.abs(self.changes(a, b)).max(initial=0.0))
