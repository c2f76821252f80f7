"""The figures of one step in which a method chases a target."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["StepFigures"]


class StepFigures(NamedTuple):
    """The figures of one step of one method.

    Attributes:
        time: Computing time of the solver [s]; in the live view, processor time.
        iterations: The number of iterations; sweeps for CCD.
        joint_updates: The number of single-joint updates, for CCD.
        reached: Whether every target was within tolerance at the end.
        error: The largest position error at the end [m]; None if no target has a position.
        jump: The largest change of any joint [rad or m].
        idle: Whether there was nothing to do: every target was reached already, and none had moved.
        cut_off: Whether the clock ended the step, and not the method.
    """

    time: float
    iterations: int
    joint_updates: int
    reached: bool
    error: float | None
    jump: float
    idle: bool = False
    cut_off: bool = False
