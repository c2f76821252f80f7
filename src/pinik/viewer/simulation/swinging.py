"""Robots that swing to and fro in front of a target that they miss, and why."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...motion.figures import StepFigures
from ...solvers.base import Solver
from ...solvers.pseudo_inverse import PseudoInverse

__all__ = ["LOOKED_AT", "swinging"]

LOOKED_AT = 30
"""The number of newest steps that `swinging` judges: half a second."""
_LARGE = 0.1  # [rad or m] in a sixtieth of a second, which no target that moves smoothly asks for
_OFTEN = 0.25  # the share of such steps; a swing of two poses may end one step where the step before ended

_WHY = (
    "where a robot is almost singular, as at its full stretch, the pseudo-inverse takes steps that are too long; "
    "damped least squares (dls) takes shorter ones"
)


def swinging(solver: Solver, steps: Sequence[StepFigures]) -> str:
    """Say in one sentence that a robot swings, or nothing.

    Args:
        solver: The robot's method.
        steps: The newest steps, at least `LOOKED_AT` of them if there are so many.
    """
    judged = steps[:LOOKED_AT]
    large = [step.jump for step in judged if step.jump > _LARGE]
    if len(judged) < LOOKED_AT or any(step.reached for step in judged) or len(large) < _OFTEN * LOOKED_AT:
        return ""
    low, high = (f"{math.degrees(jump):.0f}°" for jump in (min(large), max(large)))
    swing = f"it swings by {low if low == high else f'{low} to {high}'} in one step and does not come to rest"
    return f"{swing}: {_WHY}" if isinstance(solver, PseudoInverse) else swing
