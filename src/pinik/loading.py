"""`load`: makes a robot from a catalogue name, a path or URDF text."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from .description import catalog as robot_catalog
from .description import packages
from .description import reader as urdf
from .echoes import bounded
from .errors import InputError, RobotLoadError, UrdfWarning
from .robot import Robot

__all__ = ["load", "load_in_silence", "locate"]


def load(
    source: str | os.PathLike[str],
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
) -> Robot:
    """Load a robot.

    Args:
        source: A catalogue name ("arm", "lion", "panda", …: `pinik.catalog()`), a path to a .urdf file, or URDF text.
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: Folders that are searched first for `package://` addresses of meshes.
        mimic: Whether mimic joints follow their leaders; with False they are all free.

    Raises:
        RobotLoadError: The description is faulty; the message names the element and the cause.
        UnknownNameError: The catalogue has no robot of that name.
        InputError: The root is unknown, the source is not a name, a path or text, or `package_dirs` is not a list.

    Warns:
        UrdfWarning: pinik repaired or ignored something, or did not find a mesh.
    """
    robot = load_in_silence(source, root=root, package_dirs=package_dirs, mimic=mimic)
    for words in robot.warnings:
        warnings.warn(bounded(f"{robot.name}: {words}"), UrdfWarning, stacklevel=2)
    return robot


def load_in_silence(
    source: str | os.PathLike[str],
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
) -> Robot:
    """`load` without Python warnings, for callers that show `Robot.warnings` themselves."""
    if isinstance(package_dirs, (str, os.PathLike)) or not isinstance(package_dirs, Iterable):
        raise InputError(f"must be a list of folders; got {package_dirs!r}", argument="package_dirs")
    folders = tuple(package_dirs)
    for folder in folders:
        if not isinstance(folder, (str, os.PathLike)):
            raise InputError(f"must be a list of folders; got {folder!r} in it", argument="package_dirs")
    homes = tuple(_home_expanded(Path(folder)) for folder in folders)
    name, srdf, path_or_text = locate(source)
    description = urdf.read(path_or_text)
    robot = Robot(description, name=name, root=root, package_dirs=homes, mimic=mimic, srdf=srdf)
    missing = [a for a in description.meshes if not _mesh_found(a, description.path, robot.package_dirs)]
    if missing:
        count = "1 mesh was" if len(missing) == 1 else f"{len(missing)} meshes were"
        named = bounded(missing[0]) + (", …" if len(missing) > 1 else "")
        robot.warnings += (f"{count} not found ({named}); kinematics works without them",)
    return robot


def locate(source: str | os.PathLike[str]) -> tuple[str | None, Path | None, str | Path]:
    """Find a robot's source: (catalogue name or None, SRDF path or None, URDF path or text).

    Raises:
        UnknownNameError: The catalogue has no robot of that name.
        RobotLoadError: There is no such file, but the catalogue has a robot of that name.
        InputError: The source is not a name, a path or text.
    """
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(f"a robot must be a catalogue name, a path or URDF text; got {source!r}")
    if isinstance(source, str):
        if source.lstrip("\ufeff \t\r\n").startswith("<"):
            return None, None, source
        looks_like_path = os.sep in source or source.endswith((".urdf", ".xml", ".xacro"))
        if not looks_like_path and (source in robot_catalog.catalog() or not os.path.exists(source)):
            entry = robot_catalog.find(source)
            return entry.name, entry.srdf, entry.urdf
    path = _home_expanded(Path(source))
    if path.stem in robot_catalog.catalog() and not os.path.lexists(path):
        raise RobotLoadError(f"no such file, but the catalogue has a robot {path.stem!r}", source=str(path))
    srdf = path.with_suffix(".srdf") if path.name else None
    return None, srdf if srdf and os.path.isfile(srdf) else None, path


def _home_expanded(path: Path) -> Path:
    """The path with "~" expanded; unchanged if there is no such home folder."""
    try:
        return path.expanduser()
    except RuntimeError:
        return path


def _mesh_found(address: str, urdf_path: Path | None, package_dirs: Sequence[Path]) -> bool:
    return packages.resolve(address, urdf_path=urdf_path, package_dirs=package_dirs) is not None
