"""Cyclic coordinate descent."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from .base import Array, Patience, SweepingSolver, without_motion
from .chaser import Chaser
from .parameter import parameter, stiffness_parameter

if TYPE_CHECKING:
    from ..model.joint import Joint
    from ..model.limits import Limits
    from ..problem.coordinates import Coordinate
    from ..problem.kinematics import Kinematics
    from ..problem.problem import Problem
    from ..problem.tolerance import Tolerance

__all__ = ["CCD"]

ROUNDING = 1e-14  # relative rounding error of points and unit axes at the end of a chain; smaller changes are ignored
SUSPECT = 1e-6  # below this ratio, the component across a joint's axis relative to that along it may be mere rounding
NO_COLUMN = 1e-12  # relative to the chain's length: a shorter Jacobian column counts as zero
HALVINGS = 12
_NOTHING = np.zeros((3, 3))
_RELAXATION_OF_POSES = 1.7


@dataclass(frozen=True, kw_only=True)
class CCD(SweepingSolver):
    r"""Cyclic coordinate descent: solves the one-dimensional problem of each joint exactly, from tip to base.

    A hinge with unit axis a turns by the φ that maximises
    $g(\varphi) = k_1(1 - \cos\varphi) + k_2\cos\varphi + k_3\sin\varphi$, that is $\varphi = \operatorname{atan2}(k_3,
    k_2 - k_1)$. Let $P_c, P_d$ be the points of effector and target relative to the joint, and $u_c, u_d$ the axes of
    their frames; then $k_1 = w_p(P_d \cdot a)(P_c \cdot a)$ $+\, w_o\sum(u_d \cdot a)(u_c \cdot a)$,
    $k_2 = w_p P_d \cdot P_c + w_o\sum u_d \cdot u_c$ and $k_3 = a \cdot (w_p P_c \times P_d + w_o\sum u_c \times u_d)$.
    A prismatic joint moves by $(P_d - P_c) \cdot a$. Weights: $w_o = 1$, $w_p = \alpha(1 + \rho)$ with
    $\rho = \min(\|P_d\|, \|P_c\|) / \max(\|P_d\|, \|P_c\|)$ and $\alpha = k/W^2$, where W is the chain's length.

    A relaxation above 1 overshoots, like successive over-relaxation (Young 1954); below 2, g never decreases. Welman
    uses 1, which suffices for positions. Poses lie in narrow valleys, where 1.7 needs a tenth of the sweeps.

    For an axis that should point at a point, the step moves the point on the axis at the goal's distance to the goal.

    Source: Welman 1993, §4.2, eqs. 4.16–4.24, after Wang and Chen 1991.
    """

    name = "ccd"
    title = "Cyclic coordinate descent"
    about = "moves one joint at a time to its optimum; can leave straight arms, where the others get stuck"
    max_iterations = 2000
    restarts = 30
    patience = Patience(30, 0.05)

    stiffness: Mapping[str, float] = stiffness_parameter(
        "fraction of its optimal change that a joint makes; 1 for joints not named"
    )
    relaxation: float | None = parameter(
        None,
        "factor on the optimal change of every joint; automatic is 1 for positions and 1.7 for poses",
        low=0.01,
        high=1.99,
        slider=(0.1, 1.99),
        optional=True,
        symbol="ω",
        level=1,
    )
    position_weight: float = parameter(
        15.0, "weight of position relative to orientation", low=1e-6, high=1e6, slider=(0.1, 1e3), symbol="k"
    )
    scaling: str = parameter(
        "area",
        "how the weight is scaled by the chain's length W: k/W² (area), independent of scale, or k/W (printed)",
        choices=("area", "printed"),
        symbol="α",
        level=3,
    )

    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """One pass from the distal joints to the base."""
        model, data = kinematics.model, kinematics.data
        q = q.copy()
        chasers = self._chasers(q, kinematics)
        relaxation = self.relaxation_for(kinematics.problem, kinematics.loose)
        updates = 0
        for coordinate in kinematics.problem.coordinates:
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
            else:  # the axes of the joint's other coordinates have moved too
                chasers = self._chasers(q, kinematics)
        return q, updates

    def _chasers(self, q: Array, kinematics: Kinematics) -> list[Chaser]:
        pinocchio.forwardKinematics(kinematics.model, kinematics.data, q)
        kinematics.evaluations += 1
        size = kinematics.problem.size_of_chain
        alpha = self.position_weight / (size if self.scaling == "printed" else size * size)
        return [Chaser(rows, alpha, self.max_residual, kinematics.loose) for rows in kinematics.rows]

    @property
    def held(self) -> tuple[str, ...]:
        """For pinik itself: the joints of stiffness 0."""
        return without_motion(self.stiffness)

    def relaxation_for(self, problem: Problem, loose: bool = False) -> float:
        """For pinik itself: the relaxation; if it is None, the default for the kinds of the targets.

        With `loose`, residuals stop pulling inside their tolerances, and overshooting would leave a tolerance again.
        """
        if self.relaxation is not None:
            return self.relaxation
        if loose:
            return 1.0
        return _RELAXATION_OF_POSES if any(target.asks_orientation for target in problem.targets) else 1.0

    def _best_change(
        self,
        coordinate: Coordinate,
        axis: Array,
        origin: Array,
        chasers: list[Chaser],
        low: float,
        high: float,
        scale: float,
    ) -> float:
        """The exact solution of the coordinate's one-dimensional problem, scaled and inside its limits [rad or m]."""
        mover, multiplier = coordinate.movers[0]
        chasers = [chaser for chaser in chasers if chaser.moved_by(mover)]
        if multiplier != 1.0:
            low, high = sorted((low * multiplier, high * multiplier))
        if coordinate.slides:
            change = min(max(_best_slide(axis, origin, mover, chasers), low), high)
        else:
            M = sum([chaser.correlation(mover, origin) for chaser in chasers], _NOTHING)
            cosine, sine, along = _coefficients(M, axis)
            if math.hypot(cosine, sine) <= SUSPECT * along:
                cosine, sine = _measured_across(axis, origin, mover, chasers)
            change = _best_turn(cosine, sine, low, high, shortest=scale < 1.0 or self.max_step < math.pi)
        if scale > 1.0 and not coordinate.slides and abs(change) > math.pi:
            scale = 1.0  # no overshoot if the joint turns the long way round
        change = min(max(scale * change, low), high) / multiplier
        return min(max(change, -self.max_step), self.max_step)

    def _downhill_change(
        self, coordinate: Coordinate, q: Array, kinematics: Kinematics, limits: Limits, part: float
    ) -> float:
        """A change that lowers the residual, for a coordinate whose mimic joints also move the target frames.

        Such a coordinate moves about several axes at once and has no closed form. It takes a Gauss-Newton step along
        its Jacobian column, halved until the norm of the residual decreases.
        """
        column = coordinate.joint.idx_v
        at = kinematics.linearize(q)
        J = at.J[:, column]
        squared = float(J.dot(J))
        problem = kinematics.problem
        if (
            squared <= (NO_COLUMN * problem.lightest * problem.size_of_chain) ** 2
        ):  # its mimic joints cancel its motion up to rounding
            return 0.0
        low, high = coordinate.room(q, limits)
        change = min(max(part * float(J.dot(at.e)) / squared, low, -self.max_step), high, self.max_step)
        before = float(at.e.dot(at.e))
        for _ in range(HALVINGS):
            moved = q.copy()
            coordinate.advance(moved, change, kinematics.model, limits)
            e = kinematics.linearize(moved).e
            if float(e.dot(e)) < before:
                return change
            change /= 2.0
        return 0.0


