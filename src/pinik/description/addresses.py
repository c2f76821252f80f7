"""The addresses of files in a URDF, taken apart: `package://`, `model://`, `file:`, `$(find …)`, and plain paths."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePosixPath
from urllib.parse import unquote

__all__ = ["Address", "UnusableAddressError", "is_expression", "read_address"]

LONGEST = 4096  # characters; no file name of Linux or macOS is longer
_FIND = re.compile(r"^(?:file:(?://)?|package://)?\$\(\s*find(?:-pkg-share)?\s+([^\s()$]+)\s*\)/*")
_SCHEME = re.compile(r"^([A-Za-z][A-Za-z0-9+.-]*):")
_DRIVE = re.compile(r"^[A-Za-z]:[/\\]")


class UnusableAddressError(ValueError):
    """An address names no file that pinik could look for; the message says why.

    Attributes:
        common: The message without the names in it.
    """

    def __init__(self, message: str, common: str | None = None) -> None:
        self.common = message if common is None else common
        super().__init__(message)


@dataclass(frozen=True)
class Address:
    """Where a file is, as a URDF says it.

    Attributes:
        package: The name of the package that holds it, or None for a path.
        spellings: The path, in the package or of the file system: as it is written and, if that differs, with
            "%20" and the like decoded.
    """

    package: str | None
    spellings: tuple[str, ...]


def read_address(text: str) -> Address:
    """Take an address apart.

    Raises:
        UnusableAddressError: It is empty, too long or of another machine, or it leaves its package through "..".
    """
    text = text.strip()
    if not text:
        raise UnusableAddressError("the address is empty")
    if len(text) > LONGEST or "\0" in text:
        raise UnusableAddressError("no file has such a name")
    _refuse_windows(text)
    text = text.replace("\\", "/")
    found = _FIND.match(text)
    if found:
        return _in_package(found.group(1), text[found.end() :])
    if "$(" in text or "${" in text:
        raise UnusableAddressError("it holds a xacro expression")
    scheme = _SCHEME.match(text)
    if scheme is None:
        return Address(None, _spellings(text))
    rest = text[scheme.end() :]
    match scheme.group(1).lower():
        case "package" | "model":
            # Some files have three slashes, or two between the package and the path.
            name, _, inside = rest.lstrip("/").partition("/")
            return _in_package(name, inside)
        case "file":
            return Address(None, _spellings(_path_of_file_address(rest)))
        case "http" | "https" | "ftp":
            raise UnusableAddressError("it is an address in a network, and pinik opens files of this machine only")
        case other if rest.startswith("//"):
            cause = f"pinik does not know addresses that begin with {other + '://'!r}"
            raise UnusableAddressError(cause, "pinik does not know addresses of this kind")
        case _:
            return Address(None, _spellings(text))


def is_expression(attribute: str, text: str) -> bool:
    """Whether an attribute holds an expression that xacro would replace.

    "$(find package)/mesh.stl" has one meaning, and files that were expanded by hand still have it.
    """
    return "${" in text or ("$(" in text and not (attribute == "filename" and _uses_find(text)))


def _uses_find(text: str) -> bool:
    """Whether an address begins with "$(find package)", and holds no other expression."""
    found = _FIND.match(text.strip())
    return found is not None and "$" not in text.strip()[found.end() :]


def _refuse_windows(text: str) -> None:
    path = re.sub(r"^file:/*(?=[A-Za-z]:)", "", text, flags=re.IGNORECASE)
    if _DRIVE.match(path):
        raise UnusableAddressError(f"it is a path of a Windows machine, on its drive {path[0].upper()}:")
    if text.startswith("\\\\"):
        raise UnusableAddressError("it is a path of a Windows network")


def _in_package(name: str, inside: str) -> Address:
    inside = inside.lstrip("/")
    if name in ("", ".", ".."):
        raise UnusableAddressError("it names no package")
    if not inside:
        raise UnusableAddressError("it names a package, but no file in it")
    spellings = _spellings(inside)
    if not all(map(_stays_inside, spellings)):
        raise UnusableAddressError("it leaves its package through '..'")
    return Address(name, spellings)


def _path_of_file_address(rest: str) -> str:
    """The path after "file:". A host is ignored, and two slashes before a relative path are common."""
    if rest.startswith("//"):
        rest = rest[2:].removeprefix("localhost")
    return "/" + rest.lstrip("/") if rest.startswith("/") else rest


def _spellings(path: str) -> tuple[str, ...]:
    decoded = unquote(path)
    return (path,) if decoded == path or "\0" in decoded else (path, decoded)


def _stays_inside(inside: str) -> bool:
    depth = 0
    for part in PurePosixPath(inside).parts:
        depth += -1 if part == ".." else 1
        if depth < 0:
            return False
    return not inside.startswith("/")
