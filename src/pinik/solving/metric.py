"""The joint metric: how far two configurations are apart, with radians and metres in one measure."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.problem import Problem

__all__ = ["Metric", "joint_scales", "largest_difference"]

Array = NDArray[np.float64]

_TURN = 2.0 * math.pi


def joint_scales(problem: Problem) -> Array:
    """The factors (nv,) on tangent coordinates: 1 for radians, and 1 per length of the chain for metres."""
    scales = np.ones(problem.model.nv)
    for coordinate in problem.coordinates:
        if coordinate.joint.slides(coordinate.index):
            scales[coordinate.joint.idx_v + coordinate.index] = 1.0 / problem.size_of_chain
    return scales


def largest_difference(model: pinocchio.Model, a: Array, b: Array, factors: Array | float = 1.0) -> float:
    """The largest tangent coordinate of the way from configuration a (nq,) to b, each times its factor (nv,)."""
    return float(np.abs(factors * pinocchio.difference(model, a, b)).max(initial=0.0))


class Metric:
    """Changes of the free coordinates in radians, or in lengths of the chain; whole turns of hinges are no change."""

    def __init__(self, problem: Problem, limits: Limits) -> None:
        """Prepare for the free coordinates of a problem; limits tell which of them may make whole turns."""
        self._model = problem.model
        joints = [coordinate.joint for coordinate in problem.coordinates]
        self._columns = np.array([c.joint.idx_v + c.index for c in problem.coordinates], dtype=np.intp)
        self._scales = joint_scales(problem)[self._columns]
        self._turns = np.array([joint.nq == 1 and limits.turning[joint.idx_q] for joint in joints], dtype=bool)

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
