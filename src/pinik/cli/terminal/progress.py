"""A bar on stderr that fills up, for those who look at a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from .output import is_terminal

__all__ = ["progress"]


@contextmanager
def progress(words: str, total: int) -> Iterator[Callable[[], None]]:
    """A function to call after each of `total` parts; the bar is there as long as the block, and on terminals only."""
    if not is_terminal(sys.stderr):
        yield lambda: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(words, total=total)
        yield lambda: bar.advance(task)
