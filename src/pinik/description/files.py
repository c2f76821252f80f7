"""Read files within a bound: regular files only, so that no pipe, device or endless stream holds up the program."""

from __future__ import annotations

import os
import stat
from pathlib import Path

__all__ = ["FileError", "megabytes", "read_within"]

# So that opening a pipe that nobody writes to does not wait; Windows has no such flag, and no such pipes.
_WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


class FileError(Exception):
    """A file cannot be read; the message says why, without the file's name."""


def read_within(path: Path, most: int, what: str, *, streams: bool = False) -> bytes:
    """The contents of a regular file.

    Args:
        path: The file.
        most: The largest size [bytes].
        what: What the file should be, for messages: "a URDF file".
        streams: Whether streams that are open already are read too, such as "<(xacro ...)" or "/dev/stdin".

    Raises:
        FileError: There is no such file, it is no regular file, it is larger, or it cannot be read.
    """
    waits = streams and _is_open_already(path)
    try:
        descriptor = os.open(path, os.O_RDONLY | (0 if waits else _WITHOUT_WAITING))
        with open(descriptor, "rb") as file:
            kind = os.fstat(descriptor).st_mode
            if stat.S_ISDIR(kind):
                raise FileError(f"this is a directory, not {what}")
            if not (stat.S_ISREG(kind) or waits):
                raise FileError(f"this is a pipe or a device, not {what}")
            contents = file.read(most + 1)
    except FileNotFoundError:
        raise FileError("there is no such file") from None
    except (OSError, ValueError) as error:
        if os.path.isdir(path):
            raise FileError(f"this is a directory, not {what}") from None
        raise FileError(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if len(contents) > most:
        raise FileError(f"larger than {megabytes(most)}, too large for {what}")
    return contents


def megabytes(size: int) -> str:
    """A size in bytes as text."""
    return f"{size // 1024**2} MB" if size >= 1024**2 else f"{size // 1024} KB"


def _is_open_already(path: Path) -> bool:
    return os.path.abspath(path).startswith(("/dev/fd/", "/proc/self/fd/", "/dev/stdin"))
