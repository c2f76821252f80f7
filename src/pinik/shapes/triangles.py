"""Triangle meshes: boxes, spheres, cylinders, capsules, and those in files, with edges that stay sharp."""

from __future__ import annotations

import functools
import io
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from trimesh.exchange.load import mesh_loaders

from ..description.materials import Color
from ..echoes import shortened
from ..files import FileError, read_within
from .mesh_checks import MOST_BYTES, NOT_FINITE, MeshError, checked
from .neighbours import Neighbours
from .quiet import quiet

__all__ = ["Part", "box", "capsule", "creased", "cylinder", "read_file", "scaled", "sphere"]

Part = tuple[trimesh.Trimesh, Color | None]
"""A mesh, and its own colour if it has one."""

MOST_TRIANGLES = 5_000_000  # of one file
CREASE = np.deg2rad(40.0)  # edges sharper than this stay sharp when a mesh brings no normals


def box(size: NDArray[np.float64]) -> trimesh.Trimesh:
    """A box about the origin with these edges (3,) [m]."""
    return _stretched(_unit_box(), size)


def sphere(radius: float) -> trimesh.Trimesh:
    """A sphere about the origin [m]."""
    return _stretched(_unit_sphere(), np.full(3, radius))


def cylinder(radius: float, length: float) -> trimesh.Trimesh:
    """A cylinder about the origin, along z [m]."""
    return _stretched(_unit_cylinder(), np.array([radius, radius, length]))


def capsule(radius: float, length: float) -> trimesh.Trimesh:
    """A capsule about the origin, along z [m]; as in URDF's cylinder, `length` does not include the caps."""
    unit = _unit_capsule()
    end = np.sign(unit.vertices[:, 2:]) * (0.0, 0.0, 1.0)  # of the axis, which is where the caps have their centres
    return trimesh.Trimesh(radius * (unit.vertices - end) + 0.5 * length * end, unit.faces.copy(), process=False)


def scaled(mesh: trimesh.Trimesh, scale: NDArray[np.float64]) -> trimesh.Trimesh:
    """The mesh, scaled along each axis (3,); the same object where the scale is 1."""
    if np.array_equal(scale, np.ones(3)):
        return mesh
    copy = mesh.copy()
    copy.apply_transform(np.diag([*np.broadcast_to(scale, 3), 1.0]))
    return copy


