"""Targets and starts of each task: random poses, a smooth closed path, or joint values whose placement is asked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .arms import Arm

__all__ = ["TASKS", "Problems", "make_problems"]

Array = NDArray[np.float64]

# What is asked, and what a row of it means.
TASKS = {
    "poses": "random reachable poses, random starts",
    "path": "a smooth path, each start the last answer",
    "still": "each start solves its target already, so no iteration is needed",
    "tolerance": "random reachable poses, random starts, tighter and tighter tolerances",
    "batch": "random reachable poses, random starts, all in one call",
    "forward": "placements of random joint values: no inverse kinematics",
}
PATH_POINTS = 1000
# How far the path leaves the middle of a joint's range: this part of the half range, and no more than that [rad].
PATH_PART, PATH_REACH = 0.6, 1.0
WARM_UP = CHECK = 10


@dataclass(frozen=True)
class Problems:
    """N targets of one arm.

    Attributes:
        task: One of TASKS.
        targets: Where the tip should be, N placements.
        starts: Joint values to start from (N, n), those of the targets for "forward"; on a path the first row counts.
        warm_up: Targets and starts that every peer solves first, untimed.
        check: Targets next to their starts, along a path: who places none of them means other frames or joints.
    """

    task: str
    targets: list[pinocchio.SE3]
    starts: Array
    warm_up: tuple[list[pinocchio.SE3], Array]
    check: tuple[list[pinocchio.SE3], Array]


def make_problems(arm: Arm, task: str, count: int, seed: int) -> Problems:
    """Draw the problems of a task; the same ones for the same seed."""
    rng = np.random.default_rng([seed, task == "path", *arm.name.encode()])
    path = _closed_path(arm, rng) if task == "path" else None
    if path is None:
        goals = np.array([arm.random(rng) for _ in range(count)])
        starts = goals if task in ("still", "forward") else np.array([arm.random(rng) for _ in range(count)])
        path = _closed_path(arm, rng)
    else:
        goals = path[np.arange(count) % PATH_POINTS]
        starts = path[np.arange(-1, count - 1) % PATH_POINTS]
    warm_up = np.array([arm.random(rng) for _ in range(2 * WARM_UP)])
    before = path[:CHECK] if task == "forward" else path[np.arange(-1, CHECK - 1)]
    return Problems(
        task,
        _placements(arm, goals),
        starts,
        (_placements(arm, warm_up[:WARM_UP]), warm_up[WARM_UP:]),
        (_placements(arm, path[:CHECK]), before),
    )


def _placements(arm: Arm, q: Array) -> list[pinocchio.SE3]:
    return [arm.placement(each) for each in q]


def _closed_path(arm: Arm, rng: np.random.Generator) -> Array:
    """Joint values (PATH_POINTS, n) along a closed curve: in each joint a sum of two sines, well inside the limits."""
    middle = (arm.lower + arm.upper) / 2
    reach = np.minimum(PATH_PART * (arm.upper - arm.lower) / 2, PATH_REACH)
    first, second = rng.uniform(0, 2 * np.pi, (2, len(arm.joints)))
    angle = 2 * np.pi * np.arange(PATH_POINTS)[:, None] / PATH_POINTS
    path: Array = middle + reach * (0.6 * np.sin(angle + first) + 0.4 * np.sin(2 * angle + second))
    return path
