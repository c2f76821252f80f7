"""`World`: what stands around a robot, and must not be touched."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import pinocchio
from numpy.typing import ArrayLike

from ..checks import as_array, as_finite_number, as_many, as_positive_number
from ..description import reader as urdf
from ..description.source import RobotSource, is_source
from ..errors import InputError, UnknownNameError
from ..extras import needed_by
from ..model.robot_model import RobotModel
from ..rotations import as_se3
from .robot_solids import robot_solids
from .solids import Solid, Surface

__all__ = ["World"]

_IDENTITY = pinocchio.SE3.Identity()


class World:
    """Obstacles that stand still: boxes, spheres, cylinders and meshes, each with a name of its own.

    Placements are those of an object's centre in the world [m]: an SE3, a homogeneous matrix (4, 4), or a point (3,).
    The world is the robot's: its root link with a fixed root, else the frame in which the root joint moves.

    Every change makes a new version of the world. What was computed for an earlier version stays as it was, and a call
    that has begun does not see the change, so a world may be changed while other threads use it.

    Examples:
        >>> world = World()
        >>> world.add_box("table", [1.0, 0.8, 0.05], [0.5, 0.0, -0.025])
        >>> world.names
        ('table',)
    """

    def __init__(self) -> None:
        self._solids: tuple[Solid, ...] = ()
        self._version = 0

    def __repr__(self) -> str:
        return f"<World: {', '.join(self.names) or 'empty'}>"

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    @classmethod
    def from_urdf(
        cls,
        source: RobotSource,
        package_dirs: Iterable[str | os.PathLike[str]] = (),
        *,
        placement: pinocchio.SE3 | ArrayLike | None = None,
    ) -> Self:
        """The world of a URDF: the collision shapes of its links, named as the links are, with its joints neutral.

        Args:
            source: A path to a .urdf file, URDF text or bytes, or an open file.
            package_dirs: Folders that are searched first for `package://` addresses of meshes.
            placement: Where its root link stands; at the world's origin when None.

        Raises:
            RobotLoadError: The URDF is faulty; the message names the element and the cause.
            InputError: A collision shape cannot be read, as an obstacle that is left out would not be avoided.
            MissingExtraError: It has meshes, and trimesh, which reads them, is not installed.
        """
        if not is_source(source):
            raise InputError(f"must be a path, URDF text or bytes, or an open file; got {source!r}", argument="source")
        if isinstance(package_dirs, (str, os.PathLike)):
            raise InputError(f"must be a list of folders; got {package_dirs!r}", argument="package_dirs")
        description = urdf.read(source)
        dropped = [flaw for flaw in description.warnings if flaw.code == "dropped-shape"]
        robot = RobotModel(description, package_dirs=tuple(package_dirs))
        solids, flaws = robot_solids(robot)
        for flaw in (*dropped, *flaws):
            raise InputError(f"a collision shape of the world cannot be read: {flaw}")
        root = _IDENTITY if placement is None else _placed(placement)
        data = robot.model.createData()
        pinocchio.forwardKinematics(robot.model, data, robot.neutral())
        world = cls()
        world._solids = tuple(replace(s, joint=0, placement=root * data.oMi[s.joint] * s.placement) for s in solids)
        world._version = 1
        return world

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the objects, in the order in which they were added."""
        return tuple(dict.fromkeys(solid.owner for solid in self._solids))

    @property
    def version(self) -> int:
        """For pinik itself: how often the world was changed."""
        return self._version

    @property
    def solids(self) -> tuple[Solid, ...]:
        """For pinik itself: the shapes of this version; a new tuple for each version."""
        return self._solids

    def add_box(self, name: str, size: ArrayLike, placement: pinocchio.SE3 | ArrayLike | None = None) -> None:
        """Add a box.

        Args:
            name: Its name.
            size: Its three edges (3,) along its own axes [m].
            placement: Its centre's placement; the world's origin when None.

        Raises:
            InputError: A name that is taken or empty, a size that is not positive, or no placement.
        """
        edges = as_array(size, (3,), "size")
        self._add(name, "box", tuple(as_positive_number(edge, "size", "m") for edge in edges.tolist()), placement)

    def add_sphere(self, name: str, radius: float, placement: pinocchio.SE3 | ArrayLike | None = None) -> None:
        """Add a sphere of this radius [m]; otherwise as `add_box`."""
        self._add(name, "sphere", (as_positive_number(radius, "radius", "m"),), placement)

    def add_cylinder(
        self, name: str, radius: float, length: float, placement: pinocchio.SE3 | ArrayLike | None = None
    ) -> None:
        """Add a cylinder of this radius and length [m] along its own z axis; otherwise as `add_box`."""
        size = (as_positive_number(radius, "radius", "m"), as_positive_number(length, "length", "m"))
        self._add(name, "cylinder", size, placement)

    def add_mesh(
        self,
        name: str,
        mesh: str | os.PathLike[str] | tuple[ArrayLike, ArrayLike],
        placement: pinocchio.SE3 | ArrayLike | None = None,
        *,
        scale: float | ArrayLike = 1.0,
    ) -> None:
        """Add the surface of a mesh. What lies wholly inside of it touches nothing.

        Args:
            name: Its name.
            mesh: A file (STL, OBJ, DAE, PLY, glTF or OFF), or vertices (n, 3) [m] and triangles (m, 3), whose three
                numbers are indices of vertices.
            placement: The placement of the mesh's own origin; the world's origin when None.
            scale: By how much the mesh is scaled, in all or along each of its three axes; negative to mirror it.

        Raises:
            InputError: As for `add_box`; or the file or the triangles cannot be used.
            MissingExtraError: For a file, if trimesh, which reads it, is not installed.
        """
        one = np.ndim(scale) == 0
        factors = np.full(3, as_finite_number(scale, "scale")) if one else as_array(scale, (3,), "scale")
        if not factors.all():
            raise InputError(f"must not be zero; got {scale!r}", argument="scale")
        vertices, faces = _read(mesh) if isinstance(mesh, (str, os.PathLike)) else _triangles(mesh)
        self._add(name, "mesh", (), placement, Surface.of(vertices * factors, faces))

    def remove(self, name: str) -> None:
        """Remove an object.

        Raises:
            UnknownNameError: There is none of this name; the message lists near names.
        """
        if name not in self.names:
            raise UnknownNameError("object", name, self.names)
        self._change(tuple(solid for solid in self._solids if solid.owner != name))

    def _add(
        self,
        name: str,
        kind: str,
        size: tuple[float, ...],
        placement: pinocchio.SE3 | ArrayLike | None,
        surface: Surface | None = None,
    ) -> None:
        if not isinstance(name, str) or not name:
            raise InputError(f"must be a text that is not empty; got {name!r}", argument="name")
        if name in self.names:
            raise InputError(
                f"{name!r} is in the world already; remove it first, or take another name", argument="name"
            )
        at = _IDENTITY if placement is None else _placed(placement)
        self._change((*self._solids, Solid(name, 0, at, kind, size, surface)))

    def _change(self, solids: tuple[Solid, ...]) -> None:
        self._solids = solids
        self._version += 1


