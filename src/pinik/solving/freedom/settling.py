"""Configurations near a set of solutions, moved onto it, inside the limits, and certified by plain Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..verdict import measure_errors
from .solution_set import EXACT, SolutionSet, worst

__all__ = ["settle", "settle_at_limits"]

Array = NDArray[np.float64]


def _is_certain(solutions: SolutionSet, q: Array) -> bool:
    """Whether a configuration reaches the targets to 1e-8 m and rad by plain Pinocchio, inside the limits."""
    question = solutions.question
    if not question.limits.contains(q):
        return False
    return worst(measure_errors(question.robot, question.problem.targets, q, question.options.tolerance)) <= EXACT


def settle(solutions: SolutionSet, q: Array, across: Array) -> list[Array]:
    """Move configurations onto the set; those that cannot be are left out.

    Args:
        solutions: The set.
        q: The configurations (N, nq), near it.
        across: The directions (N, n − r, n) across which each of them is moved.
    """
    settled = []
    for near, directions in zip(_stepped(solutions, q, across), across, strict=True):
        found = near if _is_certain(solutions, near) else _carefully(solutions, near, directions)
        if found is not None:
            settled.append(found)
    return settled


def _stepped(solutions: SolutionSet, q: Array, across: Array) -> list[Array]:
    """The configurations after one Newton step, all steps computed at once."""
    places = [solutions.at(one) for one in q]
    if not places:
        return []
    matrices = np.concatenate((np.array([place.J for place in places]), across), axis=1)
    residuals = np.zeros((len(places), solutions.n, 1))
    residuals[:, : solutions.rank, 0] = [place.e for place in places]
    try:
        steps = np.linalg.solve(matrices, residuals)[:, :, 0]
    except np.linalg.LinAlgError:  # one of them is singular
        return [*q]
    return [solutions.step(one, step) for one, step in zip(q, steps, strict=True)]


def _carefully(solutions: SolutionSet, q: Array, across: Array) -> Array | None:
    place = solutions.project(q, across)
    if place is None:
        return None
    return place.q if _is_certain(solutions, place.q) else settle_at_limits(solutions, place.q)


def settle_at_limits(solutions: SolutionSet, q: Array, entries: Sequence[int] = ()) -> Array | None:
    """Move a configuration onto the set with joints held at limits; None if that is not possible.

    Args:
        solutions: The set.
        q: The configuration (nq,), near it.
        entries: The entries of q that go to the nearer limit, besides those that are outside.
    """
    limits = solutions.question.limits
    inside = limits.clip(q)
    for entry in entries:
        lower, upper = limits.lower[entry], limits.upper[entry]
        inside[entry] = lower if abs(q[entry] - lower) < abs(q[entry] - upper) else upper
    held = {*entries, *np.flatnonzero(inside != q).tolist()}
    columns = [column for column, entry in enumerate(limits.entry[solutions.free].tolist()) if entry in held]
    across = np.eye(solutions.n)[columns[: solutions.n - solutions.rank]]
    if len(across) < solutions.n - solutions.rank:
        return None
    place = solutions.project(inside, across)
    if place is None:
        return None
    exact = place.q.copy()
    exact[[*held]] = inside[[*held]]
    return exact if _is_certain(solutions, exact) else None
