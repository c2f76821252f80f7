"""The place from which a set of solutions is explored: the one nearest to a configuration that a user gives."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...model.limits import Limits
from ...problem.tolerance import largest_of
from ..verdict import all_within, measure_errors
from .solution_set import Place, SolutionSet

__all__ = ["beginning"]

Array = NDArray[np.float64]


def beginning(solutions: SolutionSet, given: Array) -> Place:
    """The place of the set nearest to a configuration inside the limits that reaches the targets within tolerance.

    Raises:
        InputError: It misses a target.
    """
    question = solutions.question
    robot, targets = question.robot, question.problem.targets
    q = question.limits.wrap(given)
    errors = measure_errors(robot, targets, q, question.options.tolerance)
    place = solutions.slide(q) if all_within(errors, question) else None
    if place is None:
        position, orientation = largest_of(errors)
        missed = [f"{position:.3g} m" if position else "", f"{orientation:.3g} rad" if orientation else ""]
        outside = _outside(question.limits, given, q)
        advice = (
            f"{outside}, and limits=False leaves the limits aside" if outside else "pinik.solve finds one that does"
        )
        raise InputError(
            "must reach the targets inside the limits; there, it misses them by "
            f"{' and '.join(filter(None, missed))}; {advice}",
            argument="q",
        )
    return place


def _outside(limits: Limits, given: Array, inside: Array) -> str:
    """The joints that are outside their limits at a configuration (nq,), which was moved inside them, in words."""
    words = []
    for joint in limits.robot.joints:
        entry = joint.idx_q
        if joint.leader is not None or joint.nq != 1:
            continue
        moved = given[entry] - inside[entry]
        turned = limits.turning[entry] and math.isclose(math.remainder(moved, math.tau), 0.0, abs_tol=1e-9)
        if moved and not turned:
            side, limit = ("lower", limits.lower) if inside[entry] == limits.lower[entry] else ("upper", limits.upper)
            unit = "m" if joint.kind == "prismatic" else "rad"
            words.append(f"{joint.name} at {given[entry]:.4g} is beyond its {side} limit of {limit[entry]:.4g} {unit}")
    return " and ".join(words)
