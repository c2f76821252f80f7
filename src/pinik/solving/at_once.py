"""Vectorised solution of many targets by a closed form; plain Pinocchio checks each answer."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray

from ..problem.tolerance import TargetError
from ..solvers.two_bone import TwoBoneSolver
from .attempts import Outcomes
from .native.codec import targets_of
from .question import Question
from .run import AT_REST
from .state import Status
from .verdict import measure_positions, verdict

__all__ = ["attempt_at_once", "lands_at_once"]

Array = NDArray[np.float64]

_BLOCK = 8192  # targets per pass, so that their numbers stay in the processor's cache


def lands_at_once(question: Question) -> bool:
    """Whether the first step of the method is final, and the options allow the second step that confirms it."""
    solver, options = question.solver, question.options
    unhurried = options.iterations_at_most > 1 and options.time_limit == math.inf
    whole = all(term.tolerance.box is None for term in question.problem.terms)
    plain = unhurried and whole and not options.avoid
    return isinstance(solver, TwoBoneSolver) and solver.lands_at_once and plain


def attempt_at_once(question: Question, goals: Array, starts: Array) -> Outcomes:
    """What `Attempts` would find for goals (N, 1, 18) from starts (N or 1, nq), one after another."""
    began = time.perf_counter()
    count, positions, limits = len(goals), goals[:, 0, :3], question.limits
    starts = np.broadcast_to(limits.wrap(starts), (count, starts.shape[1]))
    q, missed, rests = np.empty(starts.shape), np.empty(count), np.empty(count, dtype=bool)
    for begin in range(0, count, _BLOCK):
        part = slice(begin, begin + _BLOCK)
        q[part], missed[part], rests[part] = _answered(question, positions[part], starts[part])
    status = np.full(count, Status.CONVERGED, dtype=object)
    outside = np.flatnonzero(missed > question.problem.terms[0].tolerance.farthest)
    status[outside] = [_status(question, goals[k], float(missed[k])) for k in outside]
    iterations = np.where((status == Status.CONVERGED) | rests, 1, 2) * question.problem.free.any()
    none = np.zeros(count, dtype=np.int64)
    seconds = np.full(count, (time.perf_counter() - began) / count)
    return Outcomes(q, status, missed, np.full(count, math.nan), iterations, none, none.copy(), none + 1, seconds)


def _answered(question: Question, positions: Array, starts: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """(nearest configurations (N, nq), their position errors (N,) [m], whether they equal their starts (N,))."""
    solver, problem = question.solver, question.problem
    assert isinstance(solver, TwoBoneSolver)
    q = question.limits.wrap(solver.answers(positions, starts, problem, question.limits), starts)
    reached = measure_positions(problem.robot, problem.targets[0], q)
    rests = np.abs(q - starts).max(axis=1) < AT_REST
    return q, np.linalg.norm(reached - positions, axis=1), rests


def _status(question: Question, goal: Array, missed: float) -> Status:
    """The status of a miss by this distance [m]."""
    targets = targets_of(question.problem.targets, goal)
    return verdict(question, targets, (TargetError(missed, None),), Status.STALLED).status
