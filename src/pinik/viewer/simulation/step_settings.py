"""How the steps of instances go: limits, tolerance and iterations."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...problem.tolerance import Tolerance

__all__ = ["StepSettings"]


@dataclass(frozen=True)
class StepSettings:
    """How a step goes, the same for all instances of a session.

    Attributes:
        limits: Whether the joint limits are enforced.
        tolerance: The errors that count as reached.
        until_reached: Whether a step runs until the targets are reached or the method gives up.
        at_most: The maximum number of iterations per step if `until_reached` is False.
        polish: Whether methods that converge quadratically go on within the tolerance; off, so that the methods are
            compared by their iterations until the tolerance.
    """

    limits: bool = True
    tolerance: Tolerance = field(default_factory=Tolerance)
    until_reached: bool = True
    at_most: int = 20
    polish: bool = False
