"""Bodies, light and ground put together into pixels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .bodies import Body
from .camera import Camera
from .ground import Ground
from .light import Mesh, Sun, to_srgb

__all__ = ["render"]

Array = NDArray[np.float64]

_SAMPLES = 2  # across a pixel, and as many down


def render(
    layers: Sequence[Sequence[Body]], camera: Camera, size: tuple[int, int], floor: float | None, paper: Array | None
) -> NDArray[np.uint8]:
    """Draw.

    Args:
        layers: Bodies, those of one layer of one opacity; of each layer only what is in front of its others is seen.
        camera: From where.
        size: Width and height [pixels].
        floor: Height of the ground [m]; none when None.
        paper: The background's colour (3,), sRGB in 0..1; transparent when None.

    Returns:
        Red, green, blue, opacity (h, w, 4).
    """
    meshes = [Mesh.of(layer) for layer in layers]
    points = np.vstack([_box(body.solid.vertices) for layer in layers for body in layer])
    sun = Sun(meshes, camera, size, points)
    color, opacity = _drawn(meshes, sun, camera, size)
    behind, cover = np.zeros((*opacity.shape, 3)), np.zeros_like(opacity)
    if floor is not None and camera.position[2] > floor:
        behind, cover = _floor(Ground(floor, meshes, sun, points), camera, size, paper)
    if paper is not None:
        behind, cover = behind + (1.0 - cover)[..., None] * paper, np.ones_like(cover)
    color = color + (1.0 - opacity)[..., None] * behind  # all of them multiplied by their opacity
    opacity = opacity + (1.0 - opacity) * cover
    plain = np.divide(color, opacity[..., None], out=np.zeros_like(color), where=opacity[..., None] > 0.0)
    return np.asarray(np.dstack([plain, opacity]).clip(0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _floor(ground: Ground, camera: Camera, size: tuple[int, int], paper: Array | None) -> tuple[Array, Array]:
    """The ground's colour, multiplied by its opacity, and that; without paper it is its shadows alone."""
    strength, dark = ground.seen_by(camera, size)
    if paper is None:
        return np.zeros((*dark.shape, 3)), dark
    return (strength * (1.0 - dark))[..., None] * ground.color, 1.0 - (1.0 - strength) * (1.0 - dark)


def _drawn(meshes: Sequence[Mesh], sun: Sun, camera: Camera, size: tuple[int, int]) -> tuple[Array, Array]:
    """Colour (h, w, 3), multiplied by opacity, and opacity (h, w) of all layers, the nearer before the farther."""
    width, height = size
    fine = (width * _SAMPLES, height * _SAMPLES)
    drawn = [_shaded(mesh, sun, camera, fine) for mesh in meshes]
    order = np.argsort([depth for _, depth in drawn], axis=0) if len(drawn) > 1 else np.zeros((1, *fine[::-1]))
    total, left = np.zeros((fine[1], fine[0], 3)), np.ones((fine[1], fine[0]))
    for rank in order:
        for k, (mesh, (color, depth)) in enumerate(zip(meshes, drawn, strict=True)):
            here = np.nonzero((rank == k) & np.isfinite(depth))
            share = mesh.opacity * left[here]
            total[here] += share[:, None] * color[here]
            left[here] -= share
    return _averaged(total), _averaged(1.0 - left)


def _shaded(mesh: Mesh, sun: Sun, camera: Camera, size: tuple[int, int]) -> tuple[Array, Array]:
    """sRGB (h, w, 3) and depth (h, w) of one layer."""
    raster = mesh.drawn_by(camera, size)
    rows, columns = np.nonzero(raster.covered)
    triangles = raster.triangles(rows, columns)
    weights = raster.weights(rows, columns)
    corners = mesh.faces[triangles]
    normals = np.einsum("kc,kcx->kx", weights, mesh.normals[corners])
    points = np.einsum("kc,kcx->kx", weights, mesh.vertices[corners])
    back = camera.position - points
    back /= _lengths(back)
    # Files have faces that look inwards: what is seen of a surface is its outside.
    a, b, c = (mesh.vertices[mesh.faces[raster.drawn, k]] for k in range(3))
    flat = np.cross(b - a, c - a)[raster.number[rows, columns]]
    inward = np.einsum("kc,kc->k", flat, normals) * np.einsum("kc,kc->k", flat, back) < 0.0
    normals[inward] *= -1.0
    normals /= np.maximum(_lengths(normals), 1e-12)
    sample = columns % _SAMPLES + _SAMPLES * (rows % _SAMPLES)
    light = sun.shade(mesh, triangles, points, normals, back, sample)
    color = np.zeros((*raster.depth.shape, 3))
    color[rows, columns] = to_srgb(light)
    return color, raster.depth


def _lengths(vectors: Array) -> Array:
    """Of each (k, 1); several times as fast as numpy's."""
    return np.asarray(np.sqrt(np.einsum("kc,kc->k", vectors, vectors))[:, None])


def _averaged(image: Array) -> Array:
    """The mean over the samples of each pixel."""
    samples = [image[i::_SAMPLES, j::_SAMPLES] for i in range(_SAMPLES) for j in range(_SAMPLES)]
    return np.asarray(sum(samples[1:], samples[0]) / len(samples))


def _box(points: Array) -> Array:
    """The corners (8, 3) of the box about points."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([np.where(pick, high, low) for pick in np.ndindex(2, 2, 2)])
