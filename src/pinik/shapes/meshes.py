"""A robot's visual shapes: the `<visual>` elements of a URDF as coloured triangle meshes.

Importing this module imports trimesh, which takes over a second; import it only where shapes are needed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio
import trimesh
from numpy.typing import NDArray

from ..description import reader as urdf
from ..description.flaw import Flaw
from ..description.packages import resolve
from ..description.xml import Element, parse
from ..errors import InputError
from ..model.robot_model import RobotModel
from . import triangles
from .triangles import Color

__all__ = ["Color", "Shape", "load_shapes"]

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
    elif isinstance(robot_or_urdf, (str, os.PathLike)):
        description = urdf.read(robot_or_urdf)
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
    files: dict[str, list[triangles.Part]] = {}
    for link in robot.named("link"):
        link_name = link.attributes["name"]
        for index, visual in enumerate(link.named("visual")):
            try:
                placement, given = _origin(visual), _visual_color(visual, named)
                parts = _parts(visual, description.path, folders, files)
            except Exception as fault:  # a shape never stops kinematics, and trimesh may raise anything
                missing = fault.address if isinstance(fault, _MeshNotFoundError) else None
                cause = f"a shape is left out: {fault}"
                code = "unreadable-shape" if missing is None else "missing-mesh"
                warnings.append(Flaw(f"link {link_name!r}", cause, code=code, line=visual.line, mesh=missing))
                continue
            for part, (mesh, own) in enumerate(parts):
                name = f"{link_name}/{index}" + (f"/{part}" if len(parts) > 1 else "")
                shapes.append(Shape(link_name, name, placement, mesh, given or own or GREY))
    return shapes, warnings


class _MeshNotFoundError(Exception):
    def __init__(self, address: str) -> None:
        self.address = address
        super().__init__(f"there is no mesh {address!r}")


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


def _parts(
    visual: Element,
    urdf_path: Path | None,
    package_dirs: Sequence[Path],
    files: dict[str, list[triangles.Part]],
) -> list[triangles.Part]:
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
                address = given["filename"]
                if address not in files:
                    files[address] = _file(address, urdf_path, package_dirs)
                scale = _numbers(given.get("scale", "1 1 1"))
                return [(triangles.scaled(mesh, scale), color) for mesh, color in files[address]]
    raise ValueError("it has no geometry of a known kind (box, sphere, cylinder, capsule or mesh)")


def _file(address: str, urdf_path: Path | None, package_dirs: Sequence[Path]) -> list[triangles.Part]:
    path = resolve(address, urdf_path=urdf_path, package_dirs=package_dirs)
    if path is None:
        raise _MeshNotFoundError(address)
    return triangles.read_file(path)
