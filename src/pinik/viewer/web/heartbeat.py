"""The heartbeat: sixty ticks a second while there is something to show or somebody asks, and none otherwise."""

from __future__ import annotations

import time
from collections.abc import Callable

from ..simulation.session import STEPS_PER_SECOND
from .metronome import Metronome

__all__ = ["Heartbeat"]

_AWAKE = 10.0  # [s] after there has last been anything to show, or a request


class Heartbeat:
    """Calls `tick` sixty times a second.

    It rests when there has been nothing to show for ten seconds, and nobody has asked for anything.
    """

    def __init__(
        self,
        tick: Callable[[], None],
        lively: Callable[[], bool],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Start beating, in the loop of this thread.

        Args:
            tick: What to do sixty times a second.
            lively: Returns whether there is something to show to somebody.
            clock: A function that returns the time in seconds.
        """
        self._tick, self._lively, self._clock = tick, lively, clock
        self._metronome = Metronome(self._beat, STEPS_PER_SECOND)
        self.wake()

    @property
    def rests(self) -> bool:
        """Whether there has been nothing to do lately."""
        return not self._metronome.runs

    def wake(self) -> None:
        """Note that somebody asks for something, and beat on."""
        self._used = self._clock()
        if self.rests:
            self._metronome.start()

    def stop(self) -> None:
        """Beat no more."""
        self._metronome.stop()

    def _beat(self) -> None:
        if self._lively():
            self._used = self._clock()
        elif self._clock() - self._used > _AWAKE:
            self._metronome.stop()
            return
        self._tick()
