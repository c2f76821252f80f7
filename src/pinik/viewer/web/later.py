"""Work that another thread does, and what follows it on the server's loop."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import tornado.ioloop

__all__ = ["Later", "later_in_threads"]

Later = Callable[[Callable[[], Any], Callable[[Any], None]], None]
"""later(work, then): do `work` in another thread, then call `then` with its result or with the exception it raised."""


def later_in_threads(loop: tornado.ioloop.IOLoop, workers: ThreadPoolExecutor) -> Later:
    """Return a `Later` that does the work in `workers` and calls `then` on `loop`."""

    def later(work: Callable[[], Any], then: Callable[[Any], None]) -> None:
        def run() -> None:
            result: Any
            try:
                result = work()
            except Exception as error:
                result = error
            loop.add_callback(then, result)

        with contextlib.suppress(RuntimeError):  # the process ends, so nobody waits for what would follow
            workers.submit(run)

    return later
