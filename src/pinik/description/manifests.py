"""The names of ROS packages, from the package.xml files in their folders."""

from __future__ import annotations

import os
import re
from pathlib import Path

from ..files import FileError, read_within
from .xml import COMMENT

__all__ = ["is_package", "manifest_name", "names_in", "packages_in"]

_MANIFEST = "package.xml"
_MOST_BYTES = 1024**2
_MOST_FOLDERS = 1000
_NAME = re.compile(rb"<name>\s*([^<\s]{1,200})\s*</name>")


def manifest_name(folder: Path) -> str | None:
    """The name of the package in a folder; None if it has no package.xml that can be read, or that has no name."""
    try:
        manifest = read_within(folder / _MANIFEST, _MOST_BYTES, "a package.xml")
    except FileError:
        return None
    name = _NAME.search(COMMENT.sub(b"", manifest))
    return None if name is None else name.group(1).decode("utf-8", "replace")


def is_package(folder: Path) -> bool:
    """Whether a folder has a package.xml that is a regular file."""
    return os.path.isfile(folder / _MANIFEST)


def names_in(folder: Path, most: int = _MOST_FOLDERS) -> list[str]:
    """The names of what is directly in a folder, sorted; of a very large folder, the first ones that are found."""
    try:
        with os.scandir(folder) as entries:
            return sorted(entry.name for entry, _ in zip(entries, range(most), strict=False))
    except (OSError, ValueError):
        return []


def packages_in(folder: Path) -> dict[str, list[Path]]:
    """Name → folders of the packages directly in a folder; of a very large folder, those among its first thousand."""
    found: dict[str, list[Path]] = {}
    for name in names_in(folder):
        package = manifest_name(folder / name)
        if package is not None:
            found.setdefault(package, []).append(folder / name)
    return found
