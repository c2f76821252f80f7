"""A job: numbered chunks of work, and what their results depend on."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

from .fingerprint import Fingerprint

__all__ = ["Deliver", "Job", "Pause", "Result", "Runner", "Stopped", "Tally", "Work", "never_pause"]


class Stopped(BaseException):
    """The job was interrupted; raised by `pause` inside the work on a chunk, past all that handles errors."""


Pause = Callable[[], None]
"""What work on a chunk calls several times a second; it raises `Stopped` once the job has been interrupted."""


def never_pause() -> None:
    """The `pause` of work that nobody interrupts."""


class Result(NamedTuple):
    """What the work on a chunk came to.

    Attributes:
        content: The chunk's bytes.
        notes: Numbers by name that are added up over all chunks, such as how many rows were solved.
    """

    content: bytes
    notes: Mapping[str, int | float]


Work = Callable[[Any, Pause], Result]
"""Computes a chunk from its payload."""


@dataclass(frozen=True)
class Job:
    """Work in numbered chunks, 0 to `chunks` − 1, whose results depend on the fingerprint and the number alone.

    Attributes:
        fingerprint: What the results depend on, by name.
        chunks: The number of chunks.
        payload: Reads what one chunk needs. It is called in this process, for one chunk at a time and in ascending
            order; what it returns can be pickled.
        work: Computes one chunk from its payload, several at a time in threads, and in other processes; it can be
            pickled. It calls `pause` (`Pause`) several times a second. Equal payloads give equal bytes.
    """

    fingerprint: Fingerprint
    chunks: int
    payload: Callable[[int], Any]
    work: Work


Deliver = Callable[[int, Result], None]
"""Takes the number and the result of a finished chunk, in any thread and in any order."""


class Runner(Protocol):
    """Where chunks are worked on."""

    def run(self, job: Job, numbers: Iterable[int], deliver: Deliver) -> None:
        """Work on these chunks, begun in ascending order, and deliver each result.

        At most a fixed number of chunks is in memory. Returns once all are delivered; raises the first error, or an
        interrupt, after it has stopped all work.
        """


@dataclass
class Tally:
    """How far a job is: chunks, and the sums of their notes. Any thread may add to it.

    Attributes:
        chunks: The number of all chunks.
        finished: How many are finished.
        resumed: How many of these were finished by an earlier run.
        notes: The sums of the notes of the finished chunks.
        earlier: The part of `notes` that comes from the earlier run.
    """

    chunks: int
    finished: int = 0
    resumed: int = 0
    notes: dict[str, int | float] = field(default_factory=dict)
    earlier: dict[str, int | float] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def add(self, notes: Mapping[str, int | float], *, resumed: bool = False) -> None:
        """Count one finished chunk."""
        with self._lock:
            self.finished += 1
            self.resumed += resumed
            for sums in (self.notes, self.earlier) if resumed else (self.notes,):
                for name, number in notes.items():
                    sums[name] = sums.get(name, 0) + number
