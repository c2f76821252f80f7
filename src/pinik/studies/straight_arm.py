"""Welman's figure 4.2: a straight arm whose tip is pulled inwards along its own line."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..problem.targets import Target
from ..robot import Robot
from ..solvers.base import Solver
from ..solving.solution import Solution
from .accuracy import asked_of
from .chain import TIP, length_of

__all__ = ["Pull", "pull_inwards"]

_HALFWAY = 0.5


class Pull(NamedTuple):
    """The results of one method.

    Attributes:
        method: The solver's short name.
        place: The target's distance from the base along the arm, as a part of its length.
        alone: The result of the bare method, started from the straight arm.
        restarted: The result of `pinik.solve` with its defaults, which restarts from other configurations.
    """

    method: str
    place: float
    alone: Solution
    restarted: Solution


def pull_inwards(chain: Robot, solvers: Mapping[str, Solver], engine: str = "auto") -> list[Pull]:
    """Solve for a point halfway along the straight arm, and for one between its last joint and its tip.

    At both points Jᵀe = 0, so the three Jacobian methods do not move. CCD is stuck only at the second point, where
    every joint sees the tip and the target in the same direction.
    """
    length, straight = length_of(chain), chain.neutral()
    last_bone = 1.0 - 0.5 / len(chain.joint_names)
    pulls = []
    for part in (_HALFWAY, last_bone):
        place = np.array([part * length, 0.0, 0.0])
        for method, solver in solvers.items():
            alone = asked_of(chain, solver, engine=engine)(place, straight)
            restarted = chain.solve(
                Target(TIP, place), method=solver, q0=straight, limits=False, engine=engine, polish=False
            )
            pulls.append(Pull(method, part, alone, restarted))
    return pulls
