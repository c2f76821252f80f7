"""Solids that can collide: boxes, spheres, cylinders, capsules, and the surfaces of meshes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pinocchio
from numpy.typing import NDArray

__all__ = ["Solid", "Surface"]


@dataclass(frozen=True, eq=False)
class Surface:
    """The triangles of a mesh.

    Attributes:
        vertices: The corners (n, 3) [m], each once.
        faces: The corners of each triangle (m, 3), as indices of vertices.
    """

    vertices: NDArray[np.float64] = field(repr=False)
    faces: NDArray[np.int32] = field(repr=False)

    @classmethod
    def of(cls, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Surface:
        """The surface with equal corners joined, and without those that no triangle has."""
        corners = np.asarray(vertices, dtype=np.float64)[faces].reshape(-1, 3)
        joined, indices = np.unique(corners, axis=0, return_inverse=True)
        surface = cls(np.ascontiguousarray(joined), indices.reshape(-1, 3).astype(np.int32))
        for array in (surface.vertices, surface.faces):
            array.setflags(write=False)
        return surface


@dataclass(frozen=True, eq=False)
class Solid:
    """One shape that can collide, fixed to a link or to the world.

    Attributes:
        owner: The name of the link, or of the world's object, that it belongs to.
        joint: The joint in Pinocchio's model to which it is fixed; 0 is the world.
        placement: Its placement in that joint [m].
        kind: "box", "sphere", "cylinder", "capsule" or "mesh".
        size: A box's three edges, a sphere's radius, a cylinder's or capsule's radius and length along z, without the
            caps [m]; empty for a mesh.
        surface: The triangles of a mesh; None for the others. A mesh is its surface: what lies wholly inside touches
            nothing.
    """

    owner: str
    joint: int
    placement: pinocchio.SE3
    kind: str
    size: tuple[float, ...] = ()
    surface: Surface | None = None
