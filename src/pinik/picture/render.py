"""Bodies, light and ground, rendered into pixels."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .bodies import Body
from .camera import Camera
from .ground import Ground
from .light import Mesh, Sun, to_srgb

__all__ = ["render"]

Array = NDArray[np.float64]

_SAMPLES = 2  # along each side of a pixel
# Bounds on what is in memory at once, whatever the size of the picture and the number of ghosts:
_AT_ONCE = 400_000  # pixels
_MOST = 8_000_000  # samples of all layers together


def render(
    layers: Sequence[Sequence[Body]], camera: Camera, size: tuple[int, int], floor: float | None, paper: Array | None
) -> NDArray[np.uint8]:
    """Render a picture.

    Args:
        layers: Bodies; those of one layer hide each other, have the same opacity, and are all ghosts or none.
        camera: The camera.
        size: Width and height [pixels].
        floor: The height of the ground [m]; None for no ground.
        paper: The background's colour (3,), sRGB in 0..1; None for a transparent one.

    Returns:
        Red, green, blue and opacity (h, w, 4), 0..255.
    """
    meshes = [Mesh.of(layer) for layer in layers]
    points = np.vstack([_box(body.solid.vertices) for layer in layers for body in layer])
    width, height = size
    sun = Sun(meshes, camera, size, points)
    standing = [mesh for mesh in meshes if not mesh.ghost]
    ground = None if floor is None or camera.position[2] <= floor else Ground(floor, standing, sun, points)
    bands: list[NDArray[np.uint8]] = []
    top, count = 0, max(_AT_ONCE // width, 1)
    while top < height:
        band = (top, min(top + count, height))
        drawn = _covered(meshes, sun, camera, size, band)
        if drawn is None:
            count = (count + 1) // 2
        else:
            bands.append(_band(drawn, ground, camera, size, band, paper))
            top = band[1]
    return np.vstack(bands)


def _covered(
    meshes: Sequence[Mesh], sun: Sun, camera: Camera, size: tuple[int, int], band: tuple[int, int]
) -> list[_Fragments] | None:
    """What each layer shows in the rows `band`, from the first up to the second; None if that takes too much memory."""
    fine = (size[0] * _SAMPLES, size[1] * _SAMPLES)
    drawn, total = [], 0
    for mesh in meshes:
        drawn.append(_shaded(mesh, sun, camera, fine, (band[0] * _SAMPLES, band[1] * _SAMPLES)))
        total += len(drawn[-1].key)
        if total > _MOST and band[1] - band[0] > 1:
            return None
    return drawn


def _band(
    drawn: Sequence[_Fragments],
    ground: Ground | None,
    camera: Camera,
    size: tuple[int, int],
    band: tuple[int, int],
    paper: Array | None,
) -> NDArray[np.uint8]:
    """The pixels of some rows of the picture."""
    color, opacity = _together(drawn, (size[0] * _SAMPLES, (band[1] - band[0]) * _SAMPLES))
    behind, cover = np.zeros_like(color), np.zeros_like(opacity)
    if ground is not None:
        behind, cover = _floor(ground, camera, size, band, paper)
    if paper is not None:
        behind, cover = behind + (1.0 - cover)[..., None] * paper, np.ones_like(cover)
    color = color + (1.0 - opacity)[..., None] * behind  # these colours are premultiplied by opacity
    opacity = opacity + (1.0 - opacity) * cover
    plain = np.divide(color, opacity[..., None], out=np.zeros_like(color), where=opacity[..., None] > 0.0)
    return np.asarray(np.dstack([plain, opacity]).clip(0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _floor(
    ground: Ground, camera: Camera, size: tuple[int, int], band: tuple[int, int], paper: Array | None
) -> tuple[Array, Array]:
    """The ground's colour, premultiplied, and its opacity; on a transparent background only its shadows."""
    strength, dark = ground.seen_by(camera, size, band)
    if paper is None:
        return np.zeros((*dark.shape, 3)), dark
    return (strength * (1.0 - dark))[..., None] * ground.color, 1.0 - (1.0 - strength) * (1.0 - dark)


