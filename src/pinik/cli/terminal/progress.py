"""Progress on stderr: a bar in terminals; and how far a job in chunks is, with the time left."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Self

from .output import is_terminal, say

__all__ = ["JobProgress", "progress"]

if TYPE_CHECKING:
    from ...scale.jobs.job import Tally

_SECONDS = (0.2, 10.0)  # between two reports: in a terminal, where one replaces the other, and elsewhere
_CLEAR = "\r\x1b[K"


@contextmanager
def progress(words: str, total: int) -> Iterator[Callable[[], None]]:
    """Show a bar while the block runs; call the function that it yields after each of `total` parts."""
    if not is_terminal(sys.stderr):
        yield lambda: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(words, total=total)
        yield lambda: bar.advance(task)


class JobProgress:
    """Reports how far a job in chunks is, and the time left; of a batch also its rate and the share of solved rows.

    In a terminal one line is written again and again, and in the end removed; elsewhere there is a line now and then.
    """

    def __init__(self, words: str = "") -> None:
        """Begin; `words` come first in each report."""
        self._words = words
        self._in_place = is_terminal(sys.stderr)
        self._began = time.monotonic()
        self._next = self._began + _SECONDS[not self._in_place]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._in_place:
            self._write(_CLEAR)

    def __call__(self, tally: Tally, rows: int | None = None) -> None:
        """Report, unless the last report was a moment ago; `rows` is the number of all rows of a batch."""
        now = time.monotonic()
        if tally.finished == tally.resumed:  # the work begins now
            self._began = now
            self._next = now + _SECONDS[not self._in_place]
        if now < self._next or tally.finished == tally.chunks:
            return
        self._next = now + _SECONDS[not self._in_place]
        words = self._words + report(tally, rows, now - self._began)
        if self._in_place:
            self._write(_CLEAR + words)
        else:
            say(words)

    @staticmethod
    def _write(text: str) -> None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(text)
            sys.stderr.flush()


def report(tally: Tally, rows: int | None, seconds: float) -> str:
    """How far a job is, in words.

    Args:
        tally: What is finished.
        rows: The number of all rows of a batch; None for a job without rows.
        seconds: How long this run has worked [s].
    """
    if rows is None:
        words, parts = f"{tally.finished:,} of {tally.chunks:,} parts", tally.finished - tally.resumed
        if parts and seconds > 0.0:
            words += f", {_duration((tally.chunks - tally.finished) * seconds / parts)} left"
        return words
    done = tally.notes.get("rows", 0)
    words = f"{done:,.0f} of {rows:,} rows"
    if done:
        words += f", {100.0 * tally.notes.get('CONVERGED', 0) / done:.1f} % solved"
    own = done - tally.earlier.get("rows", 0)
    if own and seconds > 0.0:
        words += f", {own / seconds:,.0f} rows/s, {_duration((rows - done) * seconds / own)} left"
    return words


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02d} min"
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"
