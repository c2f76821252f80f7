"""Readers that say nothing in this thread, while other threads hear all that they log."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

__all__ = ["quiet"]


class _Hush(logging.Filter):
    """Drops what is logged in threads that ask for it."""

    def __init__(self) -> None:
        super().__init__()
        self.here = threading.local()

    def filter(self, record: logging.LogRecord) -> bool:
        return getattr(self.here, "depth", 0) == 0


_HUSH = _Hush()


@contextmanager
def quiet(logger: logging.Logger) -> Iterator[None]:
    """Suppress what a reader logs, and what NumPy warns about in it; what matters becomes an error.

    Python's filters of warnings stay as they are: they belong to all threads, and two threads that change them for a
    while may leave the wrong ones behind.
    """
    logger.addFilter(_HUSH)
    _HUSH.here.depth = getattr(_HUSH.here, "depth", 0) + 1
    try:
        with np.errstate(all="ignore"):
            yield
    finally:
        _HUSH.here.depth -= 1
