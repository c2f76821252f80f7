"""Ctrl-C and SIGTERM while the `pinik` command loads its modules end it with one word and the status 130 or 143.

Most of a short command's time goes into loading modules, and an interrupt meanwhile would show a traceback. So `pinik`
imports this module first, and this module imports only what Python has in memory when it starts. In a process that only
uses pinik as a library, the import changes nothing.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # `signal` itself takes long to load, as it makes enumerations
import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import NoReturn

__all__ = ["end_at_once"]


def end_at_once(number: int, frame: FrameType | None) -> NoReturn:
    """End the process before the command has begun, or after it has answered: nothing is left to clean up."""
    try:
        os.write(2, b"interrupted\n" if number == _signal.SIGINT else b"terminated\n")
    finally:
        os._exit(128 + number)


def _is_the_command() -> bool:
    """Whether this process is `python -m pinik` or the `pinik` script, which loads its modules now."""
    name = os.path.basename(sys.argv[0]) if getattr(sys, "argv", None) else ""
    if name != "-m":  # which is the name while Python looks for the module of -m
        return name == "pinik"
    return "-mpinik" in sys.orig_argv or ("-m", "pinik") in zip(sys.orig_argv, sys.orig_argv[1:], strict=False)


def _install() -> None:
    for number, default in ((_signal.SIGINT, _signal.default_int_handler), (_signal.SIGTERM, _signal.SIG_DFL)):
        if _signal.getsignal(number) == default:
            try:
                _signal.signal(number, end_at_once)
            except ValueError:  # this is not the main thread
                return


if _is_the_command():
    _install()
