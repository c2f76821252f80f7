"""`load`: makes a robot from a catalogue name, a path, URDF text or bytes, or an open file."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from .description import catalog as robot_catalog
from .description import packages
from .description import reader as urdf
from .description.flaw import Flaw, summarised
from .description.source import RobotSource, is_document, is_source
from .errors import InputError, RobotLoadError, UrdfWarning
from .robot import Robot

__all__ = ["load", "load_in_silence", "locate"]

_MOST_LISTED = 12


def load(
    source: RobotSource,
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    strict: bool = False,
) -> Robot:
    """Load a robot.

    Args:
        source: A catalogue name ("arm", "lion", "panda", …: `pinik.catalog()`), a path to a .urdf file, URDF text, the
            bytes of a URDF file, or an open file, which is read from where it stands to its end.
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: Folders that are searched first for `package://` addresses of meshes.
        mimic: Whether mimic joints follow their leaders; with False they are all free.
        strict: Whether every warning is an error.

    Raises:
        RobotLoadError: The description is faulty; the message names the element and the cause. With `strict`, also if
            pinik repaired, assumed or ignored something, or did not find a mesh; the message lists what.
        UnknownNameError: The catalogue has no robot of that name.
        InputError: The root is unknown, the source is none of these, or `package_dirs` is not a list.

    Warns:
        UrdfWarning: pinik repaired, assumed or ignored something, or did not find a mesh; once for each sort of flaw.
    """
    robot = load_in_silence(source, root=root, package_dirs=package_dirs, mimic=mimic, strict=strict)
    for words in summarised(robot.warnings):
        warnings.warn(f"{robot.name}: {words}", UrdfWarning, stacklevel=2)
    return robot


def load_in_silence(
    source: RobotSource,
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    strict: bool = False,
) -> Robot:
    """`load` without Python warnings, for callers that show `Robot.warnings` themselves."""
    if isinstance(package_dirs, (str, os.PathLike)) or not isinstance(package_dirs, Iterable):
        raise InputError(f"must be a list of folders; got {package_dirs!r}", argument="package_dirs")
    folders = tuple(package_dirs)
    for folder in folders:
        if not isinstance(folder, (str, os.PathLike)):
            raise InputError(f"must be a list of folders; got {folder!r} in it", argument="package_dirs")
    homes = tuple(_home_expanded(Path(folder)) for folder in folders)
    if not is_source(source):
        raise InputError(
            f"a robot must be a catalogue name, a path or URDF text, its bytes, or an open file; got {source!r}"
        )
    name, srdf, located = locate(source) if isinstance(source, (str, os.PathLike)) else (None, None, source)
    description = urdf.read(located)
    robot = Robot(description, name=name, root=root, package_dirs=homes, mimic=mimic, srdf=srdf or _beside(description))
    missing = [a for a in description.meshes if not _mesh_found(a, description.path, robot.package_dirs)]
    if missing:
        count = "1 mesh was" if len(missing) == 1 else f"{len(missing)} meshes were"
        cause = f"{count} not found ({missing[0]}{', …' if len(missing) > 1 else ''}); kinematics works without them"
        robot.warnings += (Flaw("<robot>", cause, code="missing-meshes"),)
    if strict and robot.warnings:
        raise RobotLoadError(_listed(robot.warnings), source=description.source)
    return robot


def _listed(flaws: Sequence[str]) -> str:
    """All warnings in one message, with one for each sort."""
    sorts = summarised(flaws)
    more = f"; and {len(sorts) - _MOST_LISTED} other sorts" if len(sorts) > _MOST_LISTED else ""
    count = "one warning is an error" if len(flaws) == 1 else f"each of {len(flaws)} warnings is an error"
    return f"with strict=True, {count}: {'; '.join(sorts[:_MOST_LISTED])}{more}"


def _beside(description: urdf.Description) -> Path | None:
    """The SRDF file of the same name in the same folder, if there is one."""
    path = description.path
    srdf = path.with_suffix(".srdf") if path and path.name else None
    return srdf if srdf and srdf.is_file() else None


def locate(source: str | os.PathLike[str]) -> tuple[str | None, Path | None, str | Path]:
    """Find a robot's source: (catalogue name or None, the catalogue's SRDF path or None, URDF path or text).

    Raises:
        UnknownNameError: The catalogue has no robot of that name.
        RobotLoadError: There is no such file, but the catalogue has a robot of that name.
    """
    if isinstance(source, str):
        if is_document(source):
            return None, None, source
        looks_like_path = os.sep in source or source.endswith((".urdf", ".xml", ".xacro"))
        if not looks_like_path and (source in robot_catalog.catalog() or not os.path.exists(source)):
            entry = robot_catalog.find(source)
            return entry.name, entry.srdf, entry.urdf
    path = _home_expanded(Path(source))
    if path.stem in robot_catalog.catalog() and not os.path.lexists(path):
        raise RobotLoadError(f"no such file, but the catalogue has a robot {path.stem!r}", source=str(path))
    return None, None, path


def _home_expanded(path: Path) -> Path:
    """The path with "~" expanded; unchanged if there is no such home folder."""
    try:
        return path.expanduser()
    except RuntimeError:
        return path


def _mesh_found(address: str, urdf_path: Path | None, package_dirs: Sequence[Path]) -> bool:
    return packages.resolve(address, urdf_path=urdf_path, package_dirs=package_dirs) is not None
