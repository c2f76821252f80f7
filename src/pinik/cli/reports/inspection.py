"""Look into a URDF file: by pinik's own reader, by Pinocchio, by trimesh at its meshes, and by yourdfpy."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...description import packages
from ...description import reader as urdf
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
        element: The faulty element, such as "joint 'elbow'"; None where the whole file is at fault.
        message: The cause.
    """

    element: str | None
    message: str


@dataclass(frozen=True)
class Inspection:
    """What was found; the counts are 0 where the file cannot be loaded.

    Attributes:
        file: The file.
        robot: The robot's name; None where the file cannot be loaded.
        faults: Why it cannot be loaded.
        warnings: What was mended or left out.
        missing_meshes: Addresses of meshes that were not found.
        mesh_faults: A sentence about each other shape that cannot be drawn.
        links, joints, meshes, shapes: How many there are; joints that move, meshes with different addresses.
        second_opinion: What yourdfpy says; None where the file cannot be loaded.
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
        package_dirs: Where packages are looked for first.
    """
    package_dirs = tuple(folder.expanduser() for folder in package_dirs)
    try:
        path = _path(source)
        description = urdf.read(path)
        robot = Robot(description, package_dirs=package_dirs)
    except RobotLoadError as error:
        return Inspection(error.source, faults=(_fault(error),))
    missing = tuple(
        address
        for address in description.meshes
        if packages.resolve(address, urdf_path=description.path, package_dirs=package_dirs) is None
    )
    shapes, words = _shapes(robot)
    return Inspection(
        file=str(path),
        robot=robot.name,
        warnings=tuple(dict.fromkeys(robot.warnings)),
        missing_meshes=missing,
        mesh_faults=tuple(said for said in words if not any(address in said for address in missing)),
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


def _fault(error: RobotLoadError) -> Fault:
    message = str(error).removeprefix(f"{error.source}: ")
    if error.element:
        message = message.removeprefix(f"{error.element}: ")
    return Fault(error.element, message)


def _shapes(robot: Robot) -> tuple[int, list[str]]:
    """How many shapes can be drawn, and a sentence about each one that cannot."""
    with needed_by("pinik check", "check"):
        from ...shapes.meshes import load_shapes

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the mesh readers; what cannot be read is in the sentences
        logging.disable()
        try:
            shapes, words = load_shapes(robot)
        finally:
            logging.disable(logging.NOTSET)
    return len(shapes), words


def _second_opinion(robot: Robot, path: Path) -> SecondOpinion:
    with needed_by("pinik check", "check"):
        from ...shapes.second_opinion import ask_yourdfpy

    return ask_yourdfpy(robot, path)
