"""Cyclic coordinate descent."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from .base import Array, Patience, SweepingSolver, parameter

if TYPE_CHECKING:
    from ..coordinates import Coordinate
    from ..kinematics import Kinematics, TargetTerm
    from ..limits import Limits
    from ..robot import Joint
    from ..targets import Tolerance

__all__ = ["CCD"]

_NO_DIRECTION = 1e-9  # [m]
_INDIFFERENT = 1e-14  # a joint whose turn changes g by less than rounding stays
_HALVINGS = 12
_NOTHING = np.zeros((3, 3))
_RELAXATION_OF_POSES = 1.7


@dataclass(frozen=True, kw_only=True)
class CCD(SweepingSolver):
    r"""Joint after joint, tip to base, each one-dimensional problem solved exactly.

    A hinge with unit axis a turns by the φ that maximises
    $g(\varphi) = k_1(1 - \cos\varphi) + k_2\cos\varphi + k_3\sin\varphi$, that is $\varphi = \operatorname{atan2}(k_3,
    k_2 - k_1)$, where with $P_c, P_d$ the effector's and the target's points seen from the joint and $u_c, u_d$ the
    axes of their frames $k_1 = w_p(P_d \cdot a)(P_c \cdot a) + w_o\sum(u_d \cdot a)(u_c \cdot a)$,
    $k_2 = w_p P_d \cdot P_c + w_o\sum u_d \cdot u_c$ and $k_3 = a \cdot (w_p P_c \times P_d + w_o\sum u_c \times u_d)$.
    A slide moves by $(P_d - P_c) \cdot a$. Weights: $w_o = 1$, $w_p = \alpha(1 + \rho)$ with
    $\rho = \min(\|P_d\|, \|P_c\|) / \max(\|P_d\|, \|P_c\|)$ and $\alpha = k/W^2$, W the chain's length.

    Above 1 the relaxation overshoots, as successive over-relaxation does (Young 1954); below 2, g never falls. Welman's
    own form is 1. Positions need nothing else; poses lie in narrow valleys, where 1.7 needs a tenth of the sweeps.

    An axis that should point at a point is treated as a ray: its point at the distance of the goal is drawn there.

    Source: Welman 1993, §4.2, eqs. 4.16–4.24, after Wang and Chen 1991.
    """

    name = "ccd"
    max_iterations = 2000
    restarts = 30
    patience = Patience(30, 0.05)

    stiffness: Mapping[str, float] = parameter(
        {}, "w_i: the part of its best change that a joint makes; 1 where none is named", low=0.0, high=1.0
    )
    relaxation: float | None = parameter(
        None,
        "ω: factor on every joint's best change; None: 1, or 1.7 for poses",
        low=0.01,
        high=1.99,
        optional=True,
    )
    position_weight: float = parameter(15.0, "k: weight of position against orientation", low=1e-6, high=1e6)
    scaling: str = parameter(
        "area",
        "α = k/W² (area), so that scale does not matter, or k/W (printed)",
        choices=("area", "printed"),
    )

    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """One pass from the distal joints to the base."""
        model, data = kinematics.model, kinematics.data
        q = q.copy()
        chasers = self._chasers(q, kinematics)
        relaxation = self._relaxation(kinematics)
        updates = 0
        for coordinate in kinematics.coordinates:
            if all([chaser.within(tolerance) for chaser in chasers]):
                break
            updates += 1
            part = self.stiffness.get(coordinate.joint.name, 1.0) if self.stiffness else 1.0
            if len(coordinate.movers) > 1:
                change = self._downhill_change(coordinate, q, kinematics, limits, part)
                coordinate.advance(q, change, model, limits)
                chasers = self._chasers(q, kinematics)
                continue
            axis, origin = coordinate.line(data)
            low, high = coordinate.room(q, limits)
            change = self._best_change(coordinate, axis, origin, chasers, low, high, part * relaxation)
            coordinate.advance(q, change, model, limits)
            if coordinate.joint.nv == 1:
                _carry(chasers, coordinate, axis, origin, change)
            else:  # the joint's other coordinates turned with it
                chasers = self._chasers(q, kinematics)
        return q, updates

    def _chasers(self, q: Array, kinematics: Kinematics) -> list[_Chaser]:
        pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
        return [_Chaser(term, self) for term in kinematics.terms]

    def _relaxation(self, kinematics: Kinematics) -> float:
        if self.relaxation is not None:
            return self.relaxation
        asks_orientation = any(t.rotation is not None or t.axis is not None for t in kinematics.targets)
        return _RELAXATION_OF_POSES if asks_orientation else 1.0

    def _best_change(
        self,
        coordinate: Coordinate,
        axis: Array,
        origin: Array,
        chasers: list[_Chaser],
        low: float,
        high: float,
        scale: float,
    ) -> float:
        """The exact solution of the coordinate's own problem, scaled, inside its room [rad or m]."""
        mover, multiplier = coordinate.movers[0]
        chasers = [chaser for chaser in chasers if chaser.moved_by(mover)]
        if multiplier != 1.0:
            low, high = sorted((low * multiplier, high * multiplier))
        if coordinate.slides:
            change = min(max(_best_slide(axis, origin, mover, chasers), low), high)
        else:
            M = sum([chaser.correlation(mover, origin) for chaser in chasers], _NOTHING)
            change = _best_turn(M, axis, low, high, shortest=scale < 1.0 or self.max_step < math.pi)
        if scale > 1.0 and abs(change) > math.pi:
            scale = 1.0  # the long way round to a goal has none of its own to overshoot into
        change = min(max(scale * change, low), high)
        return min(max(change, -self.max_step), self.max_step) / multiplier

    def _downhill_change(
        self, coordinate: Coordinate, q: Array, kinematics: Kinematics, limits: Limits, part: float
    ) -> float:
        """A change that lowers the objective, for a leader whose followers move the targets as well.

        Such a coordinate turns about several lines at once and has no closed form: a Gauss-Newton step along its
        Jacobian column, halved until the objective falls.
        """
        column = coordinate.joint.idx_v
        at = kinematics.linearize(q)
        J = at.J[:, column]
        squared = float(J.dot(J))
        if squared == 0.0:
            return 0.0
        low, high = coordinate.room(q, limits)
        change = min(max(part * float(J.dot(at.e)) / squared, low, -self.max_step), high, self.max_step)
        before = float(at.e.dot(at.e))
        for _ in range(_HALVINGS):
            moved = q.copy()
            coordinate.advance(moved, change, kinematics.model, limits)
            e = kinematics.linearize(moved).e
            if float(e.dot(e)) < before:
                return change
            change /= 2.0
        return 0.0


