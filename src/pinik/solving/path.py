"""A path in the Python engine, point by point, and the options with which methods keep to their branch."""

from __future__ import annotations

import dataclasses
import time

import numpy as np
from numpy.typing import NDArray

from ..problem.tolerance import largest_of
from ..solvers.ccd import CCD
from .attempts import Outcomes
from .native.codec import targets_of
from .options import Options
from .prepared import Prepared
from .state import Status
from .verdict import judge, measure_errors
from .walk import Walk

__all__ = ["careful", "follow_path"]

Array = NDArray[np.float64]

CAREFUL_STEP = 0.05
"""The largest change of a joint in one update of CCD along a path [rad or m]; larger ones lead to other branches."""


def careful(options: Options) -> Options:
    """The options with a CCD that moves no joint far in one update."""
    solver = options.method
    if not isinstance(solver, CCD) or solver.max_step <= CAREFUL_STEP:
        return options
    return dataclasses.replace(options, method=dataclasses.replace(solver, max_step=CAREFUL_STEP))


def follow_path(prepared: Prepared, goals: Array, start: Array, on_miss: str) -> Outcomes:
    """Follow a path of goals (N, n, 18) from a start (nq,); fewer than N outcomes if it stops at a miss.

    Args:
        prepared: The compiled problem.
        goals: The numbers of the targets.
        start: The start, which is moved inside the limits.
        on_miss: "hold", "nearest" or "stop", as for `pinik.track`.
    """
    question, robot = prepared.question, prepared.robot
    walk, limits = Walk(question), question.limits
    q = limits.wrap(start)
    rows, kept = [], []
    for number, goal in enumerate(goals):
        began = time.perf_counter()
        targets = targets_of(question.problem.targets, goal)
        stride = walk(targets, q, number)
        verdict = judge(question, targets, stride.q, stride.ended)
        reached = verdict.status is Status.CONVERGED
        if reached or on_miss == "nearest":
            q, errors = stride.q.copy(), verdict.errors
        else:
            errors = measure_errors(robot, targets, q, prepared.options.tolerance)
        kept.append(q)
        rows.append(
            (verdict.status, *largest_of(errors), stride.iterations, stride.restarts, time.perf_counter() - began)
        )
        if on_miss == "stop" and not reached:
            break
    status, position, orientation, iterations, restarts, seconds = zip(*rows, strict=True)
    counts = np.array(iterations, dtype=np.int64)
    return Outcomes(
        np.array(kept), np.array(status, dtype=object), np.array(position, dtype=np.float64),
        np.array(orientation, dtype=np.float64), counts, np.zeros_like(counts), np.array(restarts, dtype=np.int64),
        np.ones_like(counts), np.array(seconds),
    )  # fmt: skip