@dataclass(frozen=True)
class _Fragments:
    """What a layer shows at the samples that it covers.

    Attributes:
        key: The sample's index in the upper bits and its depth in the lower ones (k,): sorted, the fragments of a
            sample run from front to back.
        color: sRGB (k, 3).
        opacity: (k,).
        covers: Whether each fragment covers ghosts, wherever they are (k,).
        ghost: Whether they are those of ghosts.
    """

    key: NDArray[np.uint64]
    color: NDArray[np.float32]
    opacity: NDArray[np.float32]
    covers: NDArray[np.bool_]
    ghost: bool

    @property
    def place(self) -> NDArray[np.int64]:
        """The sample's index (k,)."""
        return (self.key >> np.uint64(32)).astype(np.int64)


def _together(drawn: Sequence[_Fragments], size: tuple[int, int]) -> tuple[Array, Array]:
    """All layers blended from front to back: premultiplied colour (h, w, 3) and opacity (h, w)."""
    width, height = size
    key = np.concatenate([one.key for one in drawn])
    color = np.concatenate([one.color for one in drawn])
    covered = np.zeros(height * width, dtype=bool)
    for one in drawn:
        covered[one.place[one.covers]] = True
    opacity = np.concatenate([one.opacity * ~(one.ghost & covered[one.place]) for one in drawn])
    order = np.argsort(key, kind="stable")
    place = np.concatenate([one.place for one in drawn])[order]
    rank = _ranks(place)
    ends = np.cumsum(np.bincount(rank))
    by_rank = np.argsort(rank, kind="stable")
    total, left = np.zeros((height * width, 3)), np.ones(height * width)
    for begin, end in itertools.pairwise([0, *ends]):
        some = by_rank[begin:end]
        here, of = place[some], order[some]
        share = opacity[of] * left[here]
        total[here] += share[:, None] * color[of]
        left[here] -= share
    return _averaged(total.reshape(height, width, 3)), _averaged(1.0 - left.reshape(height, width))


def _ranks(place: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each entry of a sorted array, the number of equal entries before it."""
    counted = np.arange(len(place))
    begins = np.r_[True, place[1:] != place[:-1]][: len(place)]
    return np.asarray(counted - np.maximum.accumulate(np.where(begins, counted, 0)))


def _shaded(mesh: Mesh, sun: Sun, camera: Camera, size: tuple[int, int], band: tuple[int, int]) -> _Fragments:
    """The fragments of one layer in some rows."""
    raster = mesh.drawn_by(camera, size, band)
    rows, columns = np.nonzero(raster.covered)
    triangles = raster.triangles(rows, columns)
    weights = raster.weights(rows, columns)
    corners = mesh.faces[triangles]
    normals = np.einsum("kc,kcx->kx", weights, mesh.normals[corners])
    points = np.einsum("kc,kcx->kx", weights, mesh.vertices[corners])
    back = camera.position - points
    back /= _lengths(back)
    # Some files have faces that point inwards; whichever side is seen counts as the outside.
    a, b, c = (mesh.vertices[mesh.faces[raster.drawn, k]] for k in range(3))
    flat = np.cross(b - a, c - a)[raster.number[rows, columns]]
    inward = np.einsum("kc,kc->k", flat, normals) * np.einsum("kc,kc->k", flat, back) < 0.0
    normals[inward] *= -1.0
    normals /= np.maximum(_lengths(normals), 1e-12)
    sample = columns % _SAMPLES + _SAMPLES * (rows % _SAMPLES)
    light = sun.shade(mesh, triangles, points, normals, back, sample)
    depth = raster.depth[rows, columns].astype(np.float32)
    key = (rows * size[0] + columns).astype(np.uint64) << np.uint64(32) | depth.view(np.uint32).astype(np.uint64)
    opacity = np.full(len(key), mesh.opacity, np.float32)
    return _Fragments(key, to_srgb(light).astype(np.float32), opacity, mesh.covers[triangles], mesh.ghost)


def _lengths(vectors: Array) -> Array:
    """The length of each vector (k, 1), several times as fast as numpy's norm."""
    return np.asarray(np.sqrt(np.einsum("kc,kc->k", vectors, vectors))[:, None])


def _averaged(image: Array) -> Array:
    """The mean of each pixel's samples."""
    samples = [image[i::_SAMPLES, j::_SAMPLES] for i in range(_SAMPLES) for j in range(_SAMPLES)]
    return np.asarray(sum(samples[1:], samples[0]) / len(samples))


def _box(points: Array) -> Array:
    """The corners (8, 3) of the points' bounding box."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([np.where(pick, high, low) for pick in np.ndindex(2, 2, 2)])
