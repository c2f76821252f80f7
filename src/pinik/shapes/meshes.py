"""A robot's visual shapes: the `<visual>` elements of a URDF as coloured triangle meshes.

Importing this module imports trimesh, which takes over a second; import it only where shapes are needed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio
import trimesh
from numpy.typing import NDArray

from ..description import reader as urdf
from ..description.flaw import Flaw
from ..description.materials import Color
from ..description.packages import Found, Surroundings
from ..description.shape_tags import ShapeTag
from ..description.source import RobotSource, is_source
from ..errors import InputError
from ..model.robot_model import RobotModel
from . import triangles
from .mesh_checks import MeshError, UndrawnCode

__all__ = ["Color", "Shape", "load_shapes"]

MOST_TRIANGLES = 20_000_000  # of all shapes of a robot; a mesh file counts as often as it is used
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
    shapes: list[Shape] = []
    meshes = _Meshes(Surroundings(description.path, folders, allow_outside))
    for link in description.link_tags:
        for visual in link.visuals:
            try:
                parts = meshes.of(visual)
            except Exception as fault:  # a shape never stops kinematics, and trimesh may raise anything
                warnings.append(_flaw(f"link {link.name!r}", visual.line, fault))
                continue
            for part, (mesh, own) in enumerate(parts):
                name = f"{link.name}/{visual.index}" + (f"/{part}" if len(parts) > 1 else "")
                shapes.append(Shape(link.name, name, _placement(visual), mesh, visual.color or own or GREY))
    return shapes, [flaw.of_expansion() for flaw in warnings] if description.expanded else warnings


class _MeshNotFoundError(Exception):
    def __init__(self, address: str, found: Found) -> None:
        self.address = address
        self.found = found
        said = f"the mesh {address!r} is not opened" if found.refused else f"there is no mesh {address!r}"
        super().__init__(said if found.why == "there is no such file" else f"{said}: {found.why}")


class _Meshes:
    """The meshes of one robot's shapes: each file is read once, and their triangles together are bounded."""

    def __init__(self, surroundings: Surroundings) -> None:
        self._surroundings = surroundings
        self._read: dict[str, list[triangles.Part] | Exception] = {}
        self._left = MOST_TRIANGLES

    def of(self, visual: ShapeTag) -> list[triangles.Part]:
        """The meshes of one visual shape, each with its own colour if it has one.

        Raises:
            MeshError: It cannot be used, or there would be too many triangles.
            _MeshNotFoundError: There is no such file, or the URDF may not open it.
        """
        match visual.kind, visual.size:
            case "box", size:
                mesh = triangles.box(np.array(size))
            case "sphere", (radius,):
                mesh = triangles.sphere(radius)
            case "cylinder", (radius, length):
                mesh = triangles.cylinder(radius, length)
            case "capsule", (radius, length):
                mesh = triangles.capsule(radius, length)
            case _:
                return [(triangles.scaled(mesh, np.array(visual.size)), c) for mesh, c in self._file(visual.filename)]
        self._count([mesh])
        return [(mesh, None)]

    def _file(self, address: str) -> list[triangles.Part]:
        if address not in self._read:
            try:
                self._read[address] = self._new(address)
            except (MeshError, _MeshNotFoundError) as fault:
                self._read[address] = fault
        parts = self._read[address]
        if isinstance(parts, Exception):
            raise parts
        self._count(mesh for mesh, _ in parts)
        return parts

    def _count(self, meshes: Iterable[trimesh.Trimesh]) -> None:
        """Count the triangles of a shape, unless there are too many."""
        count = sum(len(mesh.faces) for mesh in meshes)
        if count > self._left:
            raise MeshError(f"all shapes together have more than {MOST_TRIANGLES:,} triangles", "mesh-too-large")
        self._left -= count

    def _new(self, address: str) -> list[triangles.Part]:
        found = self._surroundings.find(address)
        if found.path is None:
            raise _MeshNotFoundError(address, found)
        try:
            return triangles.read_file(found.path)
        except MeshError as fault:
            raise MeshError(f"{found.path.name!r}: {fault}", fault.code) from None


def _flaw(element: str, line: int, fault: Exception) -> Flaw:
    """A flaw of a shape that is left out."""
    cause = f"a shape is left out: {fault}"
    if isinstance(fault, _MeshNotFoundError):
        found = fault.found
        return Flaw(element, cause, code=found.code, line=line, mend=found.mend, mesh=fault.address)
    code: UndrawnCode = fault.code if isinstance(fault, MeshError) else "unreadable-shape"
    return Flaw(element, cause, code=code, line=line)


def _placement(visual: ShapeTag) -> NDArray[np.float64]:
    placement = np.eye(4)
    placement[:3, :3] = pinocchio.rpy.rpyToMatrix(np.array(visual.rpy))
    placement[:3, 3] = visual.xyz
    return placement
