"""Pursuits: runs that go on while their targets move, in either engine."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..problem.targets import Target
from .native.module import engine_for
from .native.pursuit import CompiledPursuit
from .question import Question
from .run import Pace, run
from .state import State

__all__ = ["Pursuit", "pursue"]

Array = NDArray[np.float64]


class Pursuit(Protocol):
    """A run that goes on from where it is when its targets move. Its states are those of `run.run`, in their order.

    Attributes:
        engine: "python" or "native".
        at_once: How many steps take about as long as a look at the clock is worth.
    """

    engine: str
    at_once: int

    @property
    def state(self) -> State:
        """The present state; the start's before the first step. One with a status stays until the targets move."""

    def advance(self, most: int) -> State:
        """Take at most `most` steps, fewer if the run comes to its end, and return the state after them."""

    def aim_at(self, targets: tuple[Target, ...]) -> State:
        """Move the targets, which must be of the same kinds, begin the iteration limit anew, and take the next step."""


def pursue(question: Question, start: Array, max_iterations: int) -> Pursuit:
    """Begin a pursuit, in the engine that the question's options ask for.

    Args:
        question: The targets and the options.
        start: The start (nq,), inside the limits.
        max_iterations: The maximum number of iterations until the targets move.

    Raises:
        EngineError: The compiled engine was asked for and cannot be used.
    """
    if engine_for(question.solver, question.options.engine) == "native":
        return CompiledPursuit(question, start, max_iterations)
    return _PythonPursuit(question, start, max_iterations)


class _PythonPursuit:
    """A pursuit in Python, where any method can be used."""

    engine = "python"
    at_once = 1

    def __init__(self, question: Question, start: Array, max_iterations: int) -> None:
        self._states = run(question, Kinematics.of(question.problem), start, Pace(max_iterations))
        self.state = next(self._states)

    def advance(self, most: int) -> State:
        while most > 0 and self.state.status is None:
            self.state = next(self._states)
            most -= 1
        return self.state

    def aim_at(self, targets: tuple[Target, ...]) -> State:
        self.state = self._states.send(targets)
        return self.state
