"""Statistics of an instance over its steps: the last thousand, or all since they began anew."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import NamedTuple

from ...motion.figures import StepFigures

__all__ = ["WINDOW", "WINDOWS", "Statistics", "Summary"]

WINDOW = 1000
"""The number of steps that the statistics cover, as in the thesis, if they do not cover all."""
WINDOWS = {"last": f"the last {WINDOW} steps", "all": "all steps"}
"""What the statistics cover: name → words."""


class Summary(NamedTuple):
    """The figures of the covered steps; None if there are no steps.

    Attributes:
        steps: The number of steps covered.
        mean_time: Processor time of the solver per step [s].
        mean_iterations, mean_joint_updates: Iterations and joint updates per step.
        efficiency: The share of steps that ended with every target reached, from 0 to 1.
        mean_error: Position error at the end of a step [m].
        largest_jump: The largest change of one joint in one step [rad or m].
        busy: The number of steps in which the method had something to do.
        cut_off: The number of steps that the clock ended, and not the method.
    """

    steps: int
    mean_time: float | None
    mean_iterations: float | None
    mean_joint_updates: float | None
    efficiency: float | None
    mean_error: float | None
    largest_jump: float | None
    busy: int
    cut_off: int


class Statistics:
    """The steps of one instance: the last `WINDOW` of them one by one, and all of them together."""

    def __init__(self) -> None:
        self._last: deque[StepFigures] = deque(maxlen=WINDOW)
        self._all = _Totals()

    def add(self, figures: StepFigures) -> None:
        """Add a step."""
        self._last.append(figures)
        self._all.add(figures)

    def newest(self, count: int) -> Sequence[StepFigures]:
        """The newest `count` steps, the newest one first, or as many as there are."""
        return list(islice(reversed(self._last), count))

    def summary(self, window: str = "last") -> Summary:
        """Return the figures of a window, one of `WINDOWS`."""
        return (self._all if window == "all" else _Totals(self._last)).summary()


class _Totals:
    """Sums over steps."""

    def __init__(self, steps: Iterable[StepFigures] = ()) -> None:
        self._steps = self._reached = self._busy = self._cut_off = self._measured = 0
        self._time = self._iterations = self._joint_updates = self._error = self._jump = 0.0
        for figures in steps:
            self.add(figures)

    def add(self, figures: StepFigures) -> None:
        self._steps += 1
        self._time += figures.time
        self._iterations += figures.iterations
        self._joint_updates += figures.joint_updates
        self._reached += figures.reached
        self._busy += not figures.idle
        self._cut_off += figures.cut_off
        self._jump = max(self._jump, figures.jump)
        if figures.error is not None:
            self._measured += 1
            self._error += figures.error

    def summary(self) -> Summary:
        count = self._steps
        if not count:
            return Summary(0, None, None, None, None, None, None, 0, 0)
        return Summary(
            steps=count,
            mean_time=self._time / count,
            mean_iterations=self._iterations / count,
            mean_joint_updates=self._joint_updates / count,
            efficiency=self._reached / count,
            mean_error=self._error / self._measured if self._measured else None,
            largest_jump=self._jump,
            busy=self._busy,
            cut_off=self._cut_off,
        )
