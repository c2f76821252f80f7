"""Robots by name: pinik's own, and all robots of example-robot-data."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import UnknownNameError
from ..files import FileError, read_within
from .shares import example_robot_data
from .xml import MAX_BYTES, DocumentError, parse

__all__ = ["CatalogEntry", "catalog", "find"]

# Files whose folder and stem differ from the usual name of the robot.
SHORT_NAMES = {
    "g1_29dof_rev_1_0": "g1",
    "g1_29dof_with_hand_rev_1_0": "g1_with_hand",
    "talos_full_v2": "talos_full",
    "talos_full_v2_box": "talos_full_box",
    "talos_reduced": "talos",
    "talos_reduced_box": "talos_box",
    "talos_reduced_corrected": "talos_corrected",
    # This file contains no robot; the UR3 is in ur3_robot.urdf, which takes the name.
    "ur3": "ur3_empty",
    "xarm7": "xarm7",
}


@dataclass(frozen=True)
class CatalogEntry:
    """A robot that can be loaded by name.

    Attributes:
        name: Its short name.
        urdf: Its URDF file.
        srdf: The SRDF file with its named poses, if there is one.
    """

    name: str
    urdf: Path
    srdf: Path | None


def catalog() -> list[str]:
    """The names of all robots that can be loaded by name, sorted."""
    return sorted(_urdf_files())


def find(name: str) -> CatalogEntry:
    """The robot of this name.

    Raises:
        UnknownNameError: No such robot; the error lists near names.
    """
    files = _urdf_files()
    if name not in files:
        raise UnknownNameError("robot", name, sorted(files), hint="or give the path of a .urdf file")
    return CatalogEntry(name, files[name], _srdf_of(name, files[name]))


@functools.cache
def _urdf_files() -> Mapping[str, Path]:
    own = {path.stem: path for path in sorted(_own_folder().glob("*.urdf"))}
    return {**_example_files(), **own}


def _own_folder() -> Path:
    """pinik's own urdf folder: in the installed package, or at the root of the checkout."""
    package = Path(__file__).resolve().parents[1]
    installed = package / "urdf"
    return installed if installed.is_dir() else package.parent.parent / "urdf"


def _example_files() -> dict[str, Path]:
    """The URDF files of example-robot-data by short name."""
    robots = example_robot_data()
    paths = sorted(robots.glob("*/*/*.urdf")) if robots else []
    in_folder = Counter(_folder(path) for path in paths)
    of_stem = Counter(path.stem for path in paths)
    files = {}
    for path in paths:
        by_folder = in_folder[_folder(path)] == 1 or of_stem[path.stem] > 1
        files[_short_name(path, by_folder)] = path
    return files


def _short_name(path: Path, by_folder: bool) -> str:
    """The short name of a robot, from its folder if it is alone there, else from its file."""
    if path.stem in SHORT_NAMES:
        return SHORT_NAMES[path.stem]
    if by_folder:
        return _folder(path).name.removesuffix("_description").removesuffix("_simple")
    return path.stem.lower().replace("-", "_").removesuffix("_robot")


def _folder(urdf: Path) -> Path:
    """A robot's folder in example-robot-data; its URDF lies one folder below."""
    return urdf.parent.parent


def _srdf_of(name: str, urdf: Path) -> Path | None:
    """The SRDF next to the URDF or in the neighbouring srdf folder, found by the file's stem, the name, or the family.

    The file of a family, such as "solo.srdf" for solo12.urdf, is taken only if the robot has every joint that its poses
    set.
    """
    folders = (_folder(urdf) / "srdf", urdf.parent)
    files = {path.stem: path for folder in folders for path in sorted(folder.glob("*.srdf"))}
    for stem in (urdf.stem, name):
        if stem in files:
            return files[stem]
    families = sorted((stem for stem in files if urdf.stem.startswith(stem)), key=len, reverse=True)
    return next((files[stem] for stem in families if _poses_fit(files[stem], urdf)), None)


def _poses_fit(srdf: Path, urdf: Path) -> bool:
    try:
        states = parse(read_within(srdf, MAX_BYTES, "an SRDF file")).named("group_state")
        joints = parse(read_within(urdf, MAX_BYTES, "a URDF file")).named("joint")
    except (FileError, DocumentError):
        return False
    posed = {joint.attributes.get("name") for state in states for joint in state.named("joint")}
    return posed <= {"root_joint", *(joint.attributes.get("name") for joint in joints)}
