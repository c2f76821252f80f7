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
"""The weight of the last joint; the first joint has 1."""

_MOST_ITERATIONS = 10_000
_DRAG = 0.2  # of the chain's length
_WELL_WITHIN = 0.9


class Spread(NamedTuple):
    """How a method spreads the motion over the joints.

    Means are over the solved problems; None if there are none.

    Attributes:
        method: The solver's short name.
        stiffness: Joint → w_i; empty without weights.
        solved: The share of solved problems, from 0 to 1.
        shares: Each joint's mean share of the total rotation, base first (n,); the sum is 1.
        moving_joints: Mean of 1 / Σ shares²: n if all joints turn equally, 1 if a single joint turns.
        turned: Mean total rotation of all joints [rad].
    """

    method: str
    stiffness: dict[str, float]
    solved: float
    shares: Array | None
    moving_joints: float | None
    turned: float | None


def firmer_towards_the_tip(chain: Robot) -> dict[str, float]:
    """Weights that fall geometrically from 1 at the base to `FIRMEST` at the tip."""
    return dict(zip(chain.joint_names, np.geomspace(1.0, FIRMEST, len(chain.joint_names)).tolist(), strict=True))


def drags(chain: Robot, count: int, seed: int = 0) -> list[Problem]:
    """Problems as in dragging by hand: from random bends, the tip moves by a fifth of the chain's length.

    Args:
        chain: From `planar_chain`.
        count: Number of problems.
        seed: The seed of the random problems.
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
    """Solve the problems and measure how far each joint turned.

    Args:
        chain: From `planar_chain`.
        solver: The method.
        asked: The problems.
        stiffness: Joint → w_i.
        engine: As for `pinik.solve`.
    """
    weighted = make_solver(solver, stiffness=stiffness) if stiffness else solver
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
