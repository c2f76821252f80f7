"""Statistics of an instance over its last thousand steps."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from ...motion.figures import StepFigures

__all__ = ["WINDOW", "Statistics", "StepFigures", "Summary"]

WINDOW = 1000
"""The number of steps that the statistics cover, as in the thesis."""


class Summary(NamedTuple):
    """Means over the window; None if there are no steps.

    Attributes:
        steps: The number of steps covered.
        mean_time: Solver time per step [s].
        mean_iterations, mean_joint_updates: Iterations and joint updates per step.
        efficiency: The share of steps that ended with every target reached, from 0 to 1.
        mean_error: Position error at the end of a step [m].
        largest_jump: The largest change of one joint in one step [rad or m].
    """

    steps: int
    mean_time: float | None
    mean_iterations: float | None
    mean_joint_updates: float | None
    efficiency: float | None
    mean_error: float | None
    largest_jump: float | None


class Statistics:
    """The last `WINDOW` steps of one instance."""

    def __init__(self) -> None:
        self._steps: deque[StepFigures] = deque(maxlen=WINDOW)

    def add(self, figures: StepFigures) -> None:
        """Add a step; the oldest one drops out if the window is full."""
        self._steps.append(figures)

    def clear(self) -> None:
        """Discard all steps."""
        self._steps.clear()

    def summary(self) -> Summary:
        """Return the current means."""
        steps = self._steps
        if not steps:
            return Summary(0, None, None, None, None, None, None)

        def mean(of: Callable[[StepFigures], float]) -> float:
            return sum(map(of, steps)) / len(steps)

        errors = [step.error for step in steps if step.error is not None]
        return Summary(
            steps=len(steps),
            mean_time=mean(lambda step: step.time),
            mean_iterations=mean(lambda step: step.iterations),
            mean_joint_updates=mean(lambda step: step.joint_updates),
            efficiency=mean(lambda step: step.reached),
            mean_error=sum(errors) / len(errors) if errors else None,
            largest_jump=max(step.jump for step in steps),
        )