class _Chaser:
    """One target during a sweep: effector and goal, carried along without a forward kinematics.

    `p` (3,) is the effector's point, `U` (3, k) the axes of its frame that matter; `goal` (3,) and `V` (3, k) are
    where they should be, None where that is free, and `at` (3,) is the point that U's only column should point at.
    """

    def __init__(self, term: TargetTerm, solver: CCD) -> None:
        self.term = term
        term.update_placements()
        target, p, R = term.target, term.p, term.R
        self.weight = target.weight * target.weight
        self.p = p.copy()
        self.goal, rotation, direction, self.at = term.wanted()
        self.U: Array | None = None
        self.V: Array | None = None
        if rotation is not None:
            self.U, self.V = R.copy(), rotation
        elif target.axis is not None:
            self.U = R.dot(target.axis)[:, None]
            self.V = None if direction is None else direction[:, None]
        scale = term.chain_length if solver.scaling == "printed" else term.chain_length**2
        self.alpha = solver.position_weight / scale
        self.max_residual = solver.max_residual

    def moved_by(self, mover: Joint) -> bool:
        """Whether the mover moves effector and goal against each other."""
        return (mover.id in self.term.frame_support) != (mover.id in self.term.reference_support)

    def within(self, tolerance: Tolerance) -> bool:
        """Whether effector and goal agree."""
        if self.goal is not None:
            left = self.goal - self.p
            if float(left.dot(left)) > tolerance.position * tolerance.position:
                return False
        return self.U is None or self.angle() <= tolerance.orientation

    def angle(self) -> float:
        """The orientation error [rad]."""
        U, V = self.U, self._facing() if self.V is None else self.V
        assert U is not None
        if U.shape[1] == 1:
            a, b = U[:, 0], V[:, 0]
            return math.atan2(float(np.linalg.norm(pinocchio.skew(a).dot(b))), float(a.dot(b)))
        return float(np.linalg.norm(pinocchio.log3(V.dot(U.T))))

    def point_pairs(self, origin: Array) -> list[tuple[Array, Array, float]]:
        """(effector's point, its goal, weight), both points (3,) in the world; `origin` is the joint's."""
        pairs = []
        if self.goal is not None:
            goal, w = self._drawn_goal(), self.alpha
            if self.U is not None:
                c, d = self.p - origin, goal - origin
                c_squared, d_squared = float(c.dot(c)), float(d.dot(d))
                longer = max(c_squared, d_squared)
                w *= 1.0 + (math.sqrt(min(c_squared, d_squared) / longer) if longer > 0.0 else 1.0)
            pairs.append((self.p, goal, w))
        if self.at is not None and self.U is not None:
            line = self.at - self.p
            squared = float(line.dot(line))
            if squared > _NO_DIRECTION**2:
                pairs.append((self.p + math.sqrt(squared) * self.U[:, 0], self.at, 1.0 / squared))
        return pairs

    def correlation(self, mover: Joint, origin: Array) -> Array:
        """Σ w c dᵀ (3, 3) of what the mover carries (c) and where it should go (d), seen from `origin`."""
        M = np.zeros((3, 3)) if self.V is None or self.U is None else self.U.dot(self.V.T)
        for c, d, w in self.point_pairs(origin):
            M += (w * (c - origin))[:, None] * (d - origin)
        if self.weight != 1.0:
            M *= self.weight
        return M if mover.id in self.term.frame_support else M.T

    def carry(self, mover: Joint, origin: Array, R: Array | None, shift: Array) -> None:
        """Turn by R (3, 3) about `origin`, or else by `shift` (3,), what the mover moves: effector, goal, or both."""

        def moved(point: Array) -> Array:
            return point + shift if R is None else origin + R.dot(point - origin)

        if mover.id in self.term.frame_support:
            self.p = moved(self.p)
            if self.U is not None and R is not None:
                self.U = R.dot(self.U)
        if mover.id in self.term.reference_support:
            self.goal = None if self.goal is None else moved(self.goal)
            self.at = None if self.at is None else moved(self.at)
            if self.V is not None and R is not None:
                self.V = R.dot(self.V)

    def _drawn_goal(self) -> Array:
        """The goal, or the point on the way to it that D_max allows."""
        assert self.goal is not None
        if self.max_residual == math.inf:
            return self.goal
        e = self.goal - self.p
        length = math.sqrt(e.dot(e))
        return self.goal if length <= self.max_residual else self.p + e * (self.max_residual / length)

    def _facing(self) -> Array:
        """The direction (3, 1) of the point to look at; the axis itself where that has none."""
        assert self.at is not None
        assert self.U is not None
        line = self.at - self.p
        distance = math.sqrt(line.dot(line))
        return self.U if distance < _NO_DIRECTION else (line / distance)[:, None]


