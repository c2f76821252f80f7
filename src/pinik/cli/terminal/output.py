"""Data on stdout, messages on stderr; colours only in a terminal, and not with NO_COLOR."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from typing import Any, TextIO

import typer

from .exits import CommandError, ExitStatus

__all__ = [
    "abandon_stdout",
    "emit",
    "emit_json",
    "finish",
    "is_terminal",
    "painted",
    "prepare_streams",
    "say",
    "say_error",
    "warn",
]


def prepare_streams() -> None:
    """Escape characters that a stream's encoding lacks, instead of failing."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


def emit(text: str) -> None:
    """Write data to stdout at once; if the reader has gone (`| head`), drop it silently.

    Raises:
        CommandError: The data cannot be written for another reason.
    """
    if sys.stdout is None:
        return
    try:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        abandon_stdout()
    except OSError as error:
        abandon_stdout()
        raise CommandError(f"cannot write the answer: {error.strerror}") from None


def finish() -> None:
    """Flush stdout, to which the help writes directly; a reader that has gone is not an error."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        abandon_stdout()


def abandon_stdout() -> None:
    """Discard what is still buffered, so that the interpreter's final flush does not fail."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


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


def say(words: str) -> None:
    """Print a line to stderr."""
    if sys.stderr is not None:
        print(words, file=sys.stderr, flush=True)


def warn(words: str) -> None:
    """Print a warning to stderr."""
    say(f"{painted('warning:', 'yellow', sys.stderr)} {words}")


def say_error(words: str, status: ExitStatus) -> ExitStatus:
    """Print an error to stderr and return the exit status."""
    say(f"{painted('error:', 'red', sys.stderr)} {words}")
    return status


def painted(text: str, color: str, stream: TextIO | None = None) -> str:
    """`text` in a colour if `stream` (default: stdout) is a terminal and NO_COLOR is not set."""
    stream = stream or sys.stdout
    wanted = not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return typer.style(text, fg=color, bold=True) if wanted and is_terminal(stream) else text


def is_terminal(stream: TextIO | None) -> bool:
    """Whether the stream is a terminal."""
    return stream is not None and stream.isatty()
