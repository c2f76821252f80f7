"""Where a camera stands so that points fill its picture, and where it sees a point."""

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
        position: Where it stands (3,) [m].
        axes: Its right, down and ahead, rows (3, 3).
        lens: Tangent of the half of what it sees from top to bottom.
    """

    position: Array
    axes: Array
    lens: float

    def seen(self, points: Array, size: tuple[int, int]) -> Array:
        """Points (…, 3) [m] as right, down, ahead (…, 3): at the pixel (right/ahead, down/ahead) of such a picture."""
        width, height = size
        focal = height / (2.0 * self.lens)
        to_pixels = np.array([[focal, 0.0, width / 2.0], [0.0, focal, height / 2.0], [0.0, 0.0, 1.0]])
        # Several times as fast as BLAS, whose threads get in each other's way here.
        return np.asarray(np.einsum("...c,rc->...r", points - self.position, to_pixels @ self.axes))

    def rays(self, columns: NDArray[Any], rows: NDArray[Any], size: tuple[int, int]) -> Array:
        """Ways (…, 3) in the world through pixels, one metre ahead long."""
        width, height = size
        scale = 2.0 * self.lens / height
        right, down, ahead = self.axes
        across = ((columns - width / 2.0) * scale)[..., None] * right
        return np.asarray(across + ((rows - height / 2.0) * scale)[..., None] * down + ahead)


def facing(direction: Array) -> Array:
    """The axes of a camera that stands upright in a direction (3,), of any length, from what it looks at."""
    back = direction / np.linalg.norm(direction)
    right = np.cross((0.0, 0.0, 1.0), back)
    if np.linalg.norm(right) < 1e-9:
        right = np.array([1.0, 0.0, 0.0])  # from straight above as on a map: x to the right, y up
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, back), -back])


def look_from(direction: Array, points: Array, *, aspect: float, lens: float, filled: float) -> Camera:
    """The nearest camera that sees all points.

    Args:
        direction: From the points to the camera (3,), any length.
        points: (n, 3) [m].
        aspect: Width by height of the picture.
        lens: As `Camera.lens`.
        filled: Which part of the picture's width and height the points may fill.
    """
    axes = facing(direction)
    x, y, z = (points @ axes.T).T
    wide, high = lens * aspect * filled, lens * filled
    # The planes at the picture's four edges, each as far out as the farthest point needs.
    reach = np.array([(x - wide * z).max(), (-x - wide * z).max(), (y - high * z).max(), (-y - high * z).max()])
    depth = min(-(reach[0] + reach[1]) / (2 * wide), -(reach[2] + reach[3]) / (2 * high))
    size = float(np.ptp(points, axis=0).max()) or 1.0  # of a single point the camera may be at any distance
    depth = min(depth, z.min() - 0.02 * size)
    at = np.array([(reach[0] - reach[1]) / 2, (reach[2] - reach[3]) / 2, depth])
    return Camera(at @ axes, axes, lens)
