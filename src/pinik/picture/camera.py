"""A camera: its place, how it projects points, and how it is set up so that points fill its picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Camera", "facing", "look_from"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera in the robot's world.

    Attributes:
        position: Its position (3,) [m].
        axes: Its right, down and forward directions, as rows (3, 3).
        lens: Tangent of half its vertical field of view.
    """

    position: Array
    axes: Array
    lens: float

    def seen(self, points: Array, size: tuple[int, int]) -> Array:
        """For pinik itself: points (…, 3) [m] as (right, down, ahead), seen at the pixel (right/ahead, down/ahead)."""
        width, height = size
        focal = height / (2.0 * self.lens)
        to_pixels = np.array([[focal, 0.0, width / 2.0], [0.0, focal, height / 2.0], [0.0, 0.0, 1.0]])
        # Several times as fast as BLAS, whose threads slow each other down here.
        return np.asarray(np.einsum("...c,rc->...r", points - self.position, to_pixels @ self.axes))

    def rays(self, columns: NDArray[Any], rows: NDArray[Any], size: tuple[int, int]) -> Array:
        """For pinik itself: the rays (…, 3) through pixels, in the world, as long as to reach a plane 1 m ahead."""
        width, height = size
        scale = 2.0 * self.lens / height
        right, down, ahead = self.axes
        across = ((columns - width / 2.0) * scale)[..., None] * right
        return np.asarray(across + ((rows - height / 2.0) * scale)[..., None] * down + ahead)


def facing(direction: Array) -> Array:
    """The axes of an upright camera; `direction` (3,), of any length, leads from the object to the camera."""
    back = direction / np.linalg.norm(direction)
    right = np.cross((0.0, 0.0, 1.0), back)
    if np.linalg.norm(right) < 1e-9:
        right = np.array([1.0, 0.0, 0.0])  # straight above: x to the right and y up, as on a map
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, back), -back])


def look_from(direction: Array, points: Array, *, aspect: float, lens: float, filled: float) -> Camera:
    """The nearest camera that sees all the points.

    Args:
        direction: From the points to the camera (3,), of any length.
        points: (n, 3) [m].
        aspect: The picture's width divided by its height.
        lens: As `Camera.lens`.
        filled: The share of the picture's width and height that the points may fill.
    """
    axes = facing(direction)
    x, y, z = (points @ axes.T).T
    wide, high = lens * aspect * filled, lens * filled
    # The planes through the picture's four edges, each moved out to the farthest point.
    reach = np.array([(x - wide * z).max(), (-x - wide * z).max(), (y - high * z).max(), (-y - high * z).max()])
    depth = min(-(reach[0] + reach[1]) / (2 * wide), -(reach[2] + reach[3]) / (2 * high))
    size = float(np.ptp(points, axis=0).max()) or 1.0  # any distance will do for a single point
    depth = min(depth, z.min() - 0.02 * size)
    at = np.array([(reach[0] - reach[1]) / 2, (reach[2] - reach[3]) / 2, depth])
    return Camera(at @ axes, axes, lens)
