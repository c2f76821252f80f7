"""Chunks in threads of this process: while one is read or written, others are worked on."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ...solving.processors import processors
from .job import Deliver, Job, Stopped

__all__ = ["Threads"]

_AHEAD = 64  # so many chunks may be finished before an earlier one is
_MOMENT = 0.1  # [s] how soon a thread that waits for an earlier chunk notices that the job was stopped


@dataclass(frozen=True)
class Threads:
    """Works on one chunk in each thread. Chunks whose work leaves Python, as the compiled engine does, run in parallel.

    Attributes:
        count: The number of threads; one for each processor available to this process by default.
    """

    count: int = field(default_factory=processors)

    def run(self, job: Job, numbers: Iterable[int], deliver: Deliver) -> None:
        """As `Runner.run`. Ctrl-C waits for the next `pause` of each thread."""
        from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait  # slow to import, with logging

        queue = _Queue(job, numbers, _AHEAD + self.count)
        with ThreadPoolExecutor(self.count, "pinik-job") as pool:
            try:
                labours = [pool.submit(queue.labour, deliver) for _ in range(self.count)]
                wait(labours, return_when=FIRST_EXCEPTION)
            finally:
                queue.stop.set()
        errors = [error for own in labours if (error := own.exception()) is not None]
        for error in sorted(errors, key=lambda error: isinstance(error, Stopped)):
            raise error


class _Queue:
    """The chunks that no thread has begun yet, and the places in the order of those that are under way."""

    def __init__(self, job: Job, numbers: Iterable[int], ahead: int) -> None:
        self.stop = threading.Event()
        self._job = job
        self._waiting = enumerate(numbers)
        self._ahead = ahead
        self._under_way: set[int] = set()
        self._begun = 0
        self._changed = threading.Condition()

    def labour(self, deliver: Deliver) -> None:
        """Work on one chunk after the other."""
        while (taken := self._take()) is not None:
            place, number, payload = taken
            deliver(number, self._job.work(payload, self._pause))
            with self._changed:
                self._under_way.discard(place)
                self._changed.notify_all()

    def _take(self) -> tuple[int, int, Any] | None:
        """The next chunk: its place in the order, its number and its payload; None if there is none any more."""
        with self._changed:
            while self._under_way and self._begun - min(self._under_way) >= self._ahead and not self.stop.is_set():
                self._changed.wait(_MOMENT)
            place, number = (None, None) if self.stop.is_set() else next(self._waiting, (None, None))
            if place is None or number is None:
                return None
            self._under_way.add(place)
            self._begun = place + 1
            return place, number, self._job.payload(number)

    def _pause(self) -> None:
        if self.stop.is_set():
            raise Stopped
