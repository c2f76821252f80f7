"""An even set of orientations: approach directions, each with a number of rolls about it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_count
from ..problem.target_values import as_axis
from .directions import Directions

__all__ = ["Orientations"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_MOST = 100_000


class Orientations:
    """An even set of orientations, and the regions of SO(3) of equal volume that they are in the middle of.

    The direction in which the approach axis points lies in one of the regions of `Directions`. The roll is the turn
    about it after the shortest turn from that region's own direction; it is divided evenly. Without rolls any roll
    counts, and without directions any orientation.

    Attributes:
        directions: The number of approach directions; 0 if any orientation counts.
        rolls: The number of rolls about each direction; 0 if any roll counts.
        axis: The approach axis in the frame (3,).
        vectors: The approach directions (directions, 3).
        rotations: The rotation matrices (n, 3, 3), the rolls of one direction after one another; with any roll, one of
            each direction.
    """

    def __init__(self, directions: int, rolls: int, axis: str | ArrayLike = "z") -> None:
        """Make the set.

        Raises:
            InputError: A number is negative or too large, or the axis is not one.
        """
        self.directions = as_count(directions, "directions", 0, _MOST)
        self.rolls = as_count(rolls, "rolls", 0, _MOST) if directions else 0
        as_count(self.directions * self.rolls, "directions times rolls", 0, _MOST)
        self.axis = as_axis(axis, "axis")
        self._regions = Directions(max(self.directions, 1))
        self.vectors = self._regions.vectors[: self.directions]
        self._to_z = _shortest_turns(self.axis[None], np.array([[0.0, 0.0, 1.0]]))[0]
        # Each direction's own frame: x and y of the rolls. Shortest turns from −z keep tools that point down in order.
        down = np.diag([1.0, -1.0, -1.0])
        self._frames = _shortest_turns(np.array([[0.0, 0.0, -1.0]]), self._regions.vectors) @ down
        turns = 2.0 * math.pi * np.arange(max(self.rolls, 1)) / max(self.rolls, 1)
        rolled = self._frames[:, None] @ _about_z(turns)[None]
        self.rotations = rolled.reshape(-1, 3, 3) @ self._to_z

    def __len__(self) -> int:
        """The number of orientations that are told apart, at least 1."""
        return max(self.directions, 1) * max(self.rolls, 1)

    @property
    def spacing(self) -> float:
        """About how far neighbouring directions are apart [rad]."""
        return math.sqrt(4.0 * math.pi / max(self.directions, 1))

    @property
    def down(self) -> slice:
        """For pinik itself: the orientations in which the approach axis points to −z; all if any orientation counts."""
        rolls = max(self.rolls, 1)
        return slice(len(self) - rolls, len(self)) if self.directions > 1 else slice(0, len(self))

    def regions_of(self, rotations: Array) -> Indices:
        """For pinik itself: the numbers (n,) of the orientations in whose regions rotation matrices (n, 3, 3) lie."""
        if not self.directions:
            return np.zeros(len(rotations), dtype=np.int64)
        approach = rotations @ self.axis
        region = self._regions.regions_of(approach)
        if not self.rolls:
            return region
        x = rotations @ self._to_z[0]  # the axis from which rolls are counted; its turn is a row of the turn to z
        middle = self._regions.vectors[region]
        share = (x * middle).sum(1) / (1.0 + (approach * middle).sum(1)).clip(min=1e-12)
        x = x - (approach + middle) * share[:, None]
        own = self._frames[region]
        turn = np.arctan2((x * own[:, :, 1]).sum(1), (x * own[:, :, 0]).sum(1))
        roll = np.floor(turn * (self.rolls / (2.0 * math.pi)) + 0.5).astype(np.int64) % self.rolls
        return np.asarray(region * self.rolls + roll)


def _about_z(angles: Array) -> Array:
    """Turns about z (n, 3, 3)."""
    turns = np.tile(np.eye(3), (len(angles), 1, 1))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles)
    turns[:, 1, 0] = np.sin(angles)
    turns[:, 0, 1] = -turns[:, 1, 0]
    return turns


def _shortest_turns(start: Array, ends: Array) -> Array:
    """The shortest turns (n, 3, 3) from one unit vector (1, 3) to others (n, 3); about x or y if it is a half turn."""
    cosine = (start * ends).sum(1)
    opposite = cosine < -1.0 + 1e-12
    cross = np.cross(start, ends)
    skew = np.zeros((len(ends), 3, 3))
    skew[:, 0, 1], skew[:, 0, 2], skew[:, 1, 2] = -cross[:, 2], cross[:, 1], -cross[:, 0]
    skew -= skew.transpose(0, 2, 1)
    turns = np.eye(3) + skew + skew @ skew / np.where(opposite, 1.0, 1.0 + cosine)[:, None, None]
    helper = np.eye(3)[np.argmin(np.abs(start[0]))]
    across = np.cross(start[0], helper)
    across /= np.linalg.norm(across)
    turns[opposite] = 2.0 * np.outer(across, across) - np.eye(3)
    return turns
