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


@dataclass(frozen=True)
class Limits:
    """The limits of a robot, enabled or disabled.

    Attributes:
        robot: The robot.
        enabled: Whether the limits are enforced.
        lower, upper: Limits of the entries of q (nq,) [rad or m]; infinite for entries without limits.
        entry: For each tangent coordinate (nv,), the index of the entry of q that carries its limits, or −1.
        turning: For each entry of q (nq,), whether it is the angle of a hinge that no joint mimics, for which angles 2π
            apart are equivalent.
    """

    robot: RobotModel
    enabled: bool
    lower: Array
    upper: Array
    entry: NDArray[np.intp]
    turning: NDArray[np.bool_]

    @classmethod
    def of(cls, robot: RobotModel, enabled: bool = True) -> Limits:
        """The limits of a robot; all infinite unless `enabled`."""
        entry = np.full(robot.model.nv, -1, dtype=np.intp)
        turning = np.zeros(robot.model.nq, dtype=bool)
        leaders = {joint.leader for joint in robot.joints}
        for joint in robot.joints:
            if joint.nq == 1:
                turning[joint.idx_q] = joint.kind != "prismatic" and joint.name not in leaders
                if enabled:
                    entry[joint.idx_v] = joint.idx_q
        if enabled:
            return cls(robot, True, robot.lower_q, robot.upper_q, entry, turning)
        return cls(robot, False, np.full(robot.model.nq, -np.inf), np.full(robot.model.nq, np.inf), entry, turning)

    def loosened(self) -> Limits:
        """A copy without limits, except for joints whose lower and upper limits are equal."""
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

    def wrap(self, q: Array) -> Array:
        """`q` (…, nq), with hinges outside their limits moved by whole turns, as near to the limits as possible."""
        outside = self.turning & ((q < self.lower) | (q > self.upper))
        if not outside.any():
            return q
        entry = np.nonzero(outside)[-1]
        middle = 0.5 * (self.lower[entry] + self.upper[entry])
        turn = 2.0 * math.pi
        wrapped = q.copy()
        wrapped[outside] -= turn * np.round((q[outside] - middle) / turn)
        return wrapped

    def blocked(self, q: Array, wanted: Array, inside: Array) -> NDArray[np.bool_]:
        """Whether each tangent coordinate (nv,) is at a limit at `q` and would cross it in a step to `wanted`.

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
