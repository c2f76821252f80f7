"""Light: a sun, which casts shadows, and a sky."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .bodies import Body
from .camera import Camera, look_from
from .raster import Raster, rasterize

__all__ = ["FAR", "Mesh", "Sun", "to_srgb"]

Array = NDArray[np.float64]

_SHARPEST, _COARSEST = 1024, 256  # the greatest and least side of a shadow map [pixels]
FAR = 0.02  # the lens of a camera so far away that its rays are almost parallel
_SKY, _KEY, _FILL = 0.44, 0.70, 0.13
_TAPS = 6  # lookups in the shadow map for each sample; a pixel's four samples use different ones


def _to_linear(color: Array) -> Array:
    """sRGB in 0..1 as linear light."""
    return np.asarray(color) ** 2.2


def to_srgb(light: Array) -> Array:
    """Linear light as sRGB in 0..1; highlights are compressed, so that white surfaces keep their shading."""
    held = light / np.sqrt(1.0 + 0.35 * light**2)
    return np.asarray(np.clip(held, 0.0, 1.0) ** (1.0 / 2.2))


@dataclass(frozen=True, eq=False)
class Mesh:
    """Several bodies of the same opacity, ghosts or not, merged into one mesh.

    Attributes:
        vertices: (v, 3) [m].
        normals: (v, 3).
        faces: (f, 3).
        color: Of each face (f, 3), as linear light.
        gloss: Of each face (f,).
        glow: Of each face (f,).
        covers: Whether each face (f,) covers ghosts.
        opacity: In 0..1.
        ghost: Whether they are ghosts.
    """

    vertices: Array
    normals: Array
    faces: NDArray[np.int64]
    color: Array
    gloss: Array
    glow: Array
    covers: NDArray[np.bool_]
    opacity: float
    ghost: bool

    @classmethod
    def of(cls, bodies: Sequence[Body]) -> Mesh:
        """Merge one or more bodies; the first gives the opacity, and whether they are ghosts."""
        solids = [body.solid for body in bodies]
        starts = np.cumsum([0, *(len(solid.vertices) for solid in solids[:-1])])
        counts = [len(solid.faces) for solid in solids]
        return cls(
            np.vstack([solid.vertices for solid in solids]),
            np.vstack([solid.normals for solid in solids]),
            np.vstack([solid.faces + start for solid, start in zip(solids, starts, strict=True)]),
            np.repeat(_to_linear(np.array([body.color for body in bodies])), counts, axis=0),
            np.repeat([body.gloss for body in bodies], counts),
            np.repeat([body.glow for body in bodies], counts),
            np.repeat([body.opacity >= 1.0 and not body.scenery for body in bodies], counts),
            bodies[0].opacity,
            bodies[0].ghost,
        )

    def drawn_by(self, camera: Camera, size: tuple[int, int], rows: tuple[int, int] | None = None) -> Raster:
        """What a camera sees of the mesh in a picture of this size, or in its rows from the first up to the second."""
        top, bottom = (0, size[1]) if rows is None else rows
        seen = camera.seen(self.vertices, size)
        seen[:, 1] -= top * seen[:, 2]
        return rasterize(seen[self.faces], (size[0], bottom - top))


class Sun:
    """A distant light over the viewer's left shoulder.

    Args:
        meshes: The meshes; the opaque one casts shadows.
        camera: The picture's camera.
        size: Width and height of the picture [pixels]; a small picture gets coarser shadows.
        points: Points (n, 3) [m] whose hull holds everything that is lit.
    """

    def __init__(self, meshes: Sequence[Mesh], camera: Camera, size: tuple[int, int], points: Array) -> None:
        right, _, ahead = camera.axes
        flat = np.array([*-ahead[:2], 0.0]) if np.linalg.norm(ahead[:2]) > 0.1 else np.array([1.0, 0.0, 0.0])
        flat /= np.linalg.norm(flat)
        self.direction = _unit(0.75 * flat - 0.65 * right + [0.0, 0.0, 1.35])
        self._fill = _unit(0.35 * flat + 0.9 * right + [0.0, 0.0, 0.45])
        self.radius = float(np.linalg.norm(np.ptp(points, axis=0))) / 2
        self.camera = look_from(self.direction, points, aspect=1.0, lens=FAR, filled=0.75)
        side = min(max(*size, _COARSEST), _SHARPEST) // 2 * 2
        self.map_size = (side, side)
        away = (points.mean(axis=0) - self.camera.position) @ self.camera.axes[2]
        self._pixel = float(2.0 * FAR * away / side)  # [m]
        self._solid = next((mesh for mesh in meshes if mesh.opacity >= 1.0), None)
        if self._solid is None:
            self._depth = np.full(self.map_size[::-1], np.inf)
        else:
            self._depth = self._solid.drawn_by(self.camera, self.map_size).depth

    def sees(self, mesh: Mesh) -> Array:
        """The mesh's distance from the sun at each pixel of the shadow map; infinite where there is none."""
        return self._depth if mesh is self._solid else mesh.drawn_by(self.camera, self.map_size).depth

    def shines_on(self, points: Array, normals: Array, sample: NDArray[np.int64]) -> Array:
        """The share of sunlight that reaches surface points (k, 3); `sample` (k,) in 0..3 numbers a pixel's samples."""
        x, y, depth = self.camera.seen(points + 3.0 * self._pixel * normals, self.map_size).T
        x, y = x / depth, y / depth
        bias = 2.0 * self._pixel
        lit = np.zeros(len(points))
        for tap in range(_TAPS):
            turn = 4 * tap + sample
            away, angle = 3.2 * np.sqrt((turn + 0.5) / (4 * _TAPS)), 2.39996 * turn  # the golden angle
            column = np.clip((x + away * np.cos(angle)).astype(np.int64), 0, self.map_size[0] - 1)
            row = np.clip((y + away * np.sin(angle)).astype(np.int64), 0, self.map_size[1] - 1)
            lit += self._depth[row, column] > depth - bias
        return lit / _TAPS

    def shade(
        self,
        mesh: Mesh,
        triangles: NDArray[np.int64],
        points: Array,
        normals: Array,
        back: Array,
        sample: NDArray[np.int64],
    ) -> Array:
        """The light (k, 3) from points on a mesh's triangles; `back` (k, 3) are unit vectors to the camera."""
        rim = 0.84 + 0.16 * np.einsum("kc,kc->k", normals, back).clip(0.0)  # so that white stands out against white
        key = np.maximum(normals @ self.direction, 0.0) * self.shines_on(points, normals, sample)
        fill = np.maximum(normals @ self._fill, 0.0)
        sky = _SKY * (0.66 + 0.34 * normals[:, 2])
        half = self.direction + back
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        shine = np.einsum("kc,kc->k", normals, half).clip(0.0) ** 50.0 * mesh.gloss[triangles] * (key > 0.0)
        light = rim * (sky + _KEY * key + _FILL * fill) + mesh.glow[triangles]
        return np.asarray(mesh.color[triangles] * light[:, None] + shine[:, None])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
