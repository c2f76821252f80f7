"""The distinct answers that the attempts of one solve found, and the one nearest to the start."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .metric import joint_scales, largest_difference
from .question import Question

__all__ = ["NOTHING_NEW_SHARE", "SAME_ANSWER", "Choice"]

Array = NDArray[np.float64]

SAME_ANSWER = 0.01
"""The largest joint change between two answers that count as the same [rad, or m per length of the chain]."""

NOTHING_NEW_SHARE = 0.25
"""The share of the restarts that must bring no new answer in a row before no further restarts are made."""


class Choice:
    """Distinct answers to one question, all with their hinges turned to be near to the start.

    Attributes:
        found: The distinct configurations (nq,), in the order in which they were found.
        since: The number of attempts since the last new one.
    """

    def __init__(self, question: Question, start: Array) -> None:
        """Begin with no answers; `start` (nq,) is the start of the first attempt."""
        self._model, self._limits, self._start = question.robot.model, question.limits, start
        self._weights = np.ones(self._model.nv)
        self._scales = joint_scales(question.problem)
        for name, weight in question.options.choose_weights.items():
            joint = question.robot.settable_joint(name)
            self._weights[joint.idx_v : joint.idx_v + joint.nv] = weight
        self.found: list[Array] = []
        self.since = 0

    def add(self, q: Array | None) -> None:
        """Take the answer (nq,) of one more attempt, None if it failed."""
        self.since += 1
        if q is None:
            return
        q = self._limits.wrap(q, self._start)
        if all([largest_difference(self._model, other, q, self._scales) > SAME_ANSWER for other in self.found]):
            self.found.append(q)
            self.since = 0

    @property
    def nearest(self) -> Array:
        """The answer (nq,) with the smallest largest weighted joint change from the start."""
        return min(self.found, key=lambda q: largest_difference(self._model, self._start, q, self._weights))
