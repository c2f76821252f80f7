"""The surfaces of a world's objects in a picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..extras import needed_by
from ..shapes.solids import Solid as Obstacle
from ..shapes.world import World
from .bodies import Body
from .solids import Solid

__all__ = ["obstacles_of"]

_COLOR = np.array([0.62, 0.60, 0.55])


def obstacles_of(world: World) -> Iterator[Body]:
    """The objects of a world as surfaces, whatever their names, all in one colour."""
    for obstacle in world.solids:
        at = obstacle.placement
        yield Body(_solid(obstacle).moved(at.rotation, at.translation), _COLOR, scenery=True)


def _solid(obstacle: Obstacle) -> Solid:
    """The surface of an obstacle in its own frame."""
    if obstacle.surface is not None:
        return _flat(obstacle.surface.vertices[obstacle.surface.faces])
    with needed_by("a picture", "pictures"):
        from ..shapes import triangles  # over a second to import

    match obstacle.kind, obstacle.size:
        case "box", size:
            mesh = triangles.box(np.array(size))
        case "sphere", (radius,):
            mesh = triangles.sphere(radius)
        case "cylinder", (radius, length):
            mesh = triangles.cylinder(radius, length)
        case _, (radius, length):
            mesh = triangles.capsule(radius, length)
    return Solid.of(mesh)


def _flat(corners: NDArray[np.float64]) -> Solid:
    """Triangles (n, 3, 3) with normals of their own; their edges stay sharp."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    return Solid(corners.reshape(-1, 3), np.repeat(normals, 3, axis=0), faces)
