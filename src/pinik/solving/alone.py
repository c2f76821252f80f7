"""What of a missed pose can be reached alone: its position, or its orientation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..problem.targets import Target
from ..solvers.damped_least_squares import DampedLeastSquares
from .attempts import Attempts
from .native.codec import goals_of
from .native.compiling import make_engine
from .native.module import why_not
from .native.outcomes import NativeOutcome
from .options import Options
from .question import Question
from .state import Status

__all__ = ["found_alone"]

Array = NDArray[np.float64]

_RESTARTS = 10


def found_alone(question: Question, targets: Sequence[Target], q: Array) -> list[str]:
    """Which of "position" and "orientation" is found when it is asked for alone; empty if no target asks for both.

    Args:
        question: The problem and the options.
        targets: The targets.
        q: The best configuration (nq,) for both, from which the search starts.
    """
    if not any(target.asks_orientation and target.position is not None for target in targets):
        return []
    options = question.options
    asked = Options(
        DampedLeastSquares(),
        limits=options.limits,
        locked=(*options.locked, *options.method.held),
        restarts=_RESTARTS,
        seed=options.seed,
        tolerance=options.tolerance,
    )
    found = []
    for name in ("position", "orientation"):
        alone = [part for target in targets if (part := target.alone(name)) is not None]
        if _status(Question.of(question.robot, alone, asked), tuple(alone), q) is Status.CONVERGED:
            found.append(name)
    return found


def _status(question: Question, targets: tuple[Target, ...], q: Array) -> Status:
    """What a solve from `q` comes to, in the compiled engine if there is one."""
    if why_not(question.solver):
        return Attempts(question)(targets, q).status
    answer = make_engine(question).solve(q, goals_of(targets), False)
    return NativeOutcome(answer, targets).status
