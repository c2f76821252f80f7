"""A z-buffer: the nearest triangle at each pixel, for all triangles at once."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Raster", "rasterize"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_AT_ONCE = 2_000_000  # fragments in memory
_SLACK = 1e-7  # [pixels] closes the gaps between triangles that share an edge


@dataclass(frozen=True)
class Raster:
    """The nearest triangle at each pixel.

    Attributes:
        number: The triangle's position in `drawn` (h, w), -1 where there is none.
        depth: Its distance ahead (h, w), infinite where there is none.
        drawn: Indices of the triangles inside the picture (d,).
        planes: The plane equations of each of them, for `weights` (d, 3, 3).
    """

    number: Ints
    depth: Array
    drawn: Ints
    planes: Array

    @property
    def covered(self) -> NDArray[np.bool_]:
        """Whether a pixel shows a triangle (h, w)."""
        return self.number >= 0

    def triangles(self, rows: Ints, columns: Ints) -> Ints:
        """The index (k,) of the triangle at each of these covered pixels."""
        return self.drawn[self.number[rows, columns]]

    def weights(self, rows: Ints, columns: Ints) -> Array:
        """The barycentric weights (k, 3) of the triangle's corners at these covered pixels."""
        planes = self.planes[self.number[rows, columns]]
        shares = planes[:, :, 0] * (columns + 0.5)[:, None] + planes[:, :, 1] * (rows + 0.5)[:, None] + planes[:, :, 2]
        shares = np.maximum(shares, 0.0)
        return np.array(shares / shares.sum(axis=1, keepdims=True))


def rasterize(corners: Array, size: tuple[int, int]) -> Raster:
    """Find the nearest triangle at each pixel.

    A pixel's ray d = (x, y, 1) meets the plane of a triangle with corners P = [p0 p1 p2] at P u = d: inside where all
    u ≥ 0, at the depth 1/Σu (Olano and Greer 1997). So u is linear in x and y, and on each row of pixels a triangle
    covers one interval.

    Args:
        corners: The triangles' corners (n, 3, 3) as (right, down, ahead); a corner appears at the pixel
            (right/ahead, down/ahead). A triangle with a corner behind the camera is left out.
        size: Width and height [pixels].
    """
    width, height = size
    found = _touching(corners, width, height)
    p, q, r = (corners[found, k] for k in range(3))
    planes = np.stack([_cross(q, r), _cross(r, p), _cross(p, q)], axis=1)
    volume = (p * planes[:, 0]).sum(axis=1)
    thick = np.abs(volume) > 1e-14 * np.sqrt((planes[:, 0] ** 2).sum(axis=1) * (p**2).sum(axis=1))
    found, planes = found[thick], planes[thick] / volume[thick, None, None]
    nearest = np.zeros(width * height, np.uint64)  # 1/depth as float32, whose bits are ordered as it is; then the index
    for spans in _spans(corners[found], planes, width, height):
        pixel, number, inverse_depth = _fragments(spans, width)
        key = inverse_depth.view(np.uint32).astype(np.uint64) << np.uint64(32) | number.astype(np.uint64)
        np.maximum.at(nearest, pixel, key)
    covered = nearest > 0
    inverse = (nearest >> np.uint64(32)).astype(np.uint32).view(np.float32)
    depth = np.divide(1.0, inverse, out=np.full(nearest.size, np.inf), where=covered)
    number = np.where(covered, (nearest & np.uint64(0xFFFFFFFF)).astype(np.int64), -1)
    return Raster(number.reshape(height, width), depth.reshape(height, width), found, planes)


def _touching(corners: Array, width: int, height: int) -> Ints:
    """Indices of the triangles whose bounding box holds the centre of a pixel."""
    depth = corners[:, :, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        inside = _least(depth) > 0.0
        for axis, side in ((0, width), (1, height)):
            at = corners[:, :, axis] / depth - 0.5
            inside &= np.maximum(np.ceil(_least(at) - _SLACK), 0) <= np.minimum(np.floor(_most(at) + _SLACK), side - 1)
    return np.flatnonzero(inside)


@dataclass(frozen=True)
class _Spans:
    """Runs of pixels in one row, each covered by one triangle; at column x, 1/depth is `slope` x + `start`."""

    number: Ints
    row: Ints
    first: Ints
    count: Ints
    slope: Array
    start: Array


def _spans(corners: Array, planes: Array, width: int, height: int) -> Iterator[_Spans]:
    """The runs that the triangles cover, some million pixels at a time."""
    y = corners[:, :, 1] / corners[:, :, 2] - 0.5
    top = np.maximum(np.ceil(_least(y)), 0).astype(np.int64)
    bottom = np.minimum(np.floor(_most(y)), height - 1).astype(np.int64)
    rows = np.maximum(bottom - top + 1, 0)
    for part in _parts(rows, _AT_ONCE // 4):
        number = np.repeat(np.arange(len(rows))[part], rows[part])
        row = np.repeat(top[part], rows[part]) + _counted(rows[part])
        plane = planes[number]
        slope, start = plane[:, :, 0], plane[:, :, 1] * (row + 0.5)[:, None] + plane[:, :, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -start / slope - 0.5
        low = _most(np.where(slope > 0.0, crossing, -np.inf))
        high = _least(np.where(slope < 0.0, crossing, np.inf))
        first = np.ceil(np.clip(low - _SLACK, 0, width)).astype(np.int64)
        last = np.floor(np.clip(high + _SLACK, -1, width - 1)).astype(np.int64)
        beside = _most((slope == 0.0) & (start < 0.0))
        count = np.where(beside, 0, np.maximum(last - first + 1, 0))
        kept = np.flatnonzero(count)
        slopes, starts = slope[:, 0] + slope[:, 1] + slope[:, 2], start[:, 0] + start[:, 1] + start[:, 2]
        for some in _parts(count[kept], _AT_ONCE):
            k = kept[some]
            yield _Spans(number[k], row[k], first[k], count[k], slopes[k], starts[k])


def _fragments(spans: _Spans, width: int) -> tuple[Ints, Ints, NDArray[np.float32]]:
    """The pixel, the triangle's number and 1/depth, for every pixel of the runs."""
    which = np.repeat(np.arange(len(spans.count)), spans.count)
    column = spans.first[which] + _counted(spans.count)
    inverse = spans.slope[which] * (column + 0.5) + spans.start[which]
    return spans.row[which] * width + column, spans.number[which], np.maximum(inverse, 1e-30).astype(np.float32)


def _counted(counts: Ints) -> Ints:
    """0, 1, … up to each count, joined into one array."""
    ends = np.cumsum(counts)
    return np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - counts, counts)


def _parts(counts: Ints, most: int) -> Iterator[slice]:
    """Consecutive slices whose counts add up to about `most` each."""
    if len(counts):
        group = np.cumsum(counts) // most
        edges = [0, *(np.flatnonzero(np.diff(group)) + 1), len(counts)]
        yield from (slice(a, b) for a, b in itertools.pairwise(edges))


# For three columns, numpy's own reductions and cross product take several times as long.


def _least(values: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(np.minimum(np.minimum(values[:, 0], values[:, 1]), values[:, 2]))


def _most(values: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(np.maximum(np.maximum(values[:, 0], values[:, 1]), values[:, 2]))


def _cross(a: Array, b: Array) -> Array:
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)
