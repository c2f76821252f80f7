"""The arguments of `draw`, checked: configurations, colours, points, a size and a view."""

from __future__ import annotations

import operator
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_array, as_finite_number, as_point, as_points, as_vector
from ..errors import InputError, UnknownNameError
from ..model.home import home_configuration
from ..robot import Robot

__all__ = [
    "SMALLEST",
    "VIEWS",
    "as_any_points",
    "as_color",
    "as_colors",
    "as_configurations",
    "as_offsets",
    "as_opacities",
    "checked_size",
    "depth_of",
    "view_direction",
]

Array = NDArray[np.float64]

VIEWS = {"angle": (-0.6, 0.28), "front": (0.0, 0.12), "side": (-np.pi / 2, 0.12), "top": (-np.pi / 2, np.pi / 2)}
"""Name → azimuth and elevation [rad] of the camera as seen from the robot; "top" is a map with x right and y up."""

SMALLEST = 16
"""The least width and height of a picture [pixels]."""

_LARGEST, _MOST = 4000, 10_000_000  # the greatest width and height, and the most pixels in all


def view_direction(view: str | tuple[float, float]) -> Array:
    """The unit vector (3,) from a robot to the camera; `view` is a name or two angles, as for `draw`.

    Raises:
        UnknownNameError: There is no such view.
        InputError: `view` is not two angles, or its elevation is beyond ±π/2.
    """
    if isinstance(view, str):
        if view not in VIEWS:
            raise UnknownNameError("view", view, VIEWS)
        view = VIEWS[view]
    azimuth, elevation = as_vector(view, 2, "view", "the camera's azimuth and elevation in radians")
    if abs(elevation) > np.pi / 2:
        raise InputError(f"view: the camera's elevation must be between -π/2 and π/2 rad; got {elevation:g}")
    flat = np.cos(elevation) * np.array([np.cos(azimuth), np.sin(azimuth)])
    return np.array([*flat, np.sin(elevation)])


def checked_size(size: tuple[int, int]) -> tuple[int, int]:
    """Width and height [pixels]; raises InputError unless both are whole numbers in range."""
    try:
        width, height = (operator.index(side) for side in size)
        fits = all(SMALLEST <= side <= _LARGEST for side in (width, height))
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise InputError(f"size must be a width and a height of {SMALLEST} to {_LARGEST} pixels; got {size!r}")
    if width * height > _MOST:
        raise InputError(f"size must be at most {_MOST // 1_000_000} million pixels, width times height; got {size!r}")
    return width, height


def as_configurations(robot: Robot, q: ArrayLike | None) -> list[Array]:
    """One configuration or several, each (nq,); the robot's rest configuration when None."""
    if q is None:
        return [home_configuration(robot)]
    if isinstance(q, (list, tuple)) and q and all(depth_of(one) == 1 for one in q):
        return [robot.check_configuration(one, f"q[{k}]") for k, one in enumerate(q)]
    if isinstance(q, np.ndarray) and q.ndim == 2 and len(q):
        return list(robot.check_configurations(q))
    return [robot.check_configuration(q)]


def depth_of(values: Any) -> int:
    """The number of an array's dimensions; -1 if its rows have different lengths."""
    try:
        return np.ndim(values)
    except ValueError:
        return -1


def as_opacities(opacity: ArrayLike, count: int) -> list[float]:
    """An opacity in 0..1 for each of `count` configurations; one number stands for all."""
    values = (
        [opacity] * count if depth_of(opacity) == 0 else list(as_vector(opacity, count, "opacity", "one for each q"))
    )
    numbers = [as_finite_number(value, "opacity") for value in values]
    if any(not 0.0 <= number <= 1.0 for number in numbers):
        raise InputError(f"opacity must be between 0 and 1; got {opacity!r}")
    return numbers


def as_colors(color: str | Sequence[str], count: int, what: str, of: str) -> list[Array]:
    """A colour (3,) for each of `count` things; a single one stands for all."""
    if isinstance(color, str):
        return [as_color(color, what)] * count
    if not isinstance(color, Iterable) or len(colors := list(color)) != count:
        raise InputError(f"{what} must be one colour, or one for each of the {count} {of}; got {color!r}")
    return [as_color(one, what) for one in colors]


def as_offsets(offset: ArrayLike, count: int) -> Array:
    """The offset of each configuration (count, 3) [m]; one offset (3,) is the distance from each to the next."""
    if depth_of(offset) == 1:
        return np.arange(count)[:, None] * as_point(offset, "offset")
    return as_points(as_array(offset, (count, 3), "offset", "one for each q"), "offset")


def as_any_points(points: ArrayLike, what: str) -> Array:
    """One point, several or none, as rows (n, 3) [m]."""
    if isinstance(points, (list, tuple, np.ndarray)) and len(points) == 0:
        return np.zeros((0, 3))
    return as_points([points] if depth_of(points) == 1 else points, what)  # type: ignore[arg-type]


def as_color(text: str, what: str) -> Array:
    """Red, green and blue (3,), each in 0..1, from "#rrggbb"."""
    if not isinstance(text, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", text):
        raise InputError(f"{what} must be a colour such as '#1f6fc4'; got {text!r}")
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
