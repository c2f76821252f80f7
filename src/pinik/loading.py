"""`load`: makes a robot from a catalogue name, a path or URDF text."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from .description import catalog as robot_catalog
from .description import downloads, xacro
from .description import reader as urdf
from .description.flaw import Flaw, summarised
from .errors import InputError, RobotLoadError, UnknownNameError, UrdfWarning
from .robot import Robot

__all__ = ["load", "load_in_silence", "locate"]


def load(
    source: str | os.PathLike[str],
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    xacro_args: Mapping[str, object] | None = None,
    allow_outside: bool = False,
) -> Robot:
    """Load a robot.

    Args:
        source: A catalogue name ("arm", "lion", "panda", …: `pinik.catalog()`), a path to a URDF or xacro file, URDF
            text, or the name of a robot in the cache of robot_descriptions ("ur10e_description").
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: Folders that are searched first for `package://` addresses of meshes.
        mimic: Whether mimic joints follow their leaders; with False they are all free.
        xacro_args: The arguments of a xacro file by name, such as {"ur_type": "ur10e"}. xacro evaluates expressions and
            opens other files, so load only xacro files that you trust.
        allow_outside: Whether the URDF may open meshes outside its own folder, its packages and `package_dirs`.

    Raises:
        RobotLoadError: The description is faulty; the message names the element and the cause.
        UnknownNameError: There is no robot of that name, or the xacro file has no argument of a given name.
        InputError: The root is unknown, the source is not a name, a path or text, `package_dirs` is not a list, or
            `xacro_args` is not a dict or is given for a file that is not xacro.
        MissingExtraError: The file is xacro, and xacrodoc is not installed.

    Warns:
        UrdfWarning: pinik repaired, assumed or ignored something, or did not find a mesh; once for each sort of flaw.
    """
    robot = load_in_silence(
        source, root=root, package_dirs=package_dirs, mimic=mimic, xacro_args=xacro_args, allow_outside=allow_outside
    )
    for words in summarised(robot.warnings):
        warnings.warn(f"{robot.name}: {words}", UrdfWarning, stacklevel=2)
    return robot


def load_in_silence(
    source: str | os.PathLike[str],
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    xacro_args: Mapping[str, object] | None = None,
    allow_outside: bool = False,
) -> Robot:
    """`load` without Python warnings, for callers that show `Robot.warnings` themselves."""
    if isinstance(package_dirs, (str, os.PathLike)) or not isinstance(package_dirs, Iterable):
        raise InputError(f"must be a list of folders; got {package_dirs!r}", argument="package_dirs")
    folders = tuple(package_dirs)
    for folder in folders:
        if not isinstance(folder, (str, os.PathLike)):
            raise InputError(f"must be a list of folders; got {folder!r} in it", argument="package_dirs")
    homes = tuple(_home_expanded(Path(folder)) for folder in folders)
    located = locate(source)
    homes = (*homes, *located.package_dirs)
    description = describe(located, package_dirs=homes, xacro_args=xacro_args)
    robot = Robot(
        description,
        name=located.name,
        root=root,
        package_dirs=homes,
        mimic=mimic,
        srdf=located.srdf,
        allow_outside=allow_outside,
    )
    robot.warnings += tuple(_unfound(robot))
    return robot


@dataclass(frozen=True)
class Located:
    """Where a robot's description is.

    Attributes:
        source: The path of its file, or its text.
        name: Its name in the catalogue or in robot_descriptions; None for a path or text.
        srdf: Its SRDF file, if it has one.
        package_dirs: Folders of its packages.
        xacro_args: Arguments of its xacro file.
    """

    source: str | Path
    name: str | None = None
    srdf: Path | None = None
    package_dirs: tuple[Path, ...] = ()
    xacro_args: Mapping[str, str] = field(default_factory=dict)


def describe(
    located: Located, *, package_dirs: Sequence[Path] = (), xacro_args: Mapping[str, object] | None = None
) -> urdf.Description:
    """Read and check a description; a xacro file is expanded first, if it is given by its path.

    Raises:
        RobotLoadError, UnknownNameError, InputError, MissingExtraError: As for `load`.
    """
    given = xacro.check_arguments(xacro_args)
    path = located.source
    document = urdf.file_bytes(path) if isinstance(path, Path) else b""
    if not isinstance(path, Path) or not xacro.is_xacro(path, document):
        if given:
            raise InputError(f"are for xacro files, and this is none; got {xacro_args!r}", argument="xacro_args")
        return urdf.read_document(document, str(path), path) if isinstance(path, Path) else urdf.read(path)
    expansion = xacro.expand(path, {**located.xacro_args, **given}, package_dirs)
    description = urdf.read_document(expansion.document, str(path), path, "utf-8")
    remarks = (Flaw("xacro", remark, code="xacro") for remark in expansion.remarks)
    return replace(description, warnings=(*remarks, *description.warnings))


def locate(source: str | os.PathLike[str]) -> Located:
    """Find a robot's description by its name or path.

    Raises:
        UnknownNameError: There is no robot of that name.
        RobotLoadError: There is no such file, but the catalogue has a robot of that name; or robot_descriptions has the
            robot, but not in its cache.
        InputError: The source is not a name, a path or text.
    """
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(f"a robot must be a catalogue name, a path or URDF text; got {source!r}")
    if isinstance(source, str):
        if source.lstrip("\ufeff \t\r\n").startswith("<"):
            return Located(source)
        looks_like_path = os.sep in source or source.endswith((".urdf", ".xml", ".xacro"))
        if not looks_like_path and (source in robot_catalog.catalog() or not os.path.exists(source)):
            return _named(source)
    path = _home_expanded(Path(source))
    if path.stem in robot_catalog.catalog() and not os.path.lexists(path):
        raise RobotLoadError(f"no such file, but the catalogue has a robot {path.stem!r}", source=str(path))
    srdf = path.with_suffix(".srdf") if path.name else None
    return Located(path, srdf=srdf if srdf and srdf.is_file() else None)


def _named(name: str) -> Located:
    """A robot of the catalogue, else one in the cache of robot_descriptions."""
    own = robot_catalog.catalog()
    if name not in own and name in downloads.downloadable():
        found = downloads.find_download(name)
        return Located(found.file, name, found.srdf, found.package_dirs, found.arguments)
    if name in own or not name.endswith(downloads.ENDING):
        entry = robot_catalog.find(name)
        return Located(entry.urdf, entry.name, entry.srdf)
    others = downloads.downloadable()
    hint = "or give the path of a .urdf file" if others else f"more robots: {downloads.INSTALL}"
    raise UnknownNameError("robot", name, [*own, *others], hint=hint)


def _home_expanded(path: Path) -> Path:
    """The path with "~" expanded; unchanged if there is no such home folder."""
    try:
        return path.expanduser()
    except RuntimeError:
        return path


def _unfound(robot: Robot) -> Iterator[Flaw]:
    """A flaw for each mesh that is not there, or that the URDF may not open."""
    surroundings = robot.surroundings
    for address in robot.description.meshes:
        found = surroundings.find(address)
        if found.path is None:
            shown = address if len(address) <= 80 else address[:77] + "..."
            what = "not opened" if found.refused else "not found"
            yield Flaw(
                f"mesh {shown!r}",
                f"{what}: {found.why}; kinematics works without it",
                code=found.code,
                common=f"{what}; kinematics works without it",
                mend=found.mend,
                mesh=address,
            )
