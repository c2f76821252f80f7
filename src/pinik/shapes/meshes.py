"""A robot's shapes, for whoever draws it: the visual elements of a URDF as coloured triangle meshes.

Importing this module imports trimesh (over a second); import it only where shapes are wanted.
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
from ..description.packages import resolve
from ..description.xml import Element, parse
from ..errors import Flaw, InputError
from ..model.robot_model import Robot

__all__ = ["Color", "Shape", "load_shapes"]

Color = tuple[float, float, float, float]
Part = tuple[trimesh.Trimesh, Color | None]

GREY: Color = (0.7, 0.7, 0.7, 1.0)
CREASE = np.deg2rad(40.0)  # sharper edges stay edges when a mesh brings no normals


@dataclass(frozen=True)
class Shape:
    """One mesh in one colour, fixed to a link.

    Attributes:
        link: The link that carries it.
        name: Unique in the robot.
        placement: Pose (4, 4) in the link's frame [m].
        mesh: Vertices [m], faces and vertex normals, scale applied; vertices are split where the surface has an edge.
        color: Red, green, blue, opacity, each in 0..1.
    """

    link: str
    name: str
    placement: NDArray[np.float64]
    mesh: trimesh.Trimesh
    color: Color


def load_shapes(
    robot_or_urdf: Robot | str | os.PathLike[str], package_dirs: Iterable[str | os.PathLike[str]] = ()
) -> tuple[list[Shape], list[Flaw]]:
    """Read the visual shapes of a robot.

    Args:
        robot_or_urdf: What `pinik.load` returned, a path to a .urdf, or URDF text.
        package_dirs: Folders in which `package://` addresses are looked up first; before the robot's own.

    Returns:
        The shapes, in the order of the file, and a sentence about each one that could not be read.

    Raises:
        RobotLoadError: There is no such file, it is no URDF, or something in it is wrong.
        InputError: Something that is none of these, or one folder for a list.
    """
    if isinstance(package_dirs, (str, os.PathLike)) or not isinstance(package_dirs, Iterable):
        raise InputError(f"package_dirs takes a list of folders; got {package_dirs!r}")
    folders = [Path(folder) for folder in package_dirs]
    if isinstance(robot_or_urdf, Robot):
        description = robot_or_urdf.description
        folders.extend(robot_or_urdf.package_dirs)
    elif isinstance(robot_or_urdf, (str, os.PathLike)):
        description = urdf.read(robot_or_urdf)
    else:
        raise InputError(f"shapes belong to a Robot, a path or URDF text; got {robot_or_urdf!r}")
    robot = parse(description.document, None if description.path else "utf-8")
    named = {
        material.attributes.get("name", ""): color
        for material in robot.walk()
        if material.tag == "material" and (color := _material_color(material)) is not None
    }
    shapes: list[Shape] = []
    warnings: list[Flaw] = []
    files: dict[str, list[Part]] = {}
    for link in robot.named("link"):
        link_name = link.attributes["name"]
        for index, visual in enumerate(link.named("visual")):
            try:
                placement, given = _origin(visual), _visual_color(visual, named)
                parts = _parts(visual, description.path, folders, files)
            except Exception as fault:  # a shape is never worth an error, whatever its file makes trimesh raise
                missing = fault.address if isinstance(fault, _MeshNotFoundError) else None
                warnings.append(Flaw(f"link {link_name!r}", f"a shape is left out: {fault}", mesh=missing))
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
    files: dict[str, list[Part]],
) -> list[Part]:
    """The meshes of one visual element, each with its own colour if it has one."""
    geometry = _child(visual, "geometry")
    for element in geometry.children if geometry else ():
        given = element.attributes
        match element.tag:
            case "box":
                return [(_creased(trimesh.creation.box(_numbers(given["size"]))), None)]
            case "sphere":
                return [(trimesh.creation.icosphere(3, float(given["radius"])), None)]
            case "cylinder" | "capsule":
                radius, length = float(given["radius"]), float(given["length"])
                make = trimesh.creation.cylinder if element.tag == "cylinder" else _capsule
                return [(_creased(make(radius, length)), None)]
            case "mesh":
                address = given["filename"]
                if address not in files:
                    files[address] = _load_file(address, urdf_path, package_dirs)
                scale = _numbers(given.get("scale", "1 1 1"))
                return [(_scaled(mesh, scale), color) for mesh, color in files[address]]
    raise ValueError("it has no geometry that is known here (box, sphere, cylinder, capsule, mesh)")


def _capsule(radius: float, length: float) -> trimesh.Trimesh:
    """A capsule about the origin; as for URDF's cylinder, `length` leaves out the caps."""
    return trimesh.creation.capsule(length, radius)


