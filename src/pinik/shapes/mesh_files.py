"""The mesh files of a robot: each is read once, and a shape that cannot be read becomes a flaw."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pinocchio
import trimesh
from numpy.typing import NDArray

from ..description.flaw import Flaw
from ..description.packages import Found, Surroundings
from ..description.shape_tags import ShapeTag
from . import triangles
from .mesh_checks import MeshError, UndrawnCode

__all__ = ["MeshFiles", "flaw_of", "placement_of"]

MOST_TRIANGLES = 20_000_000  # of all shapes of a robot; a mesh file counts as often as it is used


class _MeshNotFoundError(Exception):
    def __init__(self, address: str, found: Found) -> None:
        self.address = address
        self.found = found
        said = f"the mesh {address!r} is not opened" if found.refused else f"there is no mesh {address!r}"
        super().__init__(said if found.why == "there is no such file" else f"{said}: {found.why}")


class MeshFiles:
    """The mesh files of one robot: each is read once, and the triangles of all its shapes together are bounded."""

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
        self.count(mesh for mesh, _ in parts)
        return [(triangles.scaled(mesh, scale), color) for mesh, color in parts]

    def count(self, meshes: Iterable[trimesh.Trimesh]) -> None:
        """Count the triangles of one shape.

        Raises:
            MeshError: There would be too many.
        """
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


def flaw_of(element: str, line: int, fault: Exception) -> Flaw:
    """A flaw of a shape that is left out."""
    cause = f"a shape is left out: {fault}"
    if isinstance(fault, _MeshNotFoundError):
        found = fault.found
        return Flaw(element, cause, code=found.code, line=line, mend=found.mend, mesh=fault.address)
    code: UndrawnCode = fault.code if isinstance(fault, MeshError) else "unreadable-shape"
    return Flaw(element, cause, code=code, line=line)


def placement_of(shape: ShapeTag) -> NDArray[np.float64]:
    """The placement (4, 4) of a shape in its link's frame [m]."""
    placement = np.eye(4)
    placement[:3, :3] = pinocchio.rpy.rpyToMatrix(np.array(shape.rpy))
    placement[:3, 3] = shape.xyz
    return placement