def _carry(chasers: list[Chaser], coordinate: Coordinate, axis: Array, origin: Array, change: float) -> None:
    mover, multiplier = coordinate.movers[0]
    amount = change * multiplier
    shift = axis * amount
    R = None if coordinate.slides else pinocchio.exp3(shift)
    for chaser in chasers:
        chaser.carry(mover, origin, R, shift)


def _best_slide(axis: Array, origin: Array, mover: Joint, chasers: list[Chaser]) -> float:
    """Σ w (d − c)·a / Σ w over the pairs that the mover changes [m]; eq. 4.24 for one."""
    pull, weight = 0.0, 0.0
    for chaser in chasers:
        sign = 1.0 if chaser.moves_frame(mover) else -1.0
        for c, d, w in chaser.point_pairs(origin):
            pull += sign * chaser.weight * w * float((d - c).dot(axis))
            weight += chaser.weight * w
    return pull / weight if weight > 0.0 else 0.0


def _coefficients(M: Array, axis: Array) -> tuple[float, float, float]:
    """(k₂ − k₁, k₃, |k₁| + |k₂|) of g (eq. 4.19) for M = Σ w c dᵀ."""
    x, y, z = axis.tolist()
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = M.tolist()
    k1 = x * (xx * x + xy * y + xz * z) + y * (yx * x + yy * y + yz * z) + z * (zx * x + zy * y + zz * z)
    k2 = xx + yy + zz
    return k2 - k1, x * (yz - zy) + y * (zx - xz) + z * (xy - yx), abs(k1) + abs(k2)


def _measured_across(axis: Array, origin: Array, mover: Joint, chasers: list[Chaser]) -> tuple[float, float]:
    """k₂ − k₁ and k₃, computed without a difference of large numbers; zeros if both may be mere rounding.

    That is the case if the effector lies on the joint's axis, or if the axis to be turned is parallel to it.
    """
    cosine, sine, blur = (sum(parts) for parts in zip(*(c.across(axis, origin, mover) for c in chasers), strict=True))
    return (cosine, sine) if math.hypot(cosine, sine) > ROUNDING * blur else (0.0, 0.0)


def _best_turn(cosine: float, sine: float, low: float, high: float, *, shortest: bool) -> float:
    """The φ in [low, high] that maximises cosine · cos φ + sine · sin φ [rad], and so maximises g.

    If a limit blocks the best φ, turning the other way to the same angle is allowed too, unless `shortest`.
    """
    if cosine == 0.0 == sine:
        return 0.0
    best = math.atan2(sine, cosine)
    if low <= best <= high:
        return best
    if shortest:
        return min(max(best, low), high)
    for other in (best - 2.0 * math.pi, best + 2.0 * math.pi):
        if low <= other <= high:
            return other
    ends = [end for end in (low, 0.0, high) if math.isfinite(end)]
    return max(ends, key=lambda end: math.cos(end - best))
