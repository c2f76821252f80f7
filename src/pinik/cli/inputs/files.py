"""Files that commands read, up to a size; "-" is stdin."""

from __future__ import annotations

import sys
from pathlib import Path

from ..terminal.exits import CommandError

__all__ = ["label_of", "read_bytes"]


def label_of(path: str) -> str:
    """What messages call a file."""
    return "stdin" if path == "-" else path


def read_bytes(path: str, most: int, what: str) -> bytes:
    """The contents of a file.

    Args:
        path: The file; "-" is stdin.
        most: The largest size [bytes].
        what: What the file holds, for the message about its size.

    Raises:
        CommandError: The file is unreadable or too large.
    """
    label = label_of(path)
    try:
        if path == "-":
            data = sys.stdin.buffer.read(most + 1)
        else:
            with open(Path(path).expanduser(), "rb") as file:
                data = file.read(most + 1)
    except OSError as error:
        raise CommandError(f"{label}: cannot read the file: {error.strerror or error}") from None
    if len(data) > most:
        raise CommandError(f"{label}: {what} must not be larger than {most // 1024**2} MB")
    return data
