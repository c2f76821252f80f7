"""Surfaces as strict readers want them: no triangles without area, no corners without triangles, only unit normals."""

from __future__ import annotations

import numpy as np

from ..picture.solids import Solid

__all__ = ["cleaned"]

_SLIVER = 1e-9  # twice the area of a triangle that counts as none, of the square of its longest side


def cleaned(solid: Solid) -> Solid:
    """A surface without slivers and what only they use; a corner that has no normal gets that of one of its faces."""
    a, b, c = solid.vertices[solid.faces.T]
    across = np.cross(b - a, c - a)
    area = np.linalg.norm(across, axis=1)
    longest = np.max([np.sum(side**2, axis=1) for side in (b - a, c - b, a - c)], axis=0)
    is_face = area > _SLIVER * longest
    used, faces = np.unique(solid.faces[is_face], return_inverse=True)
    faces = faces.reshape(-1, 3)
    normals = solid.normals[used]
    lengths = np.linalg.norm(normals, axis=1)
    flat = across[is_face] / area[is_face, None]
    for corner in faces.T:
        missing = lengths[corner] < 0.5
        normals[corner[missing]] = flat[missing]
    return Solid(solid.vertices[used], normals / np.linalg.norm(normals, axis=1, keepdims=True), faces)