def _placed(placement: pinocchio.SE3 | ArrayLike) -> pinocchio.SE3:
    if not isinstance(placement, pinocchio.SE3) and np.shape(placement) == (3,):
        return pinocchio.SE3(np.eye(3), as_array(placement, (3,), "placement"))
    return as_se3(placement, "placement")


def _read(path: str | os.PathLike[str]) -> tuple[Any, Any]:
    """Vertices and faces in a mesh file."""
    with needed_by("meshes", "pictures"):
        from . import triangles  # over a second to import
    from .mesh_checks import MeshError

    try:
        parts = triangles.read_file(Path(path))
    except MeshError as fault:
        raise InputError(f"{os.fspath(path)!r} cannot be used: {fault}", argument="mesh") from None
    counts = np.cumsum([0, *(len(mesh.vertices) for mesh, _ in parts)])
    faces = [mesh.faces + count for (mesh, _), count in zip(parts, counts, strict=False)]
    return np.vstack([mesh.vertices for mesh, _ in parts]), np.vstack(faces)


def _triangles(mesh: Any) -> tuple[Any, Any]:
    """Vertices and faces that were given as arrays, checked."""
    if not isinstance(mesh, tuple) or len(mesh) != 2:
        needed = "must be a file, or vertices (n, 3) and triangles (m, 3)"
        raise InputError(f"{needed}; got {type(mesh).__name__}", argument="mesh")
    vertices, numbers = as_many(mesh[0], (3,), "vertices"), as_many(mesh[1], (3,), "triangles")
    if not len(numbers):
        raise InputError("has no triangles", argument="mesh")
    faces = numbers.astype(np.int64)
    if (faces != numbers).any() or faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(f"has triangles whose corners are not 0 to {len(vertices) - 1}", argument="mesh")
    return vertices, faces
