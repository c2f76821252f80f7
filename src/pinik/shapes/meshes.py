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
from ..description.packages import Found, Surroundings
from ..description.xml import Element, parse
from ..errors import InputError
from ..model.robot_model import RobotModel
from . import triangles
from .mesh_checks import MeshError
from .triangles import Color

__all__ = ["Color", "Shape", "load_shapes"]

MOST_TRIANGLES = 20_000_000  # of all mesh files of a robot, each counted as often as it is used
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
    robot_or_urdf: RobotModel | str | os.PathLike[str], package_dirs: Iterable[str | os.PathLike[str]] = ()
) -> tuple[list[Shape], list[Flaw]]:
    """Read the visual shapes of a robot.

    Args:
        robot_or_urdf: A robot, a path to a .urdf file, or URDF text.
        package_dirs: Folders to search first for `package://` addresses; the robot's own come next.

    Returns:
        The shapes in the order of the file, and one warning for each shape that could not be read.

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
    elif isinstance(robot_or_urdf, (str, os.PathLike)):
        description, allow_outside = urdf.read(robot_or_urdf), False
    else:
        raise InputError(f"robot_or_urdf must be a robot, a path or URDF text; got {robot_or_urdf!r}")
    robot = parse(description.document, None if description.path else "utf-8")
    named = {
        material.attributes.get("name", ""): color
        for material in robot.walk()
        if material.tag == "material" and (color := _material_color(material)) is not None
    }
    shapes: list[Shape] = []
    warnings: list[Flaw] = []
    files = _MeshFiles(Surroundings(description.path, folders, allow_outside))
    for link in robot.named("link"):
        link_name = link.attributes["name"]
        for index, visual in enumerate(link.named("visual")):
            try:
                placement, given = _origin(visual), _visual_color(visual, named)
                parts = _parts(visual, files)
            except Exception as fault:  # a shape never stops kinematics, and trimesh may raise anything
                warnings.append(_flaw(f"link {link_name!r}", visual.line, fault))
                continue
            for part, (mesh, own) in enumerate(parts):
                name = f"{link_name}/{index}" + (f"/{part}" if len(parts) > 1 else "")
                shapes.append(Shape(link_name, name, placement, mesh, given or own or GREY))
    return shapes, warnings


class _MeshNotFoundError(Exception):
    def __init__(self, address: str, found: Found) -> None:
        self.address = address
        self.found = found
        said = f"the mesh {address!r} is not opened" if found.refused else f"there is no mesh {address!r}"
        super().__init__(said if found.why == "there is no such file" else f"{said}: {found.why}")


class _MeshFiles:
    """The mesh files of one robot: each is read once, and their triangles together are bounded."""

    def __init__(self, surroundings: Surroundings) -> None:
        self._surroundings = surroundings
        self._read: dict[str, list[triangles.Part] | Exception] = {}
        self._left = MOST_TRIANGLES

    def parts(self, address: str, scale: NDArray[np.float64]) -> list[triangles.Part]:
        """The meshes in a file, scaled.

        Raises:
            MeshError: It cannot be used, or there would be too many triangles.
            _MeshNotFoundError: There is no such file, or the URDF may not open it.
        """
        if address not in self._read:
            try:
                self._read[address] = self._new(address)
            except (MeshError, _MeshNotFoundError) as fault:
                self._read[address] = fault
        parts = self._read[address]
        if isinstance(parts, Exception):
            raise parts
        self._left -= sum(len(mesh.faces) for mesh, _ in parts)
        if self._left < 0:
            raise MeshError(f"all meshes together have more than {MOST_TRIANGLES:,} triangles", "mesh-too-large")
        return [(triangles.scaled(mesh, scale), color) for mesh, color in parts]

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
    code = fault.code if isinstance(fault, MeshError) else "unreadable-shape"
    return Flaw(element, cause, code=code, line=line)


def _child(element: Element, tag: str) -> Element | None:
    return next(iter(element.named(tag)), None)


def _numbers(text: str) -> NDArray[np.float64]:
    return np.array([float(word) for word in text.split()])


def _origin(visual: Element) -> NDArray[np.float64]:
    origin = _child(visual, "origin")
    if origin is None:
        return np.eye(4)
    placement = np.eye(4)
    placement[:3, :3] = pinocchio.rpy.rpyToMatrix(_numbers(origin.attributes.get("rpy", "0 0 0")))
    placement[:3, 3] = _numbers(origin.attributes.get("xyz", "0 0 0"))
    return placement


def _material_color(material: Element) -> Color | None:
    color = _child(material, "color")
    if color is None or "rgba" not in color.attributes:
        return None
    r, g, b, a = _numbers(color.attributes["rgba"])
    return (float(r), float(g), float(b), float(a))


def _visual_color(visual: Element, named: dict[str, Color]) -> Color | None:
    material = _child(visual, "material")
    if material is None:
        return None
    return _material_color(material) or named.get(material.attributes.get("name", ""))


def _parts(visual: Element, files: _MeshFiles) -> list[triangles.Part]:
    """The meshes of one visual element, each with its own colour if it has one."""
    geometry = _child(visual, "geometry")
    for element in geometry.children if geometry else ():
        given = element.attributes
        match element.tag:
            case "box":
                return [(triangles.box(_numbers(given["size"])), None)]
            case "sphere":
                return [(triangles.sphere(float(given["radius"])), None)]
            case "cylinder" | "capsule":
                make = triangles.cylinder if element.tag == "cylinder" else triangles.capsule
                return [(make(float(given["radius"]), float(given["length"])), None)]
            case "mesh":
                return files.parts(given["filename"], _numbers(given.get("scale", "1 1 1")))
    raise ValueError("it has no geometry of a known kind (box, sphere, cylinder, capsule or mesh)")