def _carry(chasers: list[_Chaser], coordinate: Coordinate, axis: Array, origin: Array, change: float) -> None:
    mover, multiplier = coordinate.movers[0]
    amount = change * multiplier
    shift = axis * amount
    R = None if coordinate.slides else pinocchio.exp3(shift)
    for chaser in chasers:
        chaser.carry(mover, origin, R, shift)


def _best_slide(axis: Array, origin: Array, mover: Joint, chasers: list[_Chaser]) -> float:
    """Σ w (d − c)·a / Σ w over the pairs that the mover changes [m]; eq. 4.24 for one."""
    pull, weight = 0.0, 0.0
    for chaser in chasers:
        sign = 1.0 if mover.id in chaser.term.frame_support else -1.0
        for c, d, w in chaser.point_pairs(origin):
            pull += sign * chaser.weight * w * float((d - c).dot(axis))
            weight += chaser.weight * w
    return pull / weight if weight > 0.0 else 0.0


def _best_turn(M: Array, axis: Array, low: float, high: float, *, shortest: bool) -> float:
    """The φ in [low, high] that maximises g (eq. 4.19) for M = Σ w c dᵀ [rad].

    Where a limit blocks the best φ, the other way round to it counts as well, unless `shortest`.
    """
    x, y, z = axis.tolist()
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = M.tolist()
    k1 = x * (xx * x + xy * y + xz * z) + y * (yx * x + yy * y + yz * z) + z * (zx * x + zy * y + zz * z)
    k2 = xx + yy + zz
    k3 = x * (yz - zy) + y * (zx - xz) + z * (xy - yx)
    if math.hypot(k3, k2 - k1) <= _INDIFFERENT * (abs(k1) + abs(k2) + abs(k3)):
        return 0.0
    best = math.atan2(k3, k2 - k1)
    if low <= best <= high:
        return best
    if shortest:
        return min(max(best, low), high)
    for other in (best - 2.0 * math.pi, best + 2.0 * math.pi):
        if low <= other <= high:
            return other
    ends = [end for end in (low, 0.0, high) if math.isfinite(end)]
    return max(ends, key=lambda end: math.cos(end - best))
