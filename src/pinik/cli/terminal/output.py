"""Data on stdout, messages on stderr; colours only in a terminal, and not with NO_COLOR."""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import sys
from collections.abc import Mapping
from typing import Any, TextIO

from ...echoes import one_line
from .exits import CommandError, ExitStatus

__all__ = [
    "abandon",
    "emit",
    "emit_json",
    "emit_words",
    "finish",
    "is_terminal",
    "painted",
    "prepare_streams",
    "reason_of",
    "say",
    "say_error",
    "stop_writing",
    "warn",
]


_COLORS = {"red": 31, "green": 32, "yellow": 33}
_STREAMS = (("stdin", 0, "r", os.O_WRONLY), ("stdout", 1, "w", os.O_RDONLY), ("stderr", 2, "w", os.O_RDONLY))


def prepare_streams() -> None:
    """Escape characters that a stream's encoding lacks, and replace each closed stream by one whose use is an OSError.

    The latter also takes the descriptor, or the next file to be opened would get whatever libraries print.
    """
    for name, number, mode, wrong_way in _STREAMS:
        if getattr(sys, name) is None:
            descriptor = os.open(os.devnull, wrong_way)
            stream = open(descriptor, mode, encoding="utf-8", closefd=descriptor != number)  # noqa: SIM115 - it stays open
            setattr(sys, name, stream)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


def emit(text: str) -> None:
    """Write data to stdout at once; if the reader has gone (`| head`), drop it silently.

    Raises:
        CommandError: The data cannot be written for another reason.
    """
    try:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except OSError as error:
        stop_writing(error)


def finish() -> None:
    """Flush stdout, to which the help writes directly.

    Raises:
        CommandError: It cannot be written; a reader that has gone is not an error.
    """
    try:
        sys.stdout.flush()
    except OSError as error:
        stop_writing(error)


def stop_writing(error: OSError) -> None:
    """Give up stdout after an error; if only its reader has gone, the command goes on silently.

    Raises:
        CommandError: The answer is lost for another reason.
    """
    abandon(sys.stdout)
    if not isinstance(error, BrokenPipeError):
        raise CommandError(f"cannot write the answer: {reason_of(error)}")


def reason_of(error: OSError) -> str:
    """Why a file or a stream cannot be read or written."""
    return "the stream is closed" if error.errno == errno.EBADF else error.strerror or str(error)


def abandon(stream: TextIO) -> None:
    """Discard what a stream still buffers, so that the interpreter's final flush does not fail."""
    with contextlib.suppress(OSError, ValueError, AttributeError):  # a stand-in without a descriptor has nothing left
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def emit_words(text: str, color: str | None = None) -> None:
    """Write a sentence to stdout that may echo long or odd names from a file, on one line."""
    words = one_line(text)
    emit(words if color is None else painted(words, color))


def emit_json(value: Mapping[str, Any]) -> None:
    """Write one JSON object on one line; NaN and infinities become null."""
    plain_encoding = (getattr(sys.stdout, "encoding", None) or "").lower().replace("-", "") != "utf8"
    emit(json.dumps(_finite(value), allow_nan=False, ensure_ascii=plain_encoding))


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None  # and -0.0 becomes 0.0
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value


def say(words: str, title: str = "") -> None:
    """Print a line to stderr. If nobody can read it there, it is lost, and the command goes on all the same."""
    try:
        print(title + one_line(words), file=sys.stderr, flush=True)
    except (OSError, ValueError):
        abandon(sys.stderr)


def warn(words: str) -> None:
    """Print a warning to stderr."""
    say(words, painted("warning:", "yellow", sys.stderr) + " ")


def say_error(words: str, status: ExitStatus) -> ExitStatus:
    """Print an error to stderr and return the exit status."""
    say(words, painted("error:", "red", sys.stderr) + " ")
    return status


def painted(text: str, color: str, stream: TextIO | None = None) -> str:
    """`text` in red, green or yellow if `stream` (default: stdout) is a terminal and NO_COLOR is not set."""
    wanted = not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return f"\x1b[{_COLORS[color]}m\x1b[1m{text}\x1b[0m" if wanted and is_terminal(stream or sys.stdout) else text


def is_terminal(stream: TextIO | None) -> bool:
    """Whether the stream is a terminal."""
    return stream is not None and stream.isatty()
