"""Regions of equal area on the unit sphere, each with a direction in its middle."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["Directions"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class Directions:
    """The unit sphere in N regions of equal area: a cap around each pole, and zones that are cut into equal parts.

    This is Leopardi's recursive zonal partition (2006, "A partition of the unit sphere into regions of equal area and
    small diameter"), with the zones bounded so that all areas are equal exactly. The first region is the cap about +z,
    and the last one that about −z.

    Attributes:
        vectors: The direction in the middle of each region (N, 3).
    """

    def __init__(self, count: int) -> None:
        """Make `count` regions, at least 1."""
        self._parts = np.array(_parts(count), dtype=np.int64)  # of each zone, from +z to −z
        self._first = np.concatenate([[0], np.cumsum(self._parts)])  # region of each zone, and the number of all
        heights = 1.0 - 2.0 * self._first / count  # the area of a zone is proportional to its height
        self._ends = heights[1:-1]
        angles = np.arccos(np.clip(heights, -1.0, 1.0))
        middles = 0.5 * (angles[1:] + angles[:-1])
        if count > 1:
            middles[0], middles[-1] = 0.0, math.pi
        polar = np.repeat(middles, self._parts)
        azimuth = np.concatenate([2.0 * math.pi * np.arange(parts) / parts for parts in self._parts])
        self.vectors = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], 1)
        self.vectors[np.abs(self.vectors) < 1e-15] = 0.0

    def __len__(self) -> int:
        """The number of regions."""
        return len(self.vectors)

    def regions_of(self, vectors: Array) -> Indices:
        """The numbers (n,) of the regions in which unit vectors (n, 3) lie."""
        zone = np.searchsorted(-self._ends, -vectors[:, 2], side="right")
        parts = self._parts[zone]
        turn = np.arctan2(vectors[:, 1], vectors[:, 0]) * (parts / (2.0 * math.pi))
        return np.asarray(self._first[zone] + np.floor(turn + 0.5).astype(np.int64) % parts)


def _parts(count: int) -> list[int]:
    """Into how many parts each zone is cut."""
    if count <= 2:
        return [1] * count
    cap = math.acos(1.0 - 2.0 / count)
    zones = max(1, round((math.pi - 2.0 * cap) / math.sqrt(4.0 * math.pi / count)))
    height = (math.pi - 2.0 * cap) / zones
    ends = [0.5 * count * (1.0 - math.cos(cap + k * height)) for k in range(zones + 1)]
    whole = [round(end) for end in ends]
    return [1, *(after - before for before, after in itertools.pairwise(whole)), 1]
