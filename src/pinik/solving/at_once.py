"""Many questions that a closed form answers all at once, each answer checked by plain Pinocchio."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray

from ..problem.reach import shortfall
from ..problem.targets import TargetError
from ..solvers.two_bone import TwoBoneSolver
from .attempts import Settings, is_nearest
from .native.answers import Answers
from .native.codec import targets_of
from .run import AT_REST
from .state import Status, measure_positions

__all__ = ["attempt_at_once", "lands_at_once"]

Array = NDArray[np.float64]

_BLOCK = 8192  # questions worked on at once: their numbers stay in the processor's cache


def lands_at_once(settings: Settings) -> bool:
    """Whether one step of the method is its answer, and it has the time to take another one and find that it rests."""
    solver = settings.solver
    unhurried = settings.max_iterations > 1 and settings.time_limit == math.inf
    return isinstance(solver, TwoBoneSolver) and solver.lands_at_once and unhurried


def attempt_at_once(settings: Settings, goals: Array, starts: Array) -> Answers:
    """What `attempts.attempt_all` would find for goals (N, 1, 18) from starts (N or 1, nq), one after another."""
    began = time.perf_counter()
    count, positions = len(goals), goals[:, 0, :3]
    starts = np.broadcast_to(settings.limits.clip(settings.limits.wrap(starts)), (count, starts.shape[1]))
    q, missed, rests = np.empty(starts.shape), np.empty(count), np.empty(count, dtype=bool)
    for begin in range(0, count, _BLOCK):
        part = slice(begin, begin + _BLOCK)
        q[part], missed[part], rests[part] = _answered(settings, positions[part], starts[part])
    status = np.full(count, Status.CONVERGED, dtype=object)
    outside = np.flatnonzero(missed > settings.tolerance.position)
    status[outside] = [_verdict(settings, goals[k], float(missed[k])) for k in outside]
    iterations = np.where((status == Status.CONVERGED) | rests, 1, 2) * settings.kinematics.free.any()
    none = np.zeros(count, dtype=np.int64)
    seconds = np.full(count, (time.perf_counter() - began) / count)
    return Answers(q, status, missed, np.full(count, math.nan), iterations, none, none.copy(), seconds)


def _answered(settings: Settings, positions: Array, starts: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """(the nearest configurations (N, nq), what they miss (N,) [m], whether they are where the starts were (N,))."""
    solver, kinematics = settings.solver, settings.kinematics
    assert isinstance(solver, TwoBoneSolver)
    q = solver.answers(positions, starts, kinematics, settings.limits)
    reached = measure_positions(kinematics.robot, kinematics.targets[0], q)
    rests = np.abs(q - starts).max(axis=1) < AT_REST
    return q, np.linalg.norm(reached - positions, axis=1), rests


def _verdict(settings: Settings, goal: Array, missed: float) -> Status:
    """Why a target was missed by so much [m]."""
    if is_nearest(settings.solver, settings.kinematics, (TargetError(missed, None),), settings.tolerance):
        return Status.UNREACHABLE
    kinematics = settings.kinematics
    kinematics.retarget(targets_of(kinematics.targets, goal))
    proof = shortfall(kinematics, settings.limits, settings.tolerance.position)
    return Status.STALLED if proof is None else Status.UNREACHABLE
