"""Inspect a URDF file with pinik's own reader, with Pinocchio, with trimesh (its meshes) and with yourdfpy."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...description.flaw import Flaw
from ...errors import RobotLoadError, UnknownNameError
from ...extras import needed_by
from ...loading import Located, describe, locate
from ...robot import Robot

if TYPE_CHECKING:
    from ...shapes.second_opinion import SecondOpinion

__all__ = ["Fault", "Inspection", "inspect"]


@dataclass(frozen=True)
class Fault:
    """Why a file cannot be loaded.

    Attributes:
        element: The faulty element, such as "joint 'elbow'"; None if the whole file is at fault.
        message: The cause.
    """

    element: str | None
    message: str


@dataclass(frozen=True)
class Inspection:
    """The result of an inspection; the counts are 0 if the file cannot be loaded.

    Attributes:
        file: The file.
        robot: The robot's name; None if the file cannot be loaded.
        faults: Why the file cannot be loaded.
        warnings: What pinik repaired or ignored.
        missing_meshes: The addresses of meshes that were not found.
        mesh_faults: A sentence about each shape that cannot be drawn for another reason.
        links, joints, meshes, shapes: Their numbers; only joints that move, and each mesh address once.
        second_opinion: What yourdfpy says; None if the file cannot be loaded.
    """

    file: str
    robot: str | None = None
    faults: tuple[Fault, ...] = ()
    warnings: tuple[str, ...] = ()
    missing_meshes: tuple[str, ...] = ()
    mesh_faults: tuple[str, ...] = ()
    links: int = 0
    joints: int = 0
    meshes: int = 0
    shapes: int = 0
    second_opinion: SecondOpinion | None = None

    @property
    def loads(self) -> bool:
        """Whether the robot can be loaded."""
        return not self.faults

    def to_dict(self) -> dict[str, Any]:
        """The JSON form; docs/json.md explains the fields."""
        opinion = None if self.second_opinion is None else self.second_opinion.to_dict()
        return {"schema": 1, "loads": self.loads, **asdict(self), "second_opinion": opinion}


def inspect(
    source: str,
    package_dirs: Sequence[Path],
    xacro_args: Mapping[str, str] | None = None,
    allow_outside: bool = False,
) -> Inspection:
    """Read a file and everything that it refers to.

    Args:
        source: A file, or the name of a robot in the catalogue.
        package_dirs: Folders that are searched first for packages.
        xacro_args: The arguments of a xacro file.
        allow_outside: Whether meshes may lie outside the folders that belong to the robot.
    """
    try:
        located = _located(source)
        folders = (*(folder.expanduser() for folder in package_dirs), *located.package_dirs)
        description = describe(located, package_dirs=folders, xacro_args=xacro_args)
        robot = Robot(description, package_dirs=folders, allow_outside=allow_outside)
    except RobotLoadError as error:
        return Inspection(error.source, faults=(Fault(error.element, error.cause),))
    surroundings = robot.surroundings
    missing = tuple(address for address in description.meshes if surroundings.find(address).path is None)
    shapes, flaws = _shapes(robot)
    return Inspection(
        file=str(located.source),
        robot=robot.name,
        warnings=tuple(dict.fromkeys(robot.warnings)),
        missing_meshes=missing,
        mesh_faults=tuple(flaw for flaw in flaws if flaw.mesh is None),
        links=len(description.links),
        joints=len(robot.joints),
        meshes=len(description.meshes),
        shapes=shapes,
        second_opinion=_second_opinion(robot),
    )


def _located(source: str) -> Located:
    try:
        located = locate(source)
    except UnknownNameError:
        located = Located(Path(source))
    return located if isinstance(located.source, Path) else Located(Path(source))


def _shapes(robot: Robot) -> tuple[int, list[Flaw]]:
    """The number of shapes that can be drawn, and a sentence about each one that cannot."""
    with needed_by("pinik check", "check"):
        from ...shapes.meshes import load_shapes

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # from the mesh readers; the flaws say what cannot be read
        logging.disable()
        try:
            shapes, flaws = load_shapes(robot)
        finally:
            logging.disable(logging.NOTSET)
    return len(shapes), flaws


def _second_opinion(robot: Robot) -> SecondOpinion:
    with needed_by("pinik check", "check"):
        from ...shapes.second_opinion import ask_yourdfpy

    return ask_yourdfpy(robot, robot.description.document)
