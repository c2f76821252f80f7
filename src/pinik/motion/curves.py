"""Closed curves that a ball can follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["CURVES", "Curve", "polyline"]

Array = NDArray[np.float64]


class Curve(NamedTuple):
    """A closed curve.

    Attributes:
        title: The name shown to users.
        point: Function from phase in [0, 1) to a point (u, v, w) in the unit ball: u sideways, v up, w towards the
            viewer.
    """

    title: str
    point: Callable[[float], tuple[float, float, float]]


def _circle(phase: float) -> tuple[float, float, float]:
    t = 2.0 * math.pi * phase
    return math.cos(t), math.sin(t), 0.0


def _eight(phase: float) -> tuple[float, float, float]:
    """Bernoulli's lemniscate, stretched vertically by √2."""
    t = 2.0 * math.pi * phase
    size = 1.0 / (1.0 + math.sin(t) ** 2)
    return size * math.cos(t), size * math.sin(t) * math.cos(t) * math.sqrt(2.0), 0.0


def _square(phase: float) -> tuple[float, float, float]:
    side, along = divmod(4.0 * (phase % 1.0), 1.0)
    u, v = ((1.0, 2 * along - 1), (1 - 2 * along, 1.0), (-1.0, 1 - 2 * along), (2 * along - 1, -1.0))[int(side)]
    return u * math.sqrt(0.5), v * math.sqrt(0.5), 0.0


def _knot(phase: float) -> tuple[float, float, float]:
    """A trefoil knot."""
    t = 2.0 * math.pi * phase
    return (
        (math.sin(t) + 2.0 * math.sin(2.0 * t)) / 3.0,
        (math.cos(t) - 2.0 * math.cos(2.0 * t)) / 3.0,
        -math.sin(3.0 * t) / 3.0,
    )


def _wave(phase: float) -> tuple[float, float, float]:
    """A curve that looks like a circle from above, and rises and falls four times."""
    t = 2.0 * math.pi * phase
    return 0.9 * math.cos(t), 0.35 * math.sin(4.0 * t), 0.9 * math.sin(t)


CURVES: dict[str, Curve] = {
    "circle": Curve("Circle", _circle),
    "eight": Curve("Figure eight", _eight),
    "square": Curve("Square, with corners", _square),
    "knot": Curve("Trefoil knot", _knot),
    "wave": Curve("Wave", _wave),
}
"""Name → curve."""


def polyline(curve: Curve, center: Array, axes: Array, count: int = 128) -> Array:
    """Points (count, 3) [m] on a curve around `center` (3,) [m]; the rows of `axes` (3, 3) [m] are u, v and w."""
    unit = np.array([curve.point(k / count) for k in range(count)])
    return np.asarray(center + unit @ axes)