def creased(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh with vertices split along sharp edges, so that these stay sharp under smooth shading."""
    smooth = mesh.face_adjacency[mesh.face_adjacency_angles < CREASE]
    patch = trimesh.graph.connected_component_labels(smooth, len(mesh.faces))  # type: ignore[no-untyped-call]
    patches = int(patch.max()) + 1
    corners = mesh.faces.ravel() * patches + np.repeat(patch, 3)
    kept, faces = np.unique(corners, return_inverse=True)
    return trimesh.Trimesh(mesh.vertices[kept // patches], faces.reshape(-1, 3), process=False)


@functools.cache
def _unit_box() -> trimesh.Trimesh:
    return creased(trimesh.creation.box(np.ones(3)))


@functools.cache
def _unit_sphere() -> trimesh.Trimesh:
    mesh: trimesh.Trimesh = trimesh.creation.icosphere(3, 1.0)
    return mesh


@functools.cache
def _unit_cylinder() -> trimesh.Trimesh:
    return creased(trimesh.creation.cylinder(1.0, 1.0))


@functools.cache
def _unit_capsule() -> trimesh.Trimesh:
    """A capsule of radius 1 and length 2."""
    return creased(trimesh.creation.capsule(2.0, 1.0, count=(16, 32)))


def _stretched(unit: trimesh.Trimesh, along: NDArray[np.float64]) -> trimesh.Trimesh:
    """A new mesh with the faces of another one; making thousands of shapes anew would take seconds."""
    return trimesh.Trimesh(unit.vertices * along, unit.faces.copy(), process=False)


def read_file(path: Path) -> list[Part]:
    """Read a mesh file: one mesh for each colour in it, in the file's own frame [m].

    The unit that a COLLADA file names counts. Its `<up_axis>` does not: RViz, Gazebo and MoveIt ignore it, and so the
    robots' own files are made.

    Raises:
        MeshError: The file cannot be read, it is no mesh, or its triangles are too many or not finite.
    """
    kind = path.suffix.lower().removeprefix(".")
    try:
        data = checked(read_within(path, MOST_BYTES, "a mesh file"), kind)
    except FileError as fault:
        raise MeshError(str(fault)) from None
    by_color: dict[Color | None, list[trimesh.Trimesh]] = {}
    for mesh in _meshes(data, kind, Neighbours(path)):
        by_color.setdefault(_own_color(mesh), []).append(mesh)
    keep = kind == "dae" or (kind == "obj" and b"\nvn " in data)
    return [(_joined(meshes, keep_normals=keep), color) for color, meshes in by_color.items()]


def _meshes(data: bytes, kind: str, neighbours: Neighbours) -> list[trimesh.Trimesh]:
    """The meshes of a file with their triangles where the file's scene has them [m]."""
    # The only material of a PLY file is a texture.
    materials: dict[str, Any] = {"skip_materials": True} if kind == "ply" else {}
    reader: Any = mesh_loaders[kind]
    try:
        with quiet(trimesh.util.log):
            read = reader(file_obj=io.BytesIO(data), file_type=kind, resolver=neighbours, **materials)
            for arrays in read.get("geometry", {"": read}).values():
                # First, because trimesh drops what is not finite.
                _check_finite(arrays.get("vertices", ()), arrays.get("faces", ()))
            scene = trimesh.load_scene(read)
            _check_size(scene)
            meshes = [mesh for mesh in scene.dump() if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces)]
    except MeshError:
        raise
    except Exception as fault:  # trimesh and its readers raise anything
        words = shortened(" ".join(str(fault).split()), 200)
        raise MeshError(f"it cannot be read as .{kind}: {words or type(fault).__name__}") from None
    if not meshes:
        raise MeshError("it holds no triangles", "empty-mesh")
    for mesh in meshes:
        in_metres = trimesh.units.unit_conversion(mesh.units or "meters", "meters")
        with np.errstate(all="ignore"):
            mesh.apply_transform(np.diag([in_metres, in_metres, in_metres, 1.0]))
        _check_finite(mesh.vertices, mesh.faces)
    return meshes


def _check_finite(vertices: ArrayLike, faces: ArrayLike) -> None:
    corners = np.asarray(vertices, dtype=float)[np.asarray(faces, dtype=np.int64).ravel()]
    if not np.isfinite(corners).all():
        raise MeshError(NOT_FINITE, "nan-in-mesh")


def _check_size(scene: trimesh.Scene) -> None:
    """Count the triangles of a scene before its shapes are copied to each of their places."""
    counts = {name: len(getattr(mesh, "faces", ())) for name, mesh in scene.geometry.items()}
    count = sum(counts[scene.graph[node][1]] for node in scene.graph.nodes_geometry)
    if count > MOST_TRIANGLES:
        raise MeshError(f"it has {count:,} triangles, and pinik draws at most {MOST_TRIANGLES:,}", "mesh-too-large")


def _own_color(mesh: trimesh.Trimesh) -> Color | None:
    """The colour that its file gives the mesh, if any."""
    visual = mesh.visual
    if isinstance(visual, trimesh.visual.TextureVisuals) and visual.material is not None:
        rgba = np.asarray(visual.material.main_color, dtype=float) / 255.0
    elif isinstance(visual, trimesh.visual.ColorVisuals) and visual.defined:
        rgba = np.asarray(visual.main_color, dtype=float) / 255.0
    else:
        return None
    r, g, b, a = (float(value) for value in rgba)
    return (r, g, b, a)


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
    return creased(trimesh.Trimesh(joined.vertices, joined.faces))


def _is_faceted(mesh: trimesh.Trimesh) -> bool:
    """Whether the normals at the corners of each face are the face's own, as exporters without smooth shading write."""
    along = np.einsum("fkc,fc->fk", mesh.vertex_normals[mesh.faces], mesh.face_normals).min(axis=1)
    has_area = mesh.face_normals.any(axis=1)
    return bool((along[has_area] > 1.0 - 1e-3).all())
