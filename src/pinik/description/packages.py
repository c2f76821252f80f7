"""Find the files that a URDF addresses: `package://`, `model://`, `file://`, absolute and relative."""

from __future__ import annotations

import functools
import glob
import os
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

__all__ = ["example_robot_data", "resolve"]

# ROS 1 looks for packages anywhere below the entries of ROS_PACKAGE_PATH; workspaces nest them this deep.
NESTED_PACKAGES = ("", "*/", "*/*/")


def resolve(
    address: str, *, urdf_path: Path | None = None, package_dirs: Sequence[os.PathLike[str] | str] = ()
) -> Path | None:
    """Find the file behind an address in a URDF.

    A package is looked for in `package_dirs`, then above the URDF file, in example-robot-data, and in the
    entries of ROS_PACKAGE_PATH and AMENT_PREFIX_PATH; the first place that has the file wins.

    Args:
        address: As written: "package://name/rest", "model://name/rest", "file:///path", or a path, which is
            relative to the URDF file if it is not absolute.
        urdf_path: The URDF file; None if the description came as text.
        package_dirs: Directories that hold packages, or are packages.

    Returns:
        The file; None where there is none, or where the address leaves its package by "..".
    """
    address = address.strip().replace("\\", "/")
    scheme, separator, rest = address.partition("://")
    if not separator:
        return _relative(address, urdf_path, package_dirs)
    if scheme == "file":
        path = unquote(urlsplit(address).path)
        return Path(path) if os.path.isfile(path) else None
    if scheme not in ("package", "model"):
        return None
    # Some files write three slashes.
    name, _, inside = rest.lstrip("/").partition("/")
    if name in ("", ".", "..") or not _stays_inside(inside):
        return None
    for package in _package_places(name, urdf_path, package_dirs):
        if os.path.isfile(package / inside):
            return package / inside
    return None


@functools.cache
def example_robot_data() -> Path | None:
    """The folder of example-robot-data's robots; None where that package is not installed."""
    prefixes = [Path(entry) / "cmeel.prefix" for entry in sys.path] + [Path(sys.prefix)]
    for prefix in prefixes:
        robots = prefix / "share" / "example-robot-data" / "robots"
        if robots.is_dir():
            return robots
    return None


def _relative(address: str, urdf_path: Path | None, package_dirs: Sequence[os.PathLike[str] | str]) -> Path | None:
    base = Path() if urdf_path is None else urdf_path.parent
    for directory in (base, *map(Path, package_dirs)):
        if os.path.isfile(directory / address):
            return directory / address
    return None


def _stays_inside(inside: str) -> bool:
    depth = 0
    for part in PurePosixPath(inside).parts:
        depth += -1 if part == ".." else 1
        if depth < 0:
            return False
    return not inside.startswith("/")


def _package_places(
    name: str, urdf_path: Path | None, package_dirs: Sequence[os.PathLike[str] | str]
) -> Iterator[Path]:
    """Where a package of this name may be, nearest first."""
    homes = [Path(directory) for directory in package_dirs]
    if urdf_path is not None:
        homes.extend(urdf_path.absolute().parents)
        homes.extend(urdf_path.resolve().parents)
    for home in dict.fromkeys(homes):
        yield home / name
        if home.name == name or _manifest_name(home) == name:
            yield home
    robots = example_robot_data()
    if robots is not None:
        yield robots.parent.parent / name
        yield robots / name
    for entry in _entries("ROS_PACKAGE_PATH"):
        if entry.name == name:
            yield entry
        for nesting in NESTED_PACKAGES:
            yield from entry.glob(nesting + glob.escape(name))
    for entry in _entries("AMENT_PREFIX_PATH"):
        yield entry / "share" / name


def _manifest_name(directory: Path) -> str | None:
    """The name in a directory's package.xml, for checkouts whose folder is called otherwise."""
    try:
        manifest = (directory / "package.xml").read_text(errors="replace")
    except OSError:
        return None
    name = re.search(r"<name>\s*([^<\s]+)\s*</name>", manifest)
    return name and name.group(1)


def _entries(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]
