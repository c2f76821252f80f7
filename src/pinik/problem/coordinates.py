"""Single degrees of freedom: the joints that move with each one, its axis and its range."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from ..model.limits import Limits

__all__ = ["Coordinate"]

Array = NDArray[np.float64]

_UNIT_VECTORS = np.eye(3)


@dataclass(frozen=True)
class Coordinate:
    """One tangent coordinate of a joint, which moves that joint and the joints that mimic it.

    Attributes:
        joint: The joint that owns the coordinate.
        index: The index among the joint's tangent coordinates, from 0.
        movers: (joint, multiplier) for those of the joint and its mimic joints that move a target frame.
    """

    joint: Joint
    index: int
    movers: tuple[tuple[Joint, float], ...]

    @cached_property
    def slides(self) -> bool:
        """Whether the first mover translates along its axis instead of rotating about it."""
        return self.movers[0][0].slides(self.index)

    def line(self, data: Any) -> tuple[Array, Array]:
        """(unit axis (3,), a point on it (3,) [m]) of the first mover in the world, from `data.oMi`."""
        mover = self.movers[0][0]
        placement = data.oMi[mover.id]
        axis: Any = mover.axis if mover.has_one_axis else _UNIT_VECTORS[self.index % 3]
        return placement.rotation.dot(axis), placement.translation

    def room(self, q: Array, limits: Limits) -> tuple[float, float]:
        """The largest changes allowed by the limits, downwards (≤ 0) and upwards (≥ 0) [rad or m]."""
        entry = limits.entry[self.joint.idx_v + self.index]
        if entry < 0:
            return -math.inf, math.inf
        value = q[entry]
        return min(float(limits.lower[entry] - value), 0.0), max(float(limits.upper[entry] - value), 0.0)

    def advance(self, q: Array, change: float, model: pinocchio.Model, limits: Limits) -> None:
        """Change the coordinate by `change` [rad or m] in place; the result is clipped exactly to the limits."""
        joint = self.joint
        if joint.nq == 1:
            value = q[joint.idx_q] + change
            q[joint.idx_q] = min(max(value, limits.lower[joint.idx_q]), limits.upper[joint.idx_q])
            return
        step = np.zeros(model.nv)
        step[joint.idx_v + self.index] = change
        own = slice(joint.idx_q, joint.idx_q + joint.nq)
        q[own] = pinocchio.integrate(model, q, step)[own]  # the others would change by rounding
