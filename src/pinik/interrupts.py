"""Ctrl-C and SIGTERM in a block of the `pinik` command are exceptions, so that the command cleans up."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn

from .early_signals import end_at_once

__all__ = ["Terminated", "as_exceptions"]

_Handler = Callable[[int, FrameType | None], Any] | int | None


class Terminated(BaseException):
    """SIGTERM asked the command to end."""


@contextmanager
def as_exceptions() -> Iterator[None]:
    """Let Ctrl-C raise KeyboardInterrupt and SIGTERM raise `Terminated` in this block, so that the command cleans up.

    Signals that somebody else handles or ignores are left alone, as are all outside the main thread.
    """
    before: dict[signal.Signals, _Handler] = {}
    hook = sys.unraisablehook

    def unraisable(lost: sys.UnraisableHookArgs) -> None:
        _end_if_interrupted(lost.exc_type)
        hook(lost)

    sys.unraisablehook = unraisable
    if threading.current_thread() is threading.main_thread():
        raising: dict[signal.Signals, _Handler] = {
            signal.SIGINT: signal.default_int_handler,
            signal.SIGTERM: _raise_terminated,
        }
        before = {n: h for n in raising if (h := signal.getsignal(n)) in (signal.SIG_DFL, end_at_once)}
        for number in before:
            signal.signal(number, raising[number])
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _raise_terminated(number: int, frame: FrameType | None) -> NoReturn:
    raise Terminated


def _end_if_interrupted(dropped: type[BaseException]) -> None:
    """End the command if an interrupt came where Python drops exceptions, such as in a finalizer."""
    if issubclass(dropped, KeyboardInterrupt):
        end_at_once(signal.SIGINT, None)
    if issubclass(dropped, Terminated):
        end_at_once(signal.SIGTERM, None)
