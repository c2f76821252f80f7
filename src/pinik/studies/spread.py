"""Welman's §4.3: how evenly a method spreads the motion over a chain's joints, with and without stiffness weights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..robot import Robot
from ..solvers.base import Solver
from ..solvers.registry import make_solver
from .accuracy import Problem, asked_of, random_bends
from .chain import TIP, length_of

__all__ = ["FIRMEST", "Spread", "drags", "firmer_towards_the_tip", "spread"]

Array = NDArray[np.float64]

FIRMEST = 0.1
"""The weight of the last joint; the first has 1."""

_MOST_ITERATIONS = 10_000
_DRAG = 0.2  # of the chain's length
_WELL_WITHIN = 0.9


class Spread(NamedTuple):
    """Where a method puts the motion.

    Means are over the problems that were solved; None where there are none.

    Attributes:
        method: The solver's short name.
        stiffness: Joint → w_i; empty where every joint moves freely.
        solved: Share of the problems, from 0 to 1.
        shares: Each joint's mean share of all turns from start to end, base first (n,); they add up to 1.
        moving_joints: Mean of 1 / Σ shares²: n where all turn alike, 1 where one does everything.
        turned: Mean sum of all joints' turns [rad].
    """

    method: str
    stiffness: dict[str, float]
    solved: float
    shares: Array | None
    moving_joints: float | None
    turned: float | None


def firmer_towards_the_tip(chain: Robot) -> dict[str, float]:
    """Weights in equal ratios, from 1 at the base to `FIRMEST` at the tip."""
    return dict(zip(chain.joint_names, np.geomspace(1.0, FIRMEST, len(chain.joint_names)).tolist(), strict=True))


def drags(chain: Robot, count: int, seed: int = 0) -> list[Problem]:
    """Problems like those of a hand that drags: from random bends the tip moves a fifth of the chain's length.

    Args:
        chain: From `planar_chain`.
        count: How many.
        seed: Of them.
    """
    rng = np.random.default_rng([seed, 2])
    length = length_of(chain)
    made: list[Problem] = []
    while len(made) < count:
        start = random_bends(chain, rng)
        angle = rng.uniform(-np.pi, np.pi)
        place = chain.placement(TIP, start).translation + _DRAG * length * np.array([np.cos(angle), np.sin(angle), 0.0])
        if np.linalg.norm(place) <= _WELL_WITHIN * length:
            made.append(Problem("drag", start, place))
    return made


def spread(
    chain: Robot, solver: Solver, asked: Sequence[Problem], stiffness: dict[str, float], engine: str = "auto"
) -> Spread:
    """Solve the problems and see which joints turned.

    Args:
        chain: From `planar_chain`.
        solver: The method.
        asked: The problems.
        stiffness: Joint → w_i.
        engine: As for `pinik.solve`.
    """
    weighted = make_solver(solver, stiffness=stiffness)
    solve = asked_of(chain, weighted, max_iterations=_MOST_ITERATIONS, engine=engine)
    turns = []
    for problem in asked:
        solution = solve(problem.place, problem.start)
        if solution.success:
            turns.append(np.abs(solution.q - problem.start))
    if not turns:
        return Spread(solver.name, stiffness, 0.0, None, None, None)
    each = np.array(turns)
    shares = each / each.sum(axis=1, keepdims=True)
    return Spread(
        solver.name,
        stiffness,
        len(turns) / len(asked),
        shares.mean(axis=0),
        float((1.0 / (shares * shares).sum(axis=1)).mean()),
        float(each.sum(axis=1).mean()),
    )
