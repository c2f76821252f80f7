"""Joint limits as a box of configurations."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .robot_model import RobotModel

__all__ = ["Limits"]

Array = NDArray[np.float64]

_AT_LIMIT = 1e-6  # [rad or m]: a joint nearer to its limit than this is at its limit
_TURN = 2.0 * math.pi

BARELY_OUTSIDE = 0.02
"""The largest distance beyond a limit [rad] from which a hinge goes back to that limit, instead of making a turn."""


@dataclass(frozen=True)
class Limits:
    """The limits of a robot, enabled or disabled.

    Attributes:
        robot: The robot.
        enabled: Whether the limits are enforced.
        lower, upper: Limits of the entries of q (nq,) [rad or m]; infinite for entries without limits.
        entry: For each tangent coordinate (nv,), the index of the entry of q that carries its limits, or −1.
        turning: For each entry of q (nq,), whether it is the angle of a hinge for which angles 2π apart are equivalent.
            So they are if every joint that mimics it is a hinge too and has a whole number as its multiplier.
    """

    robot: RobotModel
    enabled: bool
    lower: Array
    upper: Array
    entry: NDArray[np.intp]
    turning: NDArray[np.bool_]

    @classmethod
    def of(cls, robot: RobotModel, enabled: bool = True) -> Limits:
        """For pinik itself: the limits of a robot; all infinite unless `enabled`."""
        entry = np.full(robot.model.nv, -1, dtype=np.intp)
        turning = np.zeros(robot.model.nq, dtype=bool)
        tied = {joint.leader for joint in robot.joints if joint.kind == "prismatic" or joint.multiplier % 1.0 != 0.0}
        for joint in robot.joints:
            if joint.nq == 1:
                turning[joint.idx_q] = joint.kind != "prismatic" and joint.name not in tied
                if enabled:
                    entry[joint.idx_v] = joint.idx_q
        if enabled:
            return cls(robot, True, robot.lower_q, robot.upper_q, entry, turning)
        return cls(robot, False, np.full(robot.model.nq, -np.inf), np.full(robot.model.nq, np.inf), entry, turning)

    def loosened(self) -> Limits:
        """For pinik itself: a copy without limits, except for joints whose lower and upper limits are equal."""
        single = self.lower == self.upper
        if not single.any():
            return Limits.of(self.robot, False)
        lower, upper = np.where(single, self.lower, -np.inf), np.where(single, self.upper, np.inf)
        return dataclasses.replace(self, lower=lower, upper=upper)

    def clip(self, q: Array) -> Array:
        """The nearest configurations (…, nq) inside the limits, entry by entry."""
        return np.minimum(np.maximum(q, self.lower), self.upper)

    def contains(self, q: Array) -> bool:
        """Whether `q` is inside the limits."""
        return bool(((q >= self.lower) & (q <= self.upper)).all())

    def wrap(self, q: Array, near: Array | None = None) -> Array:
        """`q` moved inside the limits, with its hinges turned by whole turns to be as near to `near` as possible.

        A hinge whose angle in `q` is outside the limits, and barely beyond a limit where it is nearest to `near`, goes
        to that limit. If no whole turn leads inside, it goes to the limit that needs the smallest rotation.

        Args:
            q: Configurations (…, nq).
            near: The configurations to be near to (…, nq); `q` itself when None.
        """
        near = q if near is None else near
        inside = self.clip(q)
        moved = (np.abs(q - near) > math.pi) | (inside != q)
        entry = np.flatnonzero(self.turning & moved.any(axis=tuple(range(q.ndim - 1))))
        if entry.size:
            inside[..., entry] = self._turned(q[..., entry], near[..., entry], self.lower[entry], self.upper[entry])
        return inside

    @staticmethod
    def _turned(angle: Array, near: Array, lower: Array, upper: Array) -> Array:
        """The angles (…, n) [rad] of hinges after `wrap`."""
        nearest = angle - _TURN * np.round((angle - near) / _TURN)
        above, below = np.maximum(nearest - upper, 0.0), np.maximum(lower - nearest, 0.0)
        turned = nearest - _TURN * np.ceil(above / _TURN) + _TURN * np.ceil(below / _TURN)
        was_outside = (angle < lower) | (angle > upper)
        stays = was_outside & (above + below <= BARELY_OUTSIDE)
        with np.errstate(invalid="ignore"):
            middle = 0.5 * (lower + upper)
            about_middle = angle - _TURN * np.round((angle - middle) / _TURN)
        misses = ((turned < lower) | (turned > upper)) & np.isfinite(middle)
        chosen = np.where(stays, nearest, np.where(misses, about_middle, turned))
        return np.asarray(np.minimum(np.maximum(chosen, lower), upper))

    def blocked(self, q: Array, wanted: Array, inside: Array) -> NDArray[np.bool_]:
        """For pinik itself: whether each tangent coordinate (nv,) is at a limit at `q`, which `wanted` lies beyond.

        `inside` is `wanted` clipped to the limits.
        """
        entries: NDArray[np.bool_] = (inside != wanted) & (inside == q)
        return np.asarray(entries[self.entry] & (self.entry >= 0))

    def active(self, q: Array) -> dict[str, str]:
        """The joints that are at a limit at `q`: joint name → "lower", "upper" or "both"."""
        sides = {}
        for joint in self.robot.joints:
            if joint.nq == 1:
                angle, entry = q[joint.idx_q], joint.idx_q
                at_lower, at_upper = angle - self.lower[entry] <= _AT_LIMIT, self.upper[entry] - angle <= _AT_LIMIT
                if at_lower or at_upper:
                    sides[joint.name] = "both" if at_lower and at_upper else "lower" if at_lower else "upper"
        return sides
