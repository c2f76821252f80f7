"""Shortcuts to the compiled engine for calls that are equal to the last one, except for the place and the start."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...engine import load
from ...solvers.registry import SOLVERS
from ..question import Question

__all__ = ["make_call", "note", "recalling"]

if TYPE_CHECKING:
    from ..._native import Call, Engine

P = ParamSpec("P")
R = TypeVar("R")


def make_call(engine: Engine, neutral: NDArray[np.float64], solution: type, question: Question) -> Call:
    """Compile the call of a prepared problem: from a place and a start straight to a solution.

    Args:
        engine: The compiled problem.
        neutral: The start where none is given (nq,).
        solution: The class of the solutions.
        question: What solutions hold besides the engine's answer.
    """
    call: Call = load().Call(engine, neutral, pinocchio.SE3, solution, question)
    return call


def recalling(place: int = -1) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate `solve`, whose first argument is the robot: it recalls the last call of each thread.

    If a call has the very same arguments as the last one, apart from `position` or `placement` and `q0`, the compiled
    problem of the last call solves it without a detour through Python. This is so only for arguments that cannot
    change, such as numbers and names, and as long as the problem is cached with the robot.

    Args:
        place: The index of the position among the positional arguments; −1 if it is not one of them.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        module = load()
        return function if isinstance(module, str) else module.recalling(function, place, SOLVERS)

    return decorate


def note(call: Call) -> None:
    """Note the call that has answered, so that the decorated function recalls it."""
    load().note(call)
