"""Where a robot description comes from: a path, text, bytes, or an open file."""

from __future__ import annotations

import os
import reprlib
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from ..echoes import shortened
from ..errors import InputError, RobotLoadError
from ..files import FileError, read_within
from .encodings import declared_as_utf_8
from .xml import MAX_BYTES, DocumentError

__all__ = ["RobotSource", "Source", "is_document", "is_source"]

RobotSource = str | os.PathLike[str] | bytes | IO[str] | IO[bytes]
"""A path, URDF text, the bytes of a URDF file, or an open file."""

_TEXT = "<text>"
_LONGEST = 200


@dataclass(frozen=True)
class Source:
    """A robot description that can be read.

    Attributes:
        given: A path, URDF text, the bytes of a URDF file, or an open file.
        label: What messages call it: its path, or "<text>".
        path: The file to which relative addresses refer; None if there is none.
        expanded: Whether what is read is the URDF that xacro made of it, so that lines are not those of the file.
    """

    given: Any
    label: str
    path: Path | None
    expanded: bool = False

    @classmethod
    def of(cls, given: RobotSource) -> Source:
        """The source; a string is URDF text if it begins with "<" after any white space and byte-order mark."""
        if isinstance(given, (bytes, bytearray, memoryview)) or is_document(given):
            return cls(given, _TEXT, None)
        if isinstance(given, (str, os.PathLike)):
            return cls(given, _shown(os.fspath(given)), Path(given))
        name = getattr(given, "name", None)
        path = Path(name) if isinstance(name, str) and os.path.isfile(name) else None
        return cls(given, _shown(name) if isinstance(name, str) else _TEXT, path)

    def content(self) -> bytes:
        """The bytes of the description, or more than `MAX_BYTES` of them. An open file is read to its end.

        Raises:
            RobotLoadError: It cannot be read; the message says why.
            InputError: It is a memoryview that is released.
        """
        try:
            if isinstance(self.given, (bytes, bytearray, memoryview)):
                return _copied(self.given)
            if is_document(self.given):
                return _encoded(self.given)
            if isinstance(self.given, (str, os.PathLike)):
                return _file_bytes(Path(self.given))
            return _stream_bytes(self.given)
        except DocumentError as fault:
            raise RobotLoadError(fault.message, source=self.label) from None


def is_document(given: object) -> bool:
    """Whether a string is URDF text instead of a name or path."""
    return isinstance(given, str) and given.lstrip("\ufeff \t\r\n").startswith("<")


def is_source(given: object) -> bool:
    """Whether a robot description can be read from this."""
    return isinstance(given, (str, os.PathLike, bytes, bytearray, memoryview)) or callable(getattr(given, "read", None))


def _copied(given: bytes | bytearray | memoryview) -> bytes:
    try:
        return bytes(given)
    except ValueError:
        raise InputError(f"the bytes of a robot are in a memoryview that is released; got {given!r}") from None


def _shown(path: str) -> str:
    path = shortened(path, _LONGEST)
    return path if path and path.isprintable() else repr(path)


def _encoded(text: str) -> bytes:
    try:
        return declared_as_utf_8(text.lstrip("\ufeff").encode("utf-8"))
    except UnicodeEncodeError as error:
        raise DocumentError(f"not XML: the text cannot be encoded ({error.reason})") from None


def _stream_bytes(file: IO[Any]) -> bytes:
    """What is left to read in an open file; an endless one must not fill up the memory."""
    pieces: list[Any] = []
    size = 0
    while size <= MAX_BYTES and (piece := _piece(file, MAX_BYTES + 1 - size)):
        if pieces and type(piece) is not type(pieces[0]):
            raise DocumentError("the file must give either text or bytes; it gave both")
        pieces.append(piece)
        size += len(piece)
    return _encoded("".join(pieces)) if pieces and isinstance(pieces[0], str) else b"".join(pieces)


def _piece(file: IO[Any], most: int) -> str | bytes:
    """The next piece of an open file."""
    try:
        piece = file.read(most)
    except UnicodeDecodeError as error:
        raise DocumentError(f"the file cannot be read as text ({error}); open it in binary mode") from None
    except (OSError, ValueError) as error:
        raise DocumentError(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    except TypeError as error:
        raise DocumentError(f"the file's read() must take a size: {error}") from None
    if isinstance(piece, str):
        return str(piece)
    if isinstance(piece, (bytes, bytearray, memoryview)):
        return bytes(piece)
    raise DocumentError(f"the file must give text or bytes; it gave {reprlib.repr(piece)}")


def _file_bytes(path: Path) -> bytes:
    try:
        return read_within(path, MAX_BYTES, "a URDF file", streams=True)
    except FileError as fault:
        is_name = path.suffix or os.path.lexists(path)
        remark = "" if is_name else " (URDF text would begin with '<')"
        raise DocumentError(f"{fault}{remark}") from None
