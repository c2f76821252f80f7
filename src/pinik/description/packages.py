"""Find the files that a URDF refers to: `package://`, `model://`, `file://`, absolute and relative."""

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

# ROS 1 searches packages anywhere below the entries of ROS_PACKAGE_PATH; workspaces nest them this deep.
NESTED_PACKAGES = ("", "*/", "*/*/")


def resolve(
    address: str, *, urdf_path: Path | None = None, package_dirs: Sequence[os.PathLike[str] | str] = ()
) -> Path | None:
    """Find the file that an address in a URDF refers to.

    Packages are searched in `package_dirs`, in the folders above the URDF file, in example-robot-data, and in the
    entries of ROS_PACKAGE_PATH and AMENT_PREFIX_PATH, in this order. The first place that has the file wins.

    Args:
        address: The address as written: "package://name/rest", "model://name/rest", "file:///path", or a path. A
            relative path starts at the URDF file's folder.
        urdf_path: The URDF file; None if the description was given as text.
        package_dirs: Folders that contain packages, or are packages.

    Returns:
        The file, or None if it does not exist or the address leaves its package through "..".
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
    # Some files have three slashes.
    name, _, inside = rest.lstrip("/").partition("/")
    if name in ("", ".", "..") or not _stays_inside(inside):
        return None
    for package in _package_places(name, urdf_path, package_dirs):
        if os.path.isfile(package / inside):
            return package / inside
    return None


@functools.cache
def example_robot_data() -> Path | None:
    """The robots folder of example-robot-data, or None if that package is not installed."""
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
    """The folders in which a package of this name may be, nearest first."""
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
    """The name in the folder's package.xml, for checkouts whose folder has another name."""
    try:
        manifest = (directory / "package.xml").read_text(errors="replace")
    except OSError:
        return None
    name = re.search(r"<name>\s*([^<\s]+)\s*</name>", manifest)
    return name and name.group(1)


def _entries(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]
