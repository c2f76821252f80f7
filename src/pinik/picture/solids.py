"""Balls and rods, as triangle meshes of surfaces of revolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Solid", "ball", "rod"]

Array = NDArray[np.float64]

_AROUND = 48


@dataclass(frozen=True, eq=False)
class Solid:
    """A surface of triangles.

    Attributes:
        vertices: (v, 3) [m].
        normals: Unit normals at the vertices (v, 3).
        faces: Indices of the corners (f, 3).
    """

    vertices: Array
    normals: Array
    faces: NDArray[np.int64]

    @classmethod
    def of(cls, mesh: Any) -> Solid:
        """The surface of one of trimesh's meshes."""
        return cls(
            np.asarray(mesh.vertices, dtype=np.float64),
            np.asarray(mesh.vertex_normals, dtype=np.float64),
            np.asarray(mesh.faces, dtype=np.int64),
        )

    def moved(self, rotation: Array, translation: Array) -> Solid:
        """This surface after a rotation (3, 3) and a translation (3,) [m]."""
        return Solid(self.vertices @ rotation.T + translation, self.normals @ rotation.T, self.faces)


def ball(center: Array, radius: float) -> Solid:
    """A sphere."""
    angle = np.linspace(0.0, np.pi, _AROUND // 2 + 1)
    profile = np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    return _revolved(radius * profile, profile).moved(np.eye(3), center)


def rod(start: Array, end: Array, thick: float, thin: float) -> Solid:
    """A rod between two points, open at its ends; its radius falls from `thick` to `thin` [m]."""
    along = end - start
    length = float(np.linalg.norm(along))
    profile = np.array([[thick, 0.0], [thin, length]])
    slope = np.array([length, thick - thin]) / np.hypot(length, thick - thin)
    return _revolved(profile, np.stack([slope, slope])).moved(_from_z(along / length), start)


def _revolved(profile: Array, normals: Array) -> Solid:
    """A profile (k, 2) of radii and heights, with its normals (k, 2), revolved about z."""
    angle = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    turn = np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def turned(rows: Array) -> Array:
        flat = rows[:, None, :1] * turn[None]
        return np.concatenate([flat, np.broadcast_to(rows[:, None, 1:], (*flat.shape[:2], 1))], axis=2).reshape(-1, 3)

    ring, place = np.meshgrid(np.arange(len(profile) - 1) * _AROUND, np.arange(_AROUND), indexing="ij")
    beside = (place + 1) % _AROUND
    a, b, c, d = (
        corner.ravel() for corner in (ring + place, ring + beside, ring + _AROUND + place, ring + _AROUND + beside)
    )
    return Solid(
        turned(profile), turned(normals), np.vstack([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)])
    )


def _from_z(direction: Array) -> Array:
    """A rotation (3, 3) that turns z into a unit direction (3,)."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    x = np.cross(helper, direction)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(direction, x), direction], axis=1)
