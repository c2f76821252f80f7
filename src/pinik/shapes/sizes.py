"""Shapes that are far larger or smaller than their robot, as those of meshes in another unit are."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..description.flaw import Flaw
from ..model.home import robot_size
from ..model.robot_model import RobotModel

__all__ = ["size_flaws"]

Corners = tuple[str, str, NDArray[np.float64]]
"""The name of a link, that of a shape on it, and the vertices (n, 3) of the shape [m]."""

_TIMES = 100.0
_TINY = 2000.0  # smaller than the robot by this: screws are 300 times smaller, and some robots mark sensors by 1 mm


def size_flaws(robot: RobotModel, shapes: Iterable[Corners]) -> list[Flaw]:
    """One flaw for each visual that is over 100 times larger or 2000 times smaller than the robot.

    If all of them together are over 100 times smaller than the robot, that is one flaw, with the line of the largest.

    Args:
        robot: The robot; without any distance between its links there is nothing to compare with.
        shapes: Its visual shapes, named as `load_shapes` names them.
    """
    if not any(any(joint.xyz) for joint in robot.description.joints):
        return []
    size = robot_size(robot)
    extents = _extents(shapes)
    if not extents or not size:
        return []
    lines = {
        (link.name, str(shape.index)): shape.line for link in robot.description.link_tags for shape in link.visuals
    }
    largest_one = max(extents, key=lambda shape: extents[shape])
    largest = extents[largest_one]
    if 0.0 < largest < size / _TIMES:
        cause = f"its largest shape is {largest:.2g} m large, while the robot is about {size:.2g} m"
        mend = "Check the units of the meshes and of the joints' origins; both must be metres."
        why = "The shapes cannot be seen, or the joints stand far apart."
        return [Flaw("<robot>", cause, code="shape-too-small", line=lines.get(largest_one), why=why, mend=mend)]
    flaws = []
    for (link, visual), extent in extents.items():
        if extent > _TIMES * size or 0.0 < extent < size / _TINY:
            flaws.append(_flaw(link, int(visual), lines.get((link, visual)), extent, size))
    return flaws


def _flaw(link: str, visual: int, line: int | None, extent: float, size: float) -> Flaw:
    large = extent > size
    word = "larger" if large else "smaller"
    times = extent / size if large else size / extent
    return Flaw(
        f"link {link!r}, visual {visual + 1}",
        f"its shape is {extent:.3g} m large, about {times:.0f} times {word} than the robot ({size:.2g} m)",
        code="shape-too-large" if large else "shape-too-small",
        line=line,
        common=f"its shape is over {_TIMES if large else _TINY:g} times {word} than the robot",
    )


def _extents(shapes: Iterable[Corners]) -> dict[tuple[str, str], float]:
    """(Link, index of the visual) → the longest edge of the box around its parts, along the link's axes [m]."""
    ends: dict[tuple[str, str], list[NDArray[np.float64]]] = defaultdict(list)
    for link, name, vertices in shapes:
        visual = name.removeprefix(f"{link}/").partition("/")[0]
        if len(vertices) and np.isfinite(vertices).all():
            ends[link, visual] += [vertices.min(axis=0), vertices.max(axis=0)]
    return {key: float(np.ptp(both, axis=0).max()) for key, both in ends.items()}
