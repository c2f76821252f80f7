"""Ctrl-C and SIGTERM in the `pinik` command, which end it with one word and the status 130 or 143, at any moment.

`pinik` imports this module first, because most of a short command's time goes into loading modules, and an interrupt
meanwhile would show a traceback. In a process that only uses pinik as a library, the import changes nothing.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from types import FrameType
from typing import Any, NoReturn

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
        before = {n: h for n in raising if (h := signal.getsignal(n)) in (signal.SIG_DFL, _end_at_once)}
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
        _end_at_once(signal.SIGINT, None)
    if issubclass(dropped, Terminated):
        _end_at_once(signal.SIGTERM, None)


def _end_at_once(number: int, frame: FrameType | None) -> NoReturn:
    """End the process before the command has begun, or after it has answered: nothing is left to clean up."""
    with suppress(OSError):
        os.write(2, b"interrupted\n" if number == signal.SIGINT else b"terminated\n")
    os._exit(128 + number)


def _is_the_command() -> bool:
    """Whether this process is `python -m pinik` or the `pinik` script, which loads its modules now."""
    name = os.path.basename(sys.argv[0]) if getattr(sys, "argv", None) else ""
    if name != "-m":  # which is the name while Python looks for the module of -m
        return name == "pinik"
    return "-mpinik" in sys.orig_argv or ("-m", "pinik") in pairwise(sys.orig_argv)


if _is_the_command() and threading.current_thread() is threading.main_thread():
    for _number, _default in ((signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)):
        if signal.getsignal(_number) is _default:
            signal.signal(_number, _end_at_once)
