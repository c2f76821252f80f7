"""A run of the compiled engine whose targets move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...engine import load
from ...problem.targets import Target
from ..question import Question
from ..run import TO_THE_END
from ..state import State
from .codec import goals_of
from .compiling import make_engine
from .outcomes import state_of

__all__ = ["CompiledPursuit"]


class CompiledPursuit:
    """A `pursuit.Pursuit` of the compiled engine."""

    engine = "native"
    at_once = 16

    def __init__(self, question: Question, start: NDArray[np.float64], max_iterations: int) -> None:
        module = load()
        patience = module.Patience(TO_THE_END.iterations, TO_THE_END.progress)
        goals = goals_of(question.problem.targets)
        self._run = module.Pursuit(make_engine(question), start, goals, max_iterations, patience)

    @property
    def state(self) -> State:
        """The present state."""
        return state_of(*self._run.state())

    def advance(self, most: int) -> State:
        """Take at most `most` steps."""
        self._run.advance(most)
        return self.state

    def aim_at(self, targets: tuple[Target, ...]) -> State:
        """Move the targets, and take the next step."""
        self._run.aim_at(goals_of(targets))
        return self.state
