"""What a method did in one step of a chase."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["StepFigures"]


class StepFigures(NamedTuple):
    """One step of one method.

    Attributes:
        time: Seconds that the solver took.
        iterations: Iterations taken; sweeps for CCD.
        joint_updates: Single joints updated, for CCD.
        reached: Whether every target was within tolerance at the end.
        error: The largest position error at the end [m]; None if no target asked for a position.
        jump: The largest change of one joint [rad or m].
    """

    time: float
    iterations: int
    joint_updates: int
    reached: bool
    error: float | None
    jump: float
