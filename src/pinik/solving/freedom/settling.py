"""Configurations near a set of solutions, moved onto it, inside the limits, and certified by plain Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..verdict import measure_errors
from .solution_set import EXACT, Place, SolutionSet, worst

__all__ = ["hold_at_limits", "settle", "settle_at_limits"]

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
    if place is not None and _is_certain(solutions, place.q):
        return place.q
    return None if place is None else settle_at_limits(solutions, place.q, across)


def settle_at_limits(solutions: SolutionSet, q: Array, across: Array, entries: Sequence[int] = ()) -> Array | None:
    """Move a configuration onto the set with joints held at limits; None if that is not possible.

    Args:
        solutions: The set.
        q: The configuration (nq,), near it.
        across: The directions (n − r, n) across which it is moved, in as far as the held joints allow.
        entries: The entries of q that go to the nearer limit, besides those that are outside.
    """
    place = hold_at_limits(solutions, q, across, entries)
    return place.q if place is not None and _is_certain(solutions, place.q) else None


def hold_at_limits(solutions: SolutionSet, q: Array, across: Array, entries: Sequence[int] = ()) -> Place | None:
    """The place of the set where `settle_at_limits` leads to; other joints may be outside their limits there."""
    limits = solutions.question.limits
    inside = limits.clip(q)
    for entry in entries:
        lower, upper = limits.lower[entry], limits.upper[entry]
        inside[entry] = lower if abs(q[entry] - lower) < abs(q[entry] - upper) else upper
    held = sorted({*entries, *np.flatnonzero(inside != q).tolist()})
    columns = [column for column, entry in enumerate(limits.entry[solutions.free].tolist()) if entry in held]
    columns = columns[: len(across)]
    # of the directions, those combinations that do not move the held joints
    still = np.linalg.svd(across[:, columns])[0][:, len(columns) :].T @ across
    place = solutions.project(inside, np.vstack((np.eye(solutions.n)[columns], still)))
    if place is None:
        return None
    exact = place.q.copy()
    exact[held] = inside[held]
    return solutions.at(exact)