def _scaled(mesh: trimesh.Trimesh, scale: NDArray[np.float64]) -> trimesh.Trimesh:
    if np.array_equal(scale, np.ones(3)):
        return mesh
    scaled = mesh.copy()
    scaled.apply_transform(np.diag([*np.broadcast_to(scale, 3), 1.0]))
    return scaled


def _load_file(address: str, urdf_path: Path | None, package_dirs: Sequence[Path]) -> list[Part]:
    """A mesh file as one mesh for each colour in it, in its own frame [m]."""
    path = resolve(address, urdf_path=urdf_path, package_dirs=package_dirs)
    if path is None:
        raise _MeshNotFoundError(address)
    scene = trimesh.load_scene(path)
    by_color: dict[Color | None, list[trimesh.Trimesh]] = {}
    for mesh in scene.dump():
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            # COLLADA names its unit; an STL or OBJ is taken as it is.
            in_metres = trimesh.units.unit_conversion(mesh.units or "meters", "meters")
            mesh.apply_transform(np.diag([in_metres, in_metres, in_metres, 1.0]))
            by_color.setdefault(_own_color(mesh), []).append(mesh)
    if not by_color:
        raise ValueError(f"'{address}' holds no triangles")
    keep = _brings_normals(path)
    return [(_joined(meshes, keep_normals=keep), color) for color, meshes in by_color.items()]


def _own_color(mesh: trimesh.Trimesh) -> Color | None:
    """The colour that the mesh's file gives it, if any."""
    visual = mesh.visual
    if isinstance(visual, trimesh.visual.TextureVisuals) and visual.material is not None:
        rgba = np.asarray(visual.material.main_color, dtype=float) / 255.0
    elif isinstance(visual, trimesh.visual.ColorVisuals) and visual.defined:
        rgba = np.asarray(visual.main_color, dtype=float) / 255.0
    else:
        return None
    r, g, b, a = (float(value) for value in rgba)
    return (r, g, b, a)


def _brings_normals(path: Path) -> bool:
    suffix = path.suffix.lower()
    return suffix == ".dae" or (suffix == ".obj" and b"\nvn " in path.read_bytes())


def _joined(meshes: Iterable[trimesh.Trimesh], *, keep_normals: bool) -> trimesh.Trimesh:
    vertices, faces, normals, count = [], [], [], 0
    for mesh in meshes:
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + count)
        normals.append(mesh.vertex_normals)
        count += len(mesh.vertices)
    joined = trimesh.Trimesh(np.vstack(vertices), np.vstack(faces), vertex_normals=np.vstack(normals), process=False)
    if keep_normals and not _is_faceted(joined):
        return joined
    return _creased(trimesh.Trimesh(joined.vertices, joined.faces))


def _is_faceted(mesh: trimesh.Trimesh) -> bool:
    """Whether each face has its own normal at all its corners, as exporters write that know of no smooth ones."""
    along = np.einsum("fkc,fc->fk", mesh.vertex_normals[mesh.faces], mesh.face_normals).min(axis=1)
    has_area = mesh.face_normals.any(axis=1)
    return bool((along[has_area] > 1.0 - 1e-3).all())


def _creased(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh with its vertices split along sharp edges, so that smooth normals leave these sharp."""
    smooth = mesh.face_adjacency[mesh.face_adjacency_angles < CREASE]
    patch = trimesh.graph.connected_component_labels(smooth, len(mesh.faces))  # type: ignore[no-untyped-call]
    patches = int(patch.max()) + 1
    corners = mesh.faces.ravel() * patches + np.repeat(patch, 3)
    kept, faces = np.unique(corners, return_inverse=True)
    return trimesh.Trimesh(mesh.vertices[kept // patches], faces.reshape(-1, 3), process=False)
