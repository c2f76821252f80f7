"""One target during a sweep of cyclic coordinate descent."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from ..problem.rows import shortest_rotation
from ..problem.slack import SHARE, outside_ball, outside_box
from ..problem.targets import NO_DIRECTION
from ..problem.tolerance import WIDE_ANGLE
from .base import Array

if TYPE_CHECKING:
    from ..model.joint import Joint
    from ..problem.rows import Rows
    from ..problem.tolerance import Tolerance

__all__ = ["WIDE_POSITION", "Chaser"]

WIDE_POSITION = 10.0
"""The factor on the weight of a position whose target has a wide tolerance for its orientation."""


class Chaser:
    """One target during a sweep: effector and goal, updated joint by joint without forward kinematics.

    `p` (3,) [m] is the effector's point and `U` (3, k) the constrained axes of its frame. `goal` (3,) [m] and `V`
    (3, k) are their desired values, None if unconstrained. `at` (3,) [m] is the point at which the only column of U
    should point. With `loose`, what is inside the tolerance draws nothing.
    """

    def __init__(self, rows: Rows, alpha: float, max_residual: float, loose: bool = False) -> None:
        rows.update_placements()
        target, R = rows.target, rows.R
        self._chain, self._loose = rows.term.chain, loose
        self._own_tolerance, self._tolerance = target.tolerance, rows.term.tolerance
        self.weight = rows.term.weight * rows.term.weight
        self.p = rows.p.copy()
        self.goal, rotation, direction, self.at = rows.wanted()
        self.U: Array | None = None
        self.V: Array | None = None
        if rotation is not None:
            self.U, self.V = R.copy(), rotation
        elif target.axis is not None:
            self.U = R.dot(target.axis)[:, None]
            self.V = None if direction is None else direction[:, None]
        self._free = ~np.array(target.along) if rows.term.has_free_axes else None
        self._axes = rows.reference_axes()  # in which axes are free
        self._box = rows.box_axes(rotation)
        self.alpha = alpha * WIDE_POSITION if self._tolerance.orientation > WIDE_ANGLE else alpha
        self._max_residual = max_residual

    def moved_by(self, mover: Joint) -> bool:
        """Whether the mover moves the effector relative to the goal."""
        return self.moves_frame(mover) != self.moves_reference(mover)

    def moves_frame(self, mover: Joint) -> bool:
        """Whether the mover moves the effector."""
        return mover.id in self._chain.frame_support

    def moves_reference(self, mover: Joint) -> bool:
        """Whether the mover moves the frame in which the goal is expressed."""
        return mover.id in self._chain.reference_support

    def within(self, tolerance: Tolerance) -> bool:
        """Whether the effector is at its goal, within the target's own tolerance or else within `tolerance`."""
        reached = self._own_tolerance or tolerance
        if self.goal is not None:
            left, allowed = self._left(), reached.position
            if isinstance(allowed, tuple):
                if (np.abs(self._box.T.dot(left)) > allowed).any():
                    return False
            elif float(left.dot(left)) > allowed * allowed:
                return False
        return self.U is None or self.angle() <= reached.orientation

    def angle(self) -> float:
        """The orientation error [rad]."""
        U, V = self.U, self._facing() if self.V is None else self.V
        assert U is not None
        if U.shape[1] == 1:
            a, b = U[:, 0], V[:, 0]
            return math.atan2(float(np.linalg.norm(pinocchio.skew(a).dot(b))), float(a.dot(b)))
        return float(np.linalg.norm(pinocchio.log3(V.dot(U.T))))

    def point_pairs(self, origin: Array) -> list[tuple[Array, Array, float]]:
        """Triples (effector's point, its goal, weight), with points (3,) [m] in the world; `origin` is the joint's."""
        pairs = []
        goal = self._drawn_goal()
        if goal is not None:
            w = self.alpha
            if self.U is not None:
                c, d = self.p - origin, goal - origin
                c_squared, d_squared = float(c.dot(c)), float(d.dot(d))
                longer = max(c_squared, d_squared)
                w *= 1.0 + (math.sqrt(min(c_squared, d_squared) / longer) if longer > 0.0 else 1.0)
            pairs.append((self.p, goal, w))
        if self.at is not None and self.U is not None and not self._loose:
            line = self.at - self.p
            squared = float(line.dot(line))
            if squared > NO_DIRECTION**2:
                pairs.append((self.p + math.sqrt(squared) * self.U[:, 0], self.at, 1.0 / squared))
        return pairs

    def correlation(self, mover: Joint, origin: Array) -> Array:
        """Σ w c dᵀ (3, 3) over what the mover moves (c) and where it should go (d), relative to `origin`."""
        V = self._drawn_axes()
        M = np.zeros((3, 3)) if V is None or self.U is None else self.U.dot(V.T)
        for c, d, w in self.point_pairs(origin):
            M += (w * (c - origin))[:, None] * (d - origin)
        if self.weight != 1.0:
            M *= self.weight
        return M if self.moves_frame(mover) else M.T

    def across(self, axis: Array, origin: Array, mover: Joint) -> tuple[float, float, float]:
        """The sums Σ w c·d and Σ w a·(c × d) over the parts across a joint's axis a, and their error scale.

        The error scale times the relative rounding error of the coordinates bounds the error of the two sums.
        """

        def part(vector: Array) -> Array:
            return np.asarray(vector - axis * axis.dot(vector))

        parts = [
            (
                part(c - origin),
                part(d - origin),
                w,
                float(np.linalg.norm(c) + np.linalg.norm(d) + np.linalg.norm(origin)),
            )
            for c, d, w in self.point_pairs(origin)
        ]
        V = self._drawn_axes()
        if self.U is not None and V is not None:
            parts += [(part(u), part(v), 1.0, 1.0) for u, v in zip(self.U.T, V.T, strict=True)]
        cosine = sine = blur = 0.0
        for c, d, w, size in parts:
            cosine += w * float(c.dot(d))
            sine += w * float(axis.dot(np.cross(c, d)))
            blur += w * size * float(np.linalg.norm(c) + np.linalg.norm(d))
        sign = 1.0 if self.moves_frame(mover) else -1.0
        return self.weight * cosine, self.weight * sign * sine, self.weight * blur

    def carry(self, mover: Joint, origin: Array, R: Array | None, shift: Array) -> None:
        """Move what the mover moves (effector, goal or both): rotate it by R (3, 3) about `origin`, or shift it."""

        def moved(point: Array) -> Array:
            return point + shift if R is None else origin + R.dot(point - origin)

        if self.moves_frame(mover):
            self.p = moved(self.p)
            if self.U is not None and R is not None:
                self.U = R.dot(self.U)
        if self.moves_reference(mover):
            self.goal = None if self.goal is None else moved(self.goal)
            self.at = None if self.at is None else moved(self.at)
            if R is not None:
                self.V = None if self.V is None else R.dot(self.V)
                self._axes = R.dot(self._axes)
                self._box = R.dot(self._box)

    def _left(self) -> Array:
        """The vector from the effector to the nearest position that is allowed."""
        assert self.goal is not None
        left: Array = self.goal - self.p
        if self._free is not None:
            left = (self._axes * ~self._free).dot(self._axes.T.dot(left))
        return left

    def _drawn_goal(self) -> Array | None:
        """The position that draws the effector: the goal, or the nearest one at the edge of a tolerance.

        If it is farther away than D_max, it is the point at distance D_max on the way to it. None if nothing draws.
        """
        if self.goal is None or (self._max_residual == math.inf and self._free is None and not self._loose):
            return self.goal
        e = self._left()
        if self._loose:
            allowed = self._tolerance.position
            if isinstance(allowed, tuple):
                e, _ = outside_box(e, allowed, self._box)
            else:
                e, _ = outside_ball(e, allowed)
            if not e.any():
                return None
        length = math.sqrt(e.dot(e))
        drawn: Array = self.p + (e if length <= self._max_residual else e * (self._max_residual / length))
        return drawn

    def _drawn_axes(self) -> Array | None:
        """The axes (3, k) that draw those of the effector: V, or the nearest ones at the edge of a tolerance."""
        if not self._loose or self.U is None:
            return self.V
        angle = self.angle()
        left = angle - SHARE * self._tolerance.orientation
        if left <= 0.0:
            return None
        V = self._facing() if self.V is None else self.V
        if self.U.shape[1] == 1:
            turn, _ = shortest_rotation(self.U[:, 0], V[:, 0])
        else:
            turn = pinocchio.log3(V.dot(self.U.T))
        return np.array(pinocchio.exp3(turn * (left / angle)).dot(self.U))

    def _facing(self) -> Array:
        """The direction (3, 1) towards the point `at`; the axis itself if the effector is at that point."""
        assert self.at is not None
        assert self.U is not None
        line = self.at - self.p
        distance = math.sqrt(line.dot(line))
        return self.U if distance < NO_DIRECTION else (line / distance)[:, None]
