"""A robot's visual shapes: the `<visual>` elements of a URDF as coloured triangle meshes.

Importing this module imports trimesh, which takes over a second; import it only where shapes are needed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from ..description import reader as urdf
from ..description.flaw import Flaw
from ..description.materials import Color
from ..description.packages import Surroundings
from ..description.shape_tags import ShapeTag
from ..description.source import RobotSource, is_source
from ..errors import InputError
from ..model.robot_model import RobotModel
from . import triangles
from .mesh_files import MeshFiles, flaw_of, placement_of

__all__ = ["Color", "Shape", "load_collision_shapes", "load_shapes"]

GREY: Color = (0.7, 0.7, 0.7, 1.0)


@dataclass(frozen=True)
class Shape:
    """A mesh of one colour, fixed to a link.

    Attributes:
        link: The link to which it is fixed.
        name: A name that is unique in the robot.
        placement: Placement (4, 4) in the link's frame [m].
        mesh: Scaled vertices [m], faces and vertex normals; vertices are split along sharp edges.
        color: Red, green, blue, opacity, each in 0..1.
    """

    link: str
    name: str
    placement: NDArray[np.float64]
    mesh: trimesh.Trimesh
    color: Color


def load_shapes(
    robot_or_urdf: RobotModel | RobotSource, package_dirs: Iterable[str | os.PathLike[str]] = ()
) -> tuple[list[Shape], list[Flaw]]:
    """Read the visual shapes of a robot.

    Args:
        robot_or_urdf: A robot, a path to a .urdf file, URDF text or bytes, or an open file.
        package_dirs: Folders to search first for `package://` addresses; the robot's own come next.

    Returns:
        The shapes in the order of the file, and one warning for each shape that could not be read. For a robot, the
        shapes that its description left out are among the robot's own warnings instead.

    Raises:
        RobotLoadError: The file cannot be read, or is not a valid URDF.
        InputError: An argument of another kind, or a single folder instead of a list.
    """
    if isinstance(package_dirs, (str, os.PathLike)) or not isinstance(package_dirs, Iterable):
        raise InputError(f"package_dirs must be a list of folders; got {package_dirs!r}")
    folders = [Path(folder) for folder in package_dirs]
    if isinstance(robot_or_urdf, RobotModel):
        description = robot_or_urdf.description
        folders.extend(robot_or_urdf.package_dirs)
        allow_outside = robot_or_urdf.allow_outside
    elif is_source(robot_or_urdf):
        description, allow_outside = urdf.read(robot_or_urdf), False
    else:
        raise InputError(
            f"robot_or_urdf must be a robot, a path or URDF text, its bytes, or an open file; got {robot_or_urdf!r}"
        )
    known = isinstance(robot_or_urdf, RobotModel)
    warnings = [] if known else [flaw for flaw in description.warnings if flaw.code == "dropped-shape"]
    tags = [(link.name, visual) for link in description.link_tags for visual in link.visuals]
    shapes, faults = _read(tags, MeshFiles(Surroundings(description.path, folders, allow_outside)))
    warnings += faults
    return shapes, [flaw.of_expansion() for flaw in warnings] if description.expanded else warnings


def load_collision_shapes(robot: RobotModel) -> tuple[list[Shape], list[Flaw]]:
    """Read the collision shapes of a robot: in the order of the file, and one warning for each that cannot be read."""
    tags = [(link.name, tag) for link in robot.description.link_tags for tag in link.collisions]
    shapes, warnings = _read(tags, MeshFiles(robot.surroundings))
    return shapes, [flaw.of_expansion() for flaw in warnings] if robot.description.expanded else warnings


def _read(tags: Iterable[tuple[str, ShapeTag]], files: MeshFiles) -> tuple[list[Shape], list[Flaw]]:
    """Read shapes, each given with the name of its link."""
    shapes: list[Shape] = []
    warnings = []
    for link, tag in tags:
        try:
            parts = _parts(tag, files)
        except Exception as fault:  # a shape never stops kinematics, and trimesh may raise anything
            warnings.append(flaw_of(f"link {link!r}", tag.line, fault))
            continue
        for part, (mesh, own) in enumerate(parts):
            name = f"{link}/{tag.index}" + (f"/{part}" if len(parts) > 1 else "")
            shapes.append(Shape(link, name, placement_of(tag), mesh, tag.color or own or GREY))
    return shapes, warnings


def _parts(tag: ShapeTag, files: MeshFiles) -> list[triangles.Part]:
    """The meshes of one shape, each with its own colour if it has one."""
    match tag.kind, tag.size:
        case "box", size:
            mesh = triangles.box(np.array(size))
        case "sphere", (radius,):
            mesh = triangles.sphere(radius)
        case "cylinder", (radius, length):
            mesh = triangles.cylinder(radius, length)
        case "capsule", (radius, length):
            mesh = triangles.capsule(radius, length)
        case _:
            return files.parts(tag.filename, np.array(tag.size))
    files.count([mesh])
    return [(mesh, None)]
