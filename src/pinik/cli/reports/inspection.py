"""Inspect a URDF file with pinik's own reader, with Pinocchio, with trimesh (its meshes) and with yourdfpy."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...description import packages
from ...description import reader as urdf
from ...description.flaw import Flaw
from ...errors import RobotLoadError, UnknownNameError
from ...extras import needed_by
from ...loading import locate
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


def inspect(source: str, package_dirs: Sequence[Path]) -> Inspection:
    """Read a file and everything that it refers to.

    Args:
        source: A file, or the name of a robot in the catalogue.
        package_dirs: Folders that are searched first for packages.
    """
    package_dirs = tuple(folder.expanduser() for folder in package_dirs)
    try:
        path = _path(source)
        description = urdf.read(path)
        robot = Robot(description, package_dirs=package_dirs)
    except RobotLoadError as error:
        return Inspection(error.source, faults=(Fault(error.element, error.cause),))
    missing = tuple(
        address
        for address in description.meshes
        if packages.resolve(address, urdf_path=description.path, package_dirs=package_dirs) is None
    )
    shapes, flaws = _shapes(robot)
    return Inspection(
        file=str(path),
        robot=robot.name,
        warnings=tuple(dict.fromkeys(robot.warnings)),
        missing_meshes=missing,
        mesh_faults=tuple(flaw for flaw in flaws if flaw.mesh is None),
        links=len(description.links),
        joints=len(robot.joints),
        meshes=len(description.meshes),
        shapes=shapes,
        second_opinion=_second_opinion(robot, path),
    )


def _path(source: str) -> Path:
    try:
        _, _, path = locate(source)
    except UnknownNameError:
        path = source
    return Path(path)


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


def _second_opinion(robot: Robot, path: Path) -> SecondOpinion:
    with needed_by("pinik check", "check"):
        from ...shapes.second_opinion import ask_yourdfpy

    return ask_yourdfpy(robot, path)
