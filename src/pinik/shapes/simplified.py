"""Meshes with few triangles, which look like those with many while a robot moves.

Importing this module imports trimesh, which takes over a second; import it only where shapes are needed.
"""

from __future__ import annotations

import fast_simplification
import numpy as np
import trimesh
from numpy.typing import NDArray

from .triangles import creased

__all__ = ["simplified"]

LEAST = 60  # triangles; a cylinder with fewer has corners
# fast-simplification's `agg`; above 5, some triangles of a ball are so thin that their normals are wrong.
PATIENCE = 3.0
LOST = 0.05  # of a mesh's diagonal, by which it may become smaller


def simplified(points: NDArray[np.floating], faces: NDArray[np.integer], share: float) -> trimesh.Trimesh | None:
    """Return a mesh with about this share of the triangles.

    It is None if that would save less than a third of them, or if a part that sticks out would be lost.

    Edges are removed in the order in which that changes the surface least: M. Garland and P. S. Heckbert, "Surface
    Simplification Using Quadric Error Metrics", SIGGRAPH 1997.

    Args:
        points: The vertices (n, 3); those at the same place, as at a sharp edge, count as one.
        faces: The triangles (m, 3), as indices of vertices.
        share: Which part of the triangles to keep, in 0..1.
    """
    few = max(LEAST, round(share * len(faces)))
    if 3 * few > 2 * len(faces):
        return None
    places, at = np.unique(points.astype(np.float32), axis=0, return_inverse=True)
    vertices, kept = fast_simplification.simplify(
        places, at.ravel()[faces].astype(np.int32), target_count=few, agg=PATIENCE
    )
    mesh = trimesh.Trimesh(vertices.astype(float), kept, process=False)
    mesh.update_faces(mesh.area_faces > 0.0)  # else their corners would have no normals
    if not len(mesh.faces) or not np.isfinite(mesh.vertices).all():
        return None
    lost = np.abs(mesh.bounds - [places.min(axis=0), places.max(axis=0)]).max()
    return creased(mesh) if lost < LOST * np.linalg.norm(np.ptp(places, axis=0)) else None
