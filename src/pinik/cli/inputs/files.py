"""Files that commands read, up to a size, where "-" is stdin, and files that they write whole or not at all."""

from __future__ import annotations

import sys
from pathlib import Path

from ...files import check_writable, write_whole
from ..terminal.exits import CommandError
from ..terminal.output import reason_of

__all__ = ["STDIN", "check_file", "label_of", "read_bytes", "write_file"]


STDIN = "stdin"
"""What messages and reports call a file that comes through stdin."""


def label_of(path: str) -> str:
    """What messages call a file."""
    return STDIN if path == "-" else path


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
        raise CommandError(f"{label}: cannot read the file: {reason_of(error)}") from None
    if len(data) > most:
        raise CommandError(f"{label}: {what} must not be larger than {most // 1024**2} MB")
    return data


def check_file(path: Path, option: str) -> None:
    """Check that a file can be written, before minutes are spent on its content.

    Raises:
        CommandError: It cannot; the message begins with the option that names it.
    """
    if path == Path():
        raise CommandError(f'{option} must be the name of a file; an empty text and "." are the working directory')
    try:
        check_writable(path)
    except OSError as error:
        raise CommandError(f"{option} {path}: {error.strerror or error}") from None


def write_file(path: Path, content: bytes, option: str) -> None:
    """Write a file whole or not at all.

    Raises:
        CommandError: It cannot be written; the message begins with the option that names it.
    """
    try:
        write_whole(path, content)
    except OSError as error:
        raise CommandError(f"{option} {path}: cannot write it: {error.strerror or error}") from None
