"""Targets and starts: random poses, and a smooth closed path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .arms import Arm

__all__ = ["TASKS", "Problems", "make_problems"]

Array = NDArray[np.float64]

TASKS = ("poses", "path")
PATH_POINTS = 1000
# How far the path leaves the middle of a joint's range: this part of the half range, and no more than that [rad].
PATH_PART, PATH_REACH = 0.6, 1.0
WARM_UP = 10


@dataclass(frozen=True)
class Problems:
    """N targets of one arm.

    Attributes:
        task: "poses", each with its own start, or "path", where each answer is the next start.
        targets: Where the tip should be, N placements.
        starts: Joint values to start from (N, n); on a path the first row is the first start.
        warm_up: Targets and starts that every peer solves first, untimed.
    """

    task: str
    targets: list[pinocchio.SE3]
    starts: Array
    warm_up: list[tuple[pinocchio.SE3, Array]]


def make_problems(arm: Arm, task: str, count: int, seed: int) -> Problems:
    """Draw the problems of a task; the same ones for the same seed."""
    rng = np.random.default_rng([seed, TASKS.index(task), *arm.name.encode()])
    if task == "poses":
        goals = np.array([arm.random(rng) for _ in range(count)])
        starts = np.array([arm.random(rng) for _ in range(count)])
    else:
        points = _closed_path(arm, rng)
        goals = points[np.arange(count) % PATH_POINTS]
        starts = points[np.arange(-1, count - 1) % PATH_POINTS]
    warm_up = [(arm.placement(arm.random(rng)), arm.random(rng)) for _ in range(WARM_UP)]
    return Problems(task, [arm.placement(q) for q in goals], starts, warm_up)


def _closed_path(arm: Arm, rng: np.random.Generator) -> Array:
    """Joint values (PATH_POINTS, n) along a closed curve: in each joint a sum of two sines, well inside the limits."""
    middle = (arm.lower + arm.upper) / 2
    reach = np.minimum(PATH_PART * (arm.upper - arm.lower) / 2, PATH_REACH)
    first, second = rng.uniform(0, 2 * np.pi, (2, len(arm.joints)))
    angle = 2 * np.pi * np.arange(PATH_POINTS)[:, None] / PATH_POINTS
    path: Array = middle + reach * (0.6 * np.sin(angle + first) + 0.4 * np.sin(2 * angle + second))
    return path
