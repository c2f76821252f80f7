"""Where to put a robot's base so that it reaches given targets."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_array, as_count, as_positive_number
from ..errors import InputError
from ..solving.many import solve_many
from ..solving.origin import Origin
from ..solving.places import read_placements
from .voxel_map import VoxelMap

__all__ = ["Bases", "find_bases"]

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

_AT_ONCE = 2**20  # targets seen from bases
_MOST_SPOTS = 2**20


@dataclass(frozen=True, eq=False)
class Bases:
    """Places for a robot's base, best first.

    Attributes:
        placements: The placements of the map's reference in the world of the targets (n, 4, 4) [m].
        reached: How many targets the map says are reached from each (n,).
        solved: How many are reached exactly, by solving for them (n,); None if the robot is not known.
        margin: The mean share of the orientations that are reached in the cells of the targets (n,), in 0..1.
        targets: The number of targets.
    """

    placements: Array
    reached: Counts
    solved: Counts | None
    margin: Array
    targets: int

    def __len__(self) -> int:
        """The number of bases."""
        return len(self.placements)

    def __str__(self) -> str:
        if not len(self):
            return f"no base reaches any of the {self.targets} targets"
        x, y, z = self.placements[0, :3, 3]
        yaw = math.degrees(math.atan2(self.placements[0, 1, 0], self.placements[0, 0, 0]))
        count = self.reached[0] if self.solved is None else self.solved[0]
        return f"best base: x {x:.3f} m, y {y:.3f} m, z {z:.3f} m, yaw {yaw:.0f}°: {count} of {self.targets} targets"


def find_bases(
    reach: VoxelMap,
    targets: Any,
    *,
    heights: ArrayLike,
    yaws: int,
    step: float | None,
    most: int,
    options: Mapping[str, Any],
) -> Bases:
    """See `ReachMap.bases`."""
    rotations, points = read_placements(targets)
    levels = as_array(np.atleast_1d(np.asarray(heights, dtype=np.float64)), np.atleast_1d(heights).shape, "heights")
    count, most = as_count(yaws, "yaws"), as_count(most, "most")
    step = reach.grid.size if step is None else as_positive_number(step, "step", "metres")
    if not len(points):
        return Bases(np.zeros((0, 4, 4)), np.zeros(0, dtype=np.int64), None, np.zeros(0), 0)
    floor = _floor(reach, points, step)
    found: list[tuple[Array, Counts, Array]] = []
    for angle in 2.0 * math.pi * np.arange(count) / count:
        turn = np.array([[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0, 0, 1]])
        for height in levels:
            spots = np.column_stack([floor, np.full(len(floor), height)])
            reached, margin = _seen_from(reach, spots, turn, rotations, points)
            best = np.lexsort((-margin, -reached))[:most]
            best = best[reached[best] > 0]
            places = np.tile(np.eye(4), (len(best), 1, 1))
            places[:, :3, :3], places[:, :3, 3] = turn, spots[best]
            found.append((places, reached[best], margin[best]))
    placements, reached, margin = (np.concatenate(parts) for parts in zip(*found, strict=True))
    best = np.lexsort((-margin, -reached))[:most]
    placements, reached, margin = placements[best], reached[best], margin[best]
    solved = _solved(reach, placements, targets, options)
    if solved is not None:
        best = np.lexsort((-margin, -solved))
        placements, reached, margin, solved = placements[best], reached[best], margin[best], solved[best]
    return Bases(placements, reached, solved, margin, len(points))


def _floor(reach: VoxelMap, points: Array, step: float) -> Array:
    """The x and y of all bases from which some target is inside the map (n, 2) [m]."""
    corners = (
        np.array(reach.grid.origin),
        np.array(reach.grid.origin) + reach.grid.size * (np.array(reach.grid.shape) - 1),
    )
    farthest = max(float(np.linalg.norm(corner[:2])) for corner in corners)
    lower, upper = points[:, :2].min(axis=0) - farthest, points[:, :2].max(axis=0) + farthest
    count = math.prod(math.ceil(span) + 2 for span in ((upper - lower) / step).tolist())
    if count > _MOST_SPOTS:
        raise InputError(
            f"the targets need {count:.3g} bases to be tried, and at most {_MOST_SPOTS} are possible: they are too far "
            "apart, or the step is too small"
        )
    x, y = (step * np.arange(math.floor(a / step), math.ceil(b / step) + 1) for a, b in zip(lower, upper, strict=True))
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def _seen_from(
    reach: VoxelMap, spots: Array, turn: Array, rotations: Array | None, points: Array
) -> tuple[Counts, Array]:
    """(how many targets are reached from each spot, the mean share of orientations reached where they are)."""
    share = reach.share.ravel()
    regions = None if rotations is None else reach.orientations.regions_of(turn.T @ rotations)
    reached, margin = [], []
    for part in np.array_split(spots, -(-len(spots) * len(points) // _AT_ONCE)):
        cells = reach.grid.cells_at(((points[None] - part[:, None]) @ turn).reshape(-1, 3))
        hit = reach.reached_in(cells, None if regions is None else np.tile(regions, len(part)))
        shares = np.where(hit, share[cells], 0.0).reshape(len(part), -1)
        reached.append(hit.reshape(len(part), -1).sum(axis=1))
        margin.append(shares.mean(axis=1))
    return np.concatenate(reached), np.concatenate(margin)


def _solved(reach: VoxelMap, placements: Array, targets: Any, options: Mapping[str, Any]) -> Counts | None:
    """How many targets are reached from each base, by solving for them; None if the robot is not known."""
    if reach.machine is None:
        return None
    rotations, points = read_placements(targets)
    start = Origin.of(reach.machine, options.get("q0"), searches=False).q
    own = {**options, "q0": start, "tool": reach.tool, "relative_to": reach.relative_to}
    counts = []
    for base in placements:
        local = (points - base[:3, 3]) @ base[:3, :3]
        places = local
        if rotations is not None:
            places = np.tile(np.eye(4), (len(points), 1, 1))
            places[:, :3, :3], places[:, :3, 3] = base[:3, :3].T @ rotations, local
        answers = solve_many(reach.machine, reach.frame, places, **own)
        counts.append(int(answers.success.sum()))
    return np.array(counts, dtype=np.int64)
