"""`load`: makes a robot from a catalogue name, a path, URDF text or bytes, or an open file."""

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
from .description.source import RobotSource, Source, is_document, is_source
from .echoes import bounded
from .errors import InputError, RobotLoadError, UnknownNameError, UrdfWarning
from .robot import Robot

__all__ = ["load", "load_in_silence", "locate", "srdf_of"]

_MOST_LISTED = 12


def load(
    source: RobotSource,
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    strict: bool = False,
    xacro_args: Mapping[str, object] | None = None,
    allow_outside: bool = False,
) -> Robot:
    """Load a robot.

    Args:
        source: A catalogue name ("arm", "lion", "panda", …: `pinik.catalog()`), a path to a URDF or xacro file, URDF
            text, the bytes of a URDF file, an open file, which is read from its current position to its end, or the
            name of a robot in the cache of robot_descriptions ("ur10e_description").
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: Folders that are searched first for `package://` addresses of meshes.
        mimic: Whether mimic joints follow their leaders; with False they are all free.
        strict: Whether every warning is an error, also those of `Robot.poses`.
        xacro_args: The arguments of a xacro file by name, such as {"ur_type": "ur10e"}. xacro evaluates expressions and
            opens other files, so load only xacro files that you trust.
        allow_outside: Whether the URDF may open meshes outside its own folder, its packages and `package_dirs`.

    Raises:
        RobotLoadError: The description is faulty; the message names the element and the cause. With `strict`, also if
            pinik repaired, assumed or ignored something, or did not find a mesh; the message lists what.
        UnknownNameError: There is no robot of that name, or the xacro file has no argument of a given name.
        InputError: The root is unknown, the source is none of these, `package_dirs` is not a list, or `xacro_args` is
            not a dict or is given for a file that is not xacro.
        MissingExtraError: The file is xacro, and xacrodoc is not installed.

    Warns:
        UrdfWarning: pinik repaired, assumed or ignored something, or did not find a mesh; once for each sort of flaw.
    """
    robot = load_in_silence(
        source,
        root=root,
        package_dirs=package_dirs,
        mimic=mimic,
        strict=strict,
        xacro_args=xacro_args,
        allow_outside=allow_outside,
    )
    for words in summarised(robot.warnings):
        warnings.warn(bounded(f"{robot.name}: {words}"), UrdfWarning, stacklevel=2)
    return robot


def load_in_silence(
    source: RobotSource,
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
    strict: bool = False,
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
    description = fetch(located, package_dirs=homes, xacro_args=xacro_args).read()
    robot = Robot(
        description,
        name=located.name,
        root=root,
        package_dirs=homes,
        mimic=mimic,
        srdf=srdf_of(located, description),
        allow_outside=allow_outside,
        strict=strict,
    )
    robot.warnings += tuple(_unfound(robot))
    if strict and robot.warnings:
        raise RobotLoadError(_listed(robot.warnings), source=description.source)
    return robot


def _listed(flaws: Sequence[str]) -> str:
    """All warnings in one message, with one for each sort."""
    sorts = summarised(flaws)
    more = f"; and {len(sorts) - _MOST_LISTED} other sorts" if len(sorts) > _MOST_LISTED else ""
    count = "one warning is an error" if len(flaws) == 1 else f"each of {len(flaws)} warnings is an error"
    return f"with strict=True, {count}: {'; '.join(sorts[:_MOST_LISTED])}{more}"


def srdf_of(located: Located, description: urdf.Description) -> Path | None:
    """The SRDF file that the catalogue has, else the one of the same name in the same folder, if there is one."""
    if located.srdf is not None:
        return located.srdf
    path = description.path
    srdf = path.with_suffix(".srdf") if path and path.name else None
    return srdf if srdf and os.path.isfile(srdf) else None


@dataclass(frozen=True)
class Located:
    """Where a robot's description is.

    Attributes:
        source: Its path, its text or bytes, or an open file.
        name: Its name in the catalogue or in robot_descriptions; None for all others.
        srdf: Its SRDF file, if the catalogue or robot_descriptions has one.
        package_dirs: Folders of its packages.
        xacro_args: Arguments of its xacro file.
    """

    source: RobotSource
    name: str | None = None
    srdf: Path | None = None
    package_dirs: tuple[Path, ...] = ()
    xacro_args: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Fetched:
    """A description that was fetched, and not read yet.

    Attributes:
        source: Where it comes from.
        document: Its bytes; those that xacro made, if it is a xacro file.
        remarks: What xacro warned about; None if it is no xacro file.
    """

    source: Source
    document: bytes = field(repr=False)
    remarks: tuple[str, ...] | None = None

    def read(self) -> urdf.Description:
        """Read and check it; a `RobotLoadError` says why it is not a valid URDF."""
        description = urdf.read_content(self.document, self.source)
        remarks = (Flaw("xacro", remark, code="xacro") for remark in self.remarks or ())
        return replace(description, warnings=(*remarks, *description.warnings))


def fetch(
    located: Located, *, package_dirs: Sequence[Path] = (), xacro_args: Mapping[str, object] | None = None
) -> Fetched:
    """Fetch a description; a xacro file is expanded, if it is given by its path.

    Raises:
        RobotLoadError, UnknownNameError, InputError, MissingExtraError: As for `load`.
    """
    given = xacro.check_arguments(xacro_args)
    source = Source.of(located.source)
    content = source.content()
    path = located.source
    if not (isinstance(path, Path) and xacro.is_xacro(path, content)):
        if given:
            raise InputError(f"are for xacro files, and this is none; got {xacro_args!r}", argument="xacro_args")
        return Fetched(source, content)
    expansion = xacro.expand(path, {**located.xacro_args, **given}, package_dirs)
    return Fetched(replace(source, expanded=True), expansion.document, expansion.remarks)


def locate(source: RobotSource) -> Located:
    """Find a robot's description by its name or path.

    Raises:
        UnknownNameError: There is no robot of that name.
        RobotLoadError: There is no such file, but the catalogue has a robot of that name; or robot_descriptions has the
            robot, but not in its cache.
        InputError: The source is none of these.
    """
    if not is_source(source):
        raise InputError(
            f"a robot must be a catalogue name, a path or URDF text, its bytes, or an open file; got {source!r}"
        )
    if isinstance(source, str):
        if is_document(source):
            return Located(source)
        looks_like_path = os.sep in source or source.endswith((".urdf", ".xml", ".xacro"))
        if not looks_like_path and (source in robot_catalog.catalog() or not os.path.exists(source)):
            return _named(source)
    if not isinstance(source, (str, os.PathLike)):
        return Located(source)
    path = _home_expanded(Path(source))
    if path.stem in robot_catalog.catalog() and not os.path.lexists(path):
        raise RobotLoadError(f"no such file, but the catalogue has a robot {path.stem!r}", source=str(path))
    return Located(path)


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
    description, surroundings = robot.description, robot.surroundings
    shapes = [shape for link in description.link_tags for shape in link.shapes]
    lines = {shape.filename: shape.line for shape in reversed(shapes)}  # of the first shape that has the mesh
    for address in description.meshes:
        found = surroundings.find(address)
        if found.path is None:
            what = "not opened" if found.refused else "not found"
            yield Flaw(
                f"mesh {address!r}",
                f"{what}: {found.why}; kinematics works without it",
                code=found.code,
                line=lines[address],
                expanded=description.expanded,
                common=f"{what}: {found.common}; kinematics works without it",
                mend=found.mend,
                mesh=address,
            )
