"""Targets on the way from where the frames are to where they should be."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from ..problem.targets import Target

__all__ = ["OPPOSITE", "between", "present"]

Array = NDArray[np.float64]

OPPOSITE = 1e-9
"""The length of the mean of two unit vectors below which they count as opposite, so that it has no direction."""


def present(kinematics: Kinematics, targets: tuple[Target, ...], q: Array) -> tuple[Target, ...]:
    """Targets of the same kinds that the frames meet at `q`."""
    pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
    met = []
    for rows, target in zip(kinematics.rows, targets, strict=True):
        rows.update_placements()
        p, R = rows.seen_from_reference()
        axis = R[:, 0] if target.axis is None else R @ target.axis
        at = p if target.at is None else p + axis * np.linalg.norm(target.at - p)
        met.append(target.with_numbers(p.copy(), R.copy(), axis, at))
    return tuple(met)


def between(origins: tuple[Target, ...], targets: tuple[Target, ...], part: float) -> tuple[Target, ...]:
    """The targets at a part of the way: positions on a line, rotations about one axis, directions in a plane."""
    return tuple(_one_between(origin, target, part) for origin, target in zip(origins, targets, strict=True))


def _one_between(origin: Target, target: Target, part: float) -> Target:
    def line(start: Array | None, end: Array | None) -> Array:
        return np.zeros(3) if start is None or end is None else start + part * (end - start)

    rotation = np.eye(3)
    if origin.rotation is not None and target.rotation is not None:
        whole = pinocchio.log3(target.rotation @ origin.rotation.T)
        rotation = pinocchio.exp3(part * whole) @ origin.rotation
    direction = line(origin.direction, target.direction)
    length = float(np.linalg.norm(direction))
    if target.direction is not None and length < OPPOSITE:
        direction, length = target.direction, 1.0
    return target.with_numbers(
        line(origin.position, target.position), rotation, direction / (length or 1.0), line(origin.at, target.at)
    )
