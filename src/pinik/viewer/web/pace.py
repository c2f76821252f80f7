"""The pace of a session: how many steps it takes in a second."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

__all__ = ["Pace"]

_PAUSE = 2.0  # [s] between two steps that do not count as one pace


class Pace:
    """The steps per second over the last sixty steps since the last pause."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._steps: deque[float] = deque(maxlen=61)

    def note_step(self) -> None:
        """Note that a step has been taken now."""
        if self._has_paused():
            self._steps.clear()
        self._steps.append(self._clock())

    def forget(self) -> None:
        """Begin anew."""
        self._steps.clear()

    @property
    def value(self) -> float | None:
        """Steps per second; None while there are none."""
        seconds = self._steps[-1] - self._steps[0] if self._steps else 0.0
        return None if seconds == 0.0 or self._has_paused() else (len(self._steps) - 1) / seconds

    def _has_paused(self) -> bool:
        return len(self._steps) > 0 and self._clock() - self._steps[-1] > _PAUSE
