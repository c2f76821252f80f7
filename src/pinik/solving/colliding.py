"""The distinct answers of one solve at which something touches, and whether others are likely."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .choice import SAME_ANSWER
from .metric import Metric
from .question import Question

__all__ = ["LEAST_ATTEMPTS", "SINCE_NEW", "Colliding"]

Array = NDArray[np.float64]

LEAST_ATTEMPTS = 56
"""The smallest number of attempts before no further ones are made because all answers collide."""

SINCE_NEW = 3
"""The number of attempts for each answer found that must bring nothing new before no further ones are made."""


class Colliding:
    """Distinct answers to one question at which something touches; whole turns of hinges make no other answer.

    Attributes:
        found: The distinct configurations (nq,), in the order in which they were found.
    """

    def __init__(self, question: Question) -> None:
        self._metric = Metric(question.problem, question.limits)
        self.begin()

    def begin(self) -> None:
        """Forget all answers."""
        self.found: list[Array] = []
        self._hits: list[int] = []
        self._last_new = 0

    def add(self, q: Array, attempt: int) -> None:
        """Take the answer (nq,) of an attempt, which are counted from 0."""
        for number, other in enumerate(self.found):
            if self._metric.largest(other, q) <= SAME_ANSWER:
                self._hits[number] += 1
                return
        self.found.append(q)
        self._hits.append(1)
        self._last_new = attempt

    def is_enough(self, attempts: int) -> bool:
        """Whether further attempts are unlikely to bring another answer of any kind, if answers are isolated.

        So it is after many attempts, if each answer was found at least twice, and there were three attempts for each
        since the last new one: the rule by which `solve_all` ends.
        """
        since = attempts - 1 - self._last_new
        return attempts >= LEAST_ATTEMPTS and since >= SINCE_NEW * len(self.found) and min(self._hits, default=0) >= 2
