"""Find the files that a URDF refers to, and open none that it may not open.

A URDF may open files in its own folder, in its package, in packages that the search finds by name, and in
`package_dirs`. Its package is the nearest folder above it with a package.xml or, without one, the folder above one that
is called "urdf", "robots" or the like. Symbolic links are followed, and what counts is the file at their end.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from .addresses import Address, UnusableAddressError, read_address
from .manifests import names_in
from .package_search import PackageSearch, is_below

__all__ = ["Found", "Surroundings"]

_MOST_ENTRIES = 5000


@dataclass(frozen=True)
class Found:
    """What an address leads to.

    Attributes:
        path: The file, or None.
        why: Why there is none, in words; empty if there is one.
        common: The same without the names in it, equal for all addresses that lead to nothing for the same reason.
        refused: Whether there is a file, but the URDF may not open it.
    """

    path: Path | None
    why: str = ""
    common: str = ""
    refused: bool = False

    @classmethod
    def nothing(cls, why: str, common: str | None = None, *, refused: bool = False) -> Found:
        """There is no file that may be opened, and why."""
        return cls(None, why, why if common is None else common, refused)

    @property
    def code(self) -> str:
        """The code of the flaw that a mesh at this address is."""
        return "mesh-outside" if self.refused else "missing-mesh"

    @property
    def mend(self) -> str:
        """What to do about it."""
        if self.refused:
            return "Name its folder in package_dirs (--package-dir), or load with allow_outside (--allow-outside)."
        return "Correct the address, or name the folder of its package in package_dirs (--package-dir)."


class Surroundings:
    """The files around a URDF, by their addresses in it.

    It remembers folders, so that thousands of addresses are looked up quickly; make a new one when files have changed.

    Args:
        urdf_path: The URDF file; None if the description was given as text, whose relative addresses begin at the
            working directory.
        package_dirs: Folders that contain packages, or are packages; they are searched first.
        allow_outside: Whether the URDF may open any file of this machine.
    """

    def __init__(
        self,
        urdf_path: Path | None = None,
        package_dirs: Sequence[os.PathLike[str] | str] = (),
        allow_outside: bool = False,
    ) -> None:
        self._urdf_path = urdf_path
        self._base = Path() if urdf_path is None else urdf_path.parent
        self._package_dirs = tuple(map(Path, package_dirs))
        self._allow_outside = allow_outside
        self._entries: dict[Path, dict[str, str]] = {}

    @cached_property
    def _search(self) -> PackageSearch:
        """The search, which reads folders when it is made, and so is made for the first address only."""
        return PackageSearch(self._urdf_path, self._package_dirs)

    def find(self, text: str) -> Found:
        """The file at an address: "package://name/rest", "$(find name)/rest", "file:///path", or a path."""
        try:
            address = read_address(text)
        except UnusableAddressError as fault:
            return Found.nothing(str(fault), fault.common)
        refused = False
        for candidate in self._candidates(address):
            if _is_file(candidate):
                if self._may_open(candidate, address):
                    return Found(candidate)
                refused = True
        if refused:
            return Found.nothing("it lies outside the folders that this URDF may open", refused=True)
        return self._nothing_at(address)

    def package(self, name: str) -> Path | None:
        """The folder of a package, or None if the search does not find it."""
        return next(self._search.places(name), None)

    def why_no_package(self, name: str) -> str:
        """That no package of this name was found, with one whose name differs only in upper and lower case."""
        near = self._search.other_case(name)
        return f"no package {name!r} was found" + ("" if near is None else f", but there is {near!r}")

    def _candidates(self, address: Address) -> Iterator[Path]:
        if address.package is not None:
            for place in self._search.places(address.package):
                yield from (place / inside for inside in address.spellings)
            return
        for folder in (self._base, *self._package_dirs):
            yield from (folder / path for path in address.spellings)

    def _may_open(self, file: Path, address: Address) -> bool:
        if self._allow_outside:
            return True
        real = os.path.realpath(file)
        if any(is_below(real, folder) for folder in self._search.roots):
            return True
        named = () if address.package is None else self._search.places(address.package)
        if any(is_below(real, os.path.realpath(place)) for place in named):
            return True
        return self._search.belongs(real, address.package)

    def _nothing_at(self, address: Address) -> Found:
        """Why nothing was found, with a file or package whose name differs only in upper and lower case."""
        for candidate in self._candidates(address):
            other = _in_its_place(candidate)
            if other:
                return Found.nothing(other)
        for candidate in self._candidates(address):
            near = self._other_case(candidate)
            if near is not None and self._may_open(near, address):
                why = f"there is {near.name!r}" if near.parent == candidate.parent else f"there is '{near}'"
                return Found.nothing(why, "there is a file whose name differs only in upper and lower case")
        name = address.package
        if name is None or self.package(name) is not None:
            return Found.nothing("there is no such file")
        if self._search.other_case(name) is None:
            return Found.nothing(self.why_no_package(name), "no package of this name was found")
        return Found.nothing(
            self.why_no_package(name), "there is a package whose name differs only in upper and lower case"
        )

    def _other_case(self, path: Path) -> Path | None:
        """A file whose path differs only in upper and lower case, among the last folders of the path."""
        folder, rest = path.parent, [path.name]
        while not os.path.isdir(folder):
            if folder == folder.parent or len(rest) > 20:
                return None
            folder, rest = folder.parent, [folder.name, *rest]
        for part in rest:
            name = self._names_in(folder).get(part.casefold())
            if name is None:
                return None
            folder = folder / name
        return folder if _is_file(folder) else None

    def _names_in(self, folder: Path) -> dict[str, str]:
        if folder not in self._entries:
            self._entries[folder] = {name.casefold(): name for name in names_in(folder, _MOST_ENTRIES)}
        return self._entries[folder]


def _is_file(path: Path) -> bool:
    """Whether a path is a regular file; False for names that no file can have."""
    try:
        return os.path.isfile(path)
    except ValueError:
        return False


def _in_its_place(path: Path) -> str:
    """What stands at a path that is no regular file; empty if there is nothing."""
    try:
        kind = os.stat(path).st_mode
    except PermissionError:
        return "a folder on the way to it cannot be read: permission denied"
    except (OSError, ValueError):
        return "this is a symbolic link that leads nowhere" if _is_link(path) else ""
    return "this is a directory, not a mesh" if stat.S_ISDIR(kind) else "this is a pipe or a device, not a mesh"


def _is_link(path: Path) -> bool:
    try:
        return os.path.islink(path)
    except ValueError:
        return False
