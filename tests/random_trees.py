"""URDF texts of random trees: every kind of joint, any size, any limits, followers, and joints that cannot move."""

from __future__ import annotations

import math

import numpy as np

from by_hand import axis, limit, mimic, origin
from urdf_texts import joint, link, robot

MOST_JOINTS = 60
MOST_FREEDOMS = 80  # Pinocchio's memory grows with their third power
AXES = np.vstack([np.eye(3), -np.eye(3)])
KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
FREEDOMS = {"revolute": 1, "continuous": 1, "prismatic": 1, "fixed": 0, "floating": 6, "planar": 3}


def random_tree(rng: np.random.Generator) -> str:
    """The text of a tree with 1 to 60 joints, 15 on average; its links are l0, l1, …"""
    count = 1 + int(MOST_JOINTS * rng.random() ** 3)
    size = 10.0 ** rng.uniform(-2.0, 1.0) if rng.random() < 0.3 else 0.3  # [m]
    likely = rng.dirichlet([3.0, 1.0, 1.0, 0.7, 0.15, 0.15])
    stretch = rng.choice([0.0, 0.1, 0.6])  # how often a joint hangs on another link than the last one
    parts, freedoms = [], 0
    leaders: dict[str, tuple[str, float]] = {}
    for i in range(count):
        kind = str(rng.choice(KINDS, p=likely))
        freedoms += FREEDOMS[kind]
        if freedoms > MOST_FREEDOMS:
            break
        parent = int(rng.integers(0, i + 1)) if rng.random() < stretch else i
        words, bounds = [_origin(rng, size)], ""
        if kind in ("revolute", "continuous", "prismatic"):
            words.append(axis(*_axis(rng)))
            low, high = _limits(rng, kind, size)
            fit = [name for name, (leader, _) in leaders.items() if (leader, kind) != ("continuous", "prismatic")]
            if fit and rng.random() < 0.15:
                leader = str(rng.choice(fit))
                multiplier, offset = float(rng.choice([1.0, -1.0, 0.5, 2.0, 0.0, rng.normal()])), float(rng.normal())
                words.append(mimic(leader, multiplier, offset))
                middle = multiplier * leaders[leader][1] + offset
                low, high = middle - rng.uniform(0.5, 3.0), middle + rng.uniform(0.5, 3.0)
            else:
                leaders[f"j{i}"] = (kind, 0.5 * (low + high) if kind != "continuous" else 0.0)
            bounds = "" if kind == "continuous" else limit(low, high)
        parts.append(joint(f"j{i}", f"l{parent}", f"l{i + 1}", *words, kind=kind, limit=bounds))
    return robot(*(link(f"l{i}") for i in range(len(parts) + 1)), *parts)


def _origin(rng: np.random.Generator, size: float) -> str:
    """A random place, now and then none, along one axis, or far away."""
    xyz, rpy = size * rng.normal(size=3), rng.uniform(-math.pi, math.pi, 3)
    drawn = rng.random()
    if drawn < 0.3:
        xyz[rng.random(3) < 0.6] = 0.0
        rpy = rng.integers(-2, 3, 3) * math.pi / 2.0
    elif drawn < 0.32:
        xyz *= 1e3
    if rng.random() < 0.5:
        rpy = np.zeros(3)
    return origin(xyz.tolist(), rpy.tolist())


def _axis(rng: np.random.Generator) -> list[float]:
    return (rng.choice(AXES) if rng.random() < 0.6 else rng.normal(size=3)).tolist()


def _limits(rng: np.random.Generator, kind: str, size: float) -> tuple[float, float]:
    """A range [rad or m]: usual, narrow, a single value, without zero in it, several turns, or as good as none."""
    unit = size if kind == "prismatic" else 1.0
    middle, half = unit * rng.normal(), unit * rng.uniform(0.1, math.pi)
    drawn = rng.random()
    if drawn < 0.05:
        half = 0.0
    elif drawn < 0.1:
        half *= 1e-6
    elif drawn < 0.15:
        half = 10.0 * unit
    elif drawn < 0.2:
        half = 1e16
    return middle - half, middle + half
