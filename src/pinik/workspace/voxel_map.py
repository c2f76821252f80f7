"""What a robot can reach, cell by cell, and questions about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, Self, TypeAlias

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number
from ..errors import InputError, UnknownNameError
from ..robot import Robot
from ..solving.places import read_placements
from .counts import QUANTA, Counts
from .grid import Grid
from .orientations import Orientations

__all__ = ["WORKSPACES", "Places", "Reached", "VoxelMap", "Workspace", "as_least_share"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

WORKSPACES = ("any", "down", "dexterous")
"""The named workspaces: reached in any orientation, with the tool pointing down, or in all orientations."""

Workspace: TypeAlias = str | float
Places: TypeAlias = ArrayLike | pinocchio.SE3 | Sequence[pinocchio.SE3]


class Reached(NamedTuple):
    """What a map says about one place.

    Attributes:
        reached: Whether the place is reached: in its orientation, or in any if only a position was given.
        share: The share of the orientations in which the cell is reached, in 0..1.
        manipulability: The mean manipulability in the cell; NaN if it is not reached.
        room: The mean distance to the joint limits in the cell, 0 at a limit and 1 in the middle of all ranges; NaN if
            it is not reached.
        branches: The mean number of distinct answers for each orientation that is reached; NaN if not counted.
        center: The centre of the cell (3,) [m].
    """

    reached: bool
    share: float
    manipulability: float
    room: float
    branches: float
    center: Array


@dataclass(frozen=True, eq=False)
class VoxelMap:
    """What a robot can reach: for each cell of a grid, in which orientations, how well, and how near the joint limits.

    Places are expressed in the map's reference: the world, or the frame `relative_to`. A map by samples says that some
    place in a cell, with an orientation near the asked one, is reached. A map by solves says that the middle of the
    cell is reached in exactly that orientation.

    Attributes:
        robot: The robot's name.
        frame: The frame that reaches.
        relative_to: The frame that takes the place of the world; None for the world.
        tool: The placement of the tool in the frame (4, 4); None for the frame itself.
        grid: The cells: `origin`, the centre of the first one [m], `size` of their edges [m], and `shape`.
        orientations: The orientations that are told apart: `vectors` and `rotations`.
        samples: The number of random configurations; 0 for a map by solves.
        counts_branches: Whether distinct answers were counted.
        unit: For pinik itself: the unit in which manipulabilities are counted.
        counts: For pinik itself: what was found.
        machine: The robot; None for a map that was read from a file.
    """

    robot: str
    frame: str
    relative_to: str | None
    tool: Array | None
    grid: Grid
    orientations: Orientations
    samples: int
    counts_branches: bool
    unit: float
    counts: Counts = field(repr=False)
    machine: Robot | None = field(default=None, repr=False)

    @cached_property
    def _rows(self) -> NDArray[np.int64]:
        """The row of each cell in the counts, −1 for cells that were not asked for, and for the last, outside."""
        rows = np.full(len(self.grid) + 1, -1, dtype=np.int64)
        rows[self.counts.cells] = np.arange(len(self.counts.cells))
        return rows

    def _dense(self, values: NDArray[Any], otherwise: float) -> Any:
        """Values of the counts's rows (n,) as an array of the grid's shape."""
        dense = np.full(len(self.grid), otherwise, dtype=values.dtype)
        dense[self.counts.cells] = values
        return dense.reshape(self.grid.shape)

    def _means(self, sums: NDArray[np.int64], per: NDArray[np.int64], unit: float) -> Array:
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(sums / per * unit)

    @cached_property
    def share(self) -> Array:
        """The share of the orientations that are reached in each cell, of the grid's shape, in 0..1."""
        return np.asarray(self._dense(self.counts.reached.mean(axis=1), 0.0))

    @cached_property
    def manipulability(self) -> Array:
        """The mean manipulability √det(J Jᵀ) in each cell; NaN where nothing is reached.

        The mean is over the samples in the cell, or over the orientations that are solved for. J has the linear rows
        [m/rad], and the angular rows too if orientations are told apart.
        """
        return np.asarray(
            self._dense(self._means(self.counts.manipulability, self.counts.found, self.unit / QUANTA), np.nan)
        )

    @cached_property
    def room(self) -> Array:
        """The mean distance to the joint limits in each cell: 0 at one, 1 amid all ranges; NaN if unreached."""
        return np.asarray(self._dense(self._means(self.counts.room, self.counts.found, 1.0 / QUANTA), np.nan))

    @cached_property
    def branches(self) -> Array:
        """The mean number of distinct answers for each orientation that is reached; NaN where there is none.

        Raises:
            InputError: They were not counted.
        """
        if not self.counts_branches:
            raise InputError("the distinct answers were not counted; pinik.reach(..., branches=True) does")
        return np.asarray(self._dense(self._means(self.counts.branches, self.counts.found, 1.0), np.nan))

    def workspace(self, workspace: Workspace = "any") -> Mask:
        """Which cells belong to a workspace, an array of the grid's shape.

        Args:
            workspace: "any": reached in some orientation. "down": with the approach axis pointing to −z, with some
                roll. "dexterous": in all orientations. Or a number in 0..1: in at least this share of them.

        Raises:
            UnknownNameError: There is no such workspace.
            InputError: A number outside 0..1; or "down", and the map does not tell directions apart.
        """
        reached = self.counts.reached
        if not isinstance(workspace, str):
            least = as_least_share(workspace)
            return np.asarray(self._dense(reached.mean(axis=1) >= least - 1e-12, False))
        if workspace not in WORKSPACES:
            raise UnknownNameError("workspace", workspace, WORKSPACES)
        if workspace == "down" and self.orientations.directions < 2:
            raise InputError(
                "this map does not tell approach directions apart, so it has no workspace 'down'; make one with "
                "directions=48 (--directions 48)"
            )
        if workspace == "dexterous":
            return np.asarray(self._dense(np.asarray(reached.all(axis=1)), False))
        asked = reached[:, self.orientations.down] if workspace == "down" else reached
        return np.asarray(self._dense(np.asarray(asked.any(axis=1)), False))

    def volume(self, workspace: Workspace = "any") -> float:
        """The volume of a workspace [m³]: its cells times the volume of one."""
        return float(self.workspace(workspace).sum() * self.grid.size**3)

    def bounds(self, workspace: Workspace = "any") -> Array:
        """The box around the cells of a workspace: its lower and upper corner (2, 3) [m]; NaN if it is empty."""
        cells = np.flatnonzero(self.workspace(workspace))
        if not len(cells):
            return np.full((2, 3), np.nan)
        centers = self.grid.centers(cells)
        half = 0.5 * self.grid.size
        return np.array([centers.min(axis=0) - half, centers.max(axis=0) + half])

    def at(self, place: Places) -> Reached:
        """What the map says about one place: a position (3,) [m], an SE3, or a homogeneous matrix (4, 4).

        Raises:
            InputError: It is not one.
        """
        rotations, points = _one(place)
        cell = int(self.grid.cells_at(points)[0])
        row = int(self._rows[cell])
        reached = bool(self._reached(rotations, points)[0])
        if row < 0 or not self.counts.found[row]:
            center = self.grid.centers(np.array([cell]))[0] if cell >= 0 else np.full(3, np.nan)
            return Reached(reached, 0.0, np.nan, np.nan, np.nan, center)
        branches = float(self.branches.flat[cell]) if self.counts_branches else np.nan
        return Reached(
            reached,
            float(self.share.flat[cell]),
            float(self.manipulability.flat[cell]),
            float(self.room.flat[cell]),
            branches,
            self.grid.centers(np.array([cell]))[0],
        )

    def filter(self, places: Places, workspace: Workspace = "any") -> Mask:
        """Which of N places are reached (N,).

        Args:
            places: Positions (N, 3) [m], homogeneous matrices (N, 4, 4) or N SE3, each of which is reached in its
                own orientation.
            workspace: Count only cells of this workspace.

        Raises:
            InputError: A place is faulty; the message names the first one.
        """
        rotations, points = read_placements(places)
        reached = self._reached(rotations, points)
        if workspace != "any":
            cells = self.grid.cells_at(points)
            reached &= np.where(cells >= 0, self.workspace(workspace).ravel()[cells], False)
        return reached

    def reached_in(self, cells: NDArray[np.int64], orientations: NDArray[np.int64] | None) -> Mask:
        """Whether cells (n,) are reached in these orientations (n,), or in any when None; −1 is outside the grid."""
        rows = self._rows[cells]
        known = np.flatnonzero(rows >= 0)
        reached = np.zeros(len(rows), dtype=bool)
        if orientations is None:
            reached[known] = self.counts.found[rows[known]] > 0
        else:
            reached[known] = self.counts.reached[rows[known], orientations[known]]
        return reached

    def _reached(self, rotations: Array | None, points: Array) -> Mask:
        regions = None if rotations is None else self.orientations.regions_of(rotations)
        return self.reached_in(self.grid.cells_at(points), regions)

    def nearest_reachable(self, place: Places, workspace: Workspace = "any") -> tuple[Any, float]:
        """The nearest place that is reached, and how far away it is.

        Args:
            place: A position (3,) [m], an SE3 or a matrix (4, 4).
            workspace: Count only cells of this workspace.

        Returns:
            (the place itself if its cell is reached, else the centre of the nearest cell that is: of the same kind as
            `place`, with the orientation of `place`; its distance [m]). (None, infinity) if there is none.
        """
        rotations, points = _one(place)
        inside = self.workspace(workspace).ravel()
        if rotations is not None:
            orientation = int(self.orientations.regions_of(rotations)[0])
            inside = inside & self._dense(self.counts.reached[:, orientation], False).ravel()
        cells = np.flatnonzero(inside)
        if not len(cells):
            return None, np.inf
        if int(self.grid.cells_at(points)[0]) in cells:
            return place, 0.0
        centers = self.grid.centers(cells)
        distances = np.linalg.norm(centers - points[0], axis=1)
        nearest = centers[np.argmin(distances)]
        found: Any = nearest
        if rotations is not None:
            found = pinocchio.SE3(rotations[0], nearest)
            found = found if isinstance(place, pinocchio.SE3) else np.array(found.homogeneous)
        return found, float(distances.min())

    def agreement(self, other: Self) -> dict[str, float]:
        """How far two maps of the same grid and orientations agree.

        Returns:
            "both", "only_this", "only_other": the numbers of cells and orientations that are reached in both maps or in
            one of them. "share": the share in both of those in either. "cells": the same share for cells alone.

        Raises:
            InputError: They differ in grid or orientations.
        """
        one, two = self.orientations, other.orientations
        same = (one.directions, one.rolls) == (two.directions, two.rolls) and np.allclose(one.axis, two.axis)
        if self.grid != other.grid or not same:
            raise InputError("the maps must have the same cells and orientations")
        a, b = (np.zeros((len(self.grid), len(one)), dtype=bool) for _ in range(2))
        a[self.counts.cells], b[other.counts.cells] = self.counts.reached, other.counts.reached
        both, either = int((a & b).sum()), int((a | b).sum())
        cells = (a.any(axis=1) & b.any(axis=1)).sum() / max((a.any(axis=1) | b.any(axis=1)).sum(), 1)
        return {
            "both": both,
            "only_this": int(a.sum()) - both,
            "only_other": int(b.sum()) - both,
            "share": both / max(either, 1),
            "cells": float(cells),
        }

    def __str__(self) -> str:
        way = f"{self.samples:,} samples" if self.samples else "solves"
        reached = int(self.counts.reached.any(axis=1).sum())
        words = f"{self.frame} of {self.robot} reaches {reached:,} of {len(self.grid):,} cells of {self.grid.size:g} m"
        words += f" ({self.volume():.3g} m³)"
        if len(self.orientations) > 1 and reached:
            inside = self.share[self.workspace("any")]
            words += f", in {100.0 * inside.mean():.0f} % of {len(self.orientations)} orientations on average"
            words += f" and {100.0 * inside.max():.0f} % at best"
        return f"{words}, by {way}"

    def require_robot(self, robot: Robot | None, what: str) -> Robot:
        """For pinik itself: the robot that was given, or the map's own; InputError if there is none."""
        machine = self.machine if robot is None else robot
        if not isinstance(machine, Robot):
            raise InputError(f"{what} needs the robot, which a map from a file does not hold: give robot=")
        return machine


def as_least_share(workspace: float) -> float:
    """A workspace that is given as the least share of the orientations; InputError unless it is in (0, 1]."""
    least = as_finite_number(workspace, "workspace")
    if not 0.0 < least <= 1.0:
        raise InputError(f"must be a name or a share in (0, 1]; got {workspace!r}", argument="workspace")
    return least


def _one(place: Places) -> tuple[Array | None, Array]:
    """(the rotation (1, 3, 3) or None, the point (1, 3)) of one place."""
    return read_placements([place])
