"""The metronome: so many beats a second on average, even if other work in the loop comes in between."""

from __future__ import annotations

import time
from collections.abc import Callable

from tornado.ioloop import IOLoop

__all__ = ["Metronome"]

_LONGEST_LAG = 0.5  # [s]; beats that are later than this are left out


class Metronome:
    """Calls `beat` at a steady pace, in the loop of this thread.

    Beats that come late are made up for: at once, as long as that takes no more than a period or what the other work
    since the last beat has taken, and then as soon as the loop has done what else there is. So beats get half of the
    time if they need it, and beats that are slow themselves do not hold up other work.
    """

    def __init__(
        self, beat: Callable[[], None], per_second: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Be ready; `start` starts it.

        Args:
            beat: What to do.
            per_second: How often.
            clock: A function that returns the time in seconds.
        """
        self._beat, self._period, self._clock = beat, 1.0 / per_second, clock
        self._due = self._ended = 0.0
        self._next: object | None = None

    @property
    def runs(self) -> bool:
        """Whether it has been started and not stopped since."""
        return self._next is not None

    def start(self) -> None:
        """Beat from now on; the first beat is due in one period."""
        self.stop()
        self._ended = self._clock()
        self._due = self._ended + self._period
        self._wait()

    def stop(self) -> None:
        """Beat no more."""
        if self._next is not None:
            IOLoop.current().remove_timeout(self._next)
            self._next = None

    def _wait(self) -> None:
        """Arm the timer of the next beat, in place of one that is pending, as after a beat that restarts this."""
        self.stop()
        self._next = IOLoop.current().call_later(max(0.0, self._due - self._clock()), self._beat_all)

    def _beat_all(self) -> None:
        """Beat once, and make up for beats that are missing."""
        began = self._clock()
        self._due = max(self._due, began - _LONGEST_LAG)
        until = began + max(self._period, began - self._ended)
        try:
            while True:
                self._due += self._period
                self._beat()
                if not (self.runs and self._due <= self._clock() < until):
                    break
        finally:  # whatever a beat raises, the loop reports it, and the next one comes
            self._ended = self._clock()
            if self.runs:
                self._wait()
