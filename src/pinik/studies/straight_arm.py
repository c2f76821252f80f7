"""Welman's fig. 4.2: a straight arm whose tip is pulled inwards along its own line."""

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
    """What a method made of it.

    Attributes:
        method: The solver's short name.
        place: Where the tip should be, as a part of the chain's length, on its line.
        alone: The bare method from the straight arm.
        restarted: `pinik.solve` with its defaults, which begins anew elsewhere where the method is stuck.
    """

    method: str
    place: float
    alone: Solution
    restarted: Solution


def pull_inwards(chain: Robot, solvers: Mapping[str, Solver], engine: str = "auto") -> list[Pull]:
    """Ask for a point halfway along the straight arm, and for one between its last joint and its tip.

    There Jᵀe = 0, so that three of the methods stay; CCD stays at the second point only, as every joint has the
    tip and the target in one direction.
    """
    length, straight = length_of(chain), chain.neutral()
    last_bone = 1.0 - 0.5 / len(chain.joint_names)
    pulls = []
    for part in (_HALFWAY, last_bone):
        place = np.array([part * length, 0.0, 0.0])
        for method, solver in solvers.items():
            alone = asked_of(chain, solver, engine=engine)(place, straight)
            restarted = chain.solve(Target(TIP, place), method=solver, q0=straight, limits=False, engine=engine)
            pulls.append(Pull(method, part, alone, restarted))
    return pulls
