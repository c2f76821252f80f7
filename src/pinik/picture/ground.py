"""A ground that fades out with distance, and the soft shadows on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .camera import Camera, look_from
from .light import FAR, Mesh, Sun

__all__ = ["Ground"]

Array = NDArray[np.float64]

_FLOOR = np.array([0.90, 0.91, 0.925])  # sRGB
_FADES = (0.7, 3.0)  # where the floor starts and ends to fade, in radii of what stands on it
_CAST, _NEAR = 0.26, 0.30  # the darkness of the two shadows


class Ground:
    """A floor with the sun's shadow, softer below higher objects, and a dark patch under objects close to it.

    Args:
        height: The floor's height [m].
        meshes: The meshes that stand on it.
        sun: The light.
        points: Points (n, 3) [m] whose hull holds everything.
    """

    color = _FLOOR

    def __init__(self, height: float, meshes: Sequence[Mesh], sun: Sun, points: Array) -> None:
        self._height, self._sun, self._radius = height, sun.camera, sun.radius
        self._map_size = (sun.map_size[0] // 2, sun.map_size[1] // 2)  # fine enough, as the maps are blurred
        self._middle = (points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2
        self._below = look_from(np.array([0.0, 0.0, -1.0]), points, aspect=1.0, lens=FAR, filled=0.6)
        levels = np.array([0.0, 0.25, 1.0]) * sun.radius
        lit, far = np.ones(self._map_size[::-1]), np.ones(self._map_size[::-1])
        for mesh in meshes:
            depth = sun.sees(mesh)[::2, ::2]
            above = self._above(sun.camera, depth)
            cast = np.zeros(self._map_size[::-1])
            for k, level in enumerate(levels):
                share = np.where(np.isfinite(depth), np.interp(above, levels, np.eye(len(levels))[k]), 0.0)
                cast += _blurred(share, self._pixels(sun.camera, 0.012 * sun.radius + 0.06 * level, points))
            lit *= 1.0 - mesh.opacity * cast.clip(0.0, 1.0)
            depth = mesh.drawn_by(self._below, self._map_size).depth
            near = np.exp(-self._above(self._below, depth).clip(0.0) / (0.1 * sun.radius))
            near = np.where(np.isfinite(depth), near, 0.0)
            far *= 1.0 - mesh.opacity * _blurred(near, self._pixels(self._below, 0.03 * sun.radius, points))
        self._cast, self._near = 1.0 - lit, 1.0 - far

    def _above(self, camera: Camera, depth: Array) -> Array:
        """The height above the floor [m] of what a map shows; zero where it shows nothing."""
        above = np.zeros_like(depth)
        rows, columns = np.nonzero(np.isfinite(depth))
        ways = camera.rays(columns + 0.5, rows + 0.5, self._map_size)[:, 2]
        above[rows, columns] = camera.position[2] + depth[rows, columns] * ways - self._height
        return above

    def _pixels(self, camera: Camera, length: float, points: Array) -> float:
        """A length [m] in pixels of a map."""
        away = (points.mean(axis=0) - camera.position) @ camera.axes[2]
        return float(length * self._map_size[1] / (2.0 * FAR * away))

    def seen_by(self, camera: Camera, size: tuple[int, int], band: tuple[int, int]) -> tuple[Array, Array]:
        """The floor's opacity and the shadows' darkness, in 0..1, at each pixel (h, w) of some rows of a picture."""
        rows, columns = np.mgrid[slice(*band), : size[0]]
        rays = camera.rays(columns + 0.5, rows + 0.5, size)
        hit = rays[..., 2] * np.sign(self._height - camera.position[2]) > 1e-9
        ahead = (self._height - camera.position[2]) / rays[hit][:, 2]
        points = camera.position + rays[hit] * ahead[:, None]
        away = np.linalg.norm(points[:, :2] - self._middle, axis=1) / self._radius
        floor, dark = np.zeros(rows.shape), np.zeros(rows.shape)
        t = ((away - _FADES[0]) / (_FADES[1] - _FADES[0])).clip(0.0, 1.0)
        floor[hit] = 1.0 - t * t * (3.0 - 2.0 * t)
        cast, near = _sampled(self._cast, self._sun, points), _sampled(self._near, self._below, points)
        dark[hit] = 1.0 - (1.0 - _CAST * cast) * (1.0 - _NEAR * near)
        return floor, dark


def _sampled(image: Array, camera: Camera, points: Array) -> Array:
    """A map's values where its camera sees points (k, 3), interpolated linearly; 0 outside the map."""
    height, width = image.shape
    x, y, depth = camera.seen(points, (width, height)).T
    x, y = x / depth - 0.5, y / depth - 0.5
    found = np.zeros(len(points))
    inside = np.flatnonzero((x >= 0) & (y >= 0) & (x < width - 1) & (y < height - 1))
    x, y = x[inside], y[inside]
    column, row = x.astype(np.int64), y.astype(np.int64)
    u, v = x - column, y - row
    upper = image[row, column] * (1 - u) + image[row, column + 1] * u
    lower = image[row + 1, column] * (1 - u) + image[row + 1, column + 1] * u
    found[inside] = upper * (1 - v) + lower * v
    return found


def _blurred(image: Array, sigma: float) -> Array:
    """The image after three box filters along each axis, almost a Gaussian of this standard deviation [pixels]."""
    half = max(round(sigma - 0.5), 1)
    for _ in range(3):
        for _ in range(2):
            total = np.cumsum(np.pad(image, [(half + 1, half), (0, 0)]), axis=0)
            image = ((total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1)).T
    return image
