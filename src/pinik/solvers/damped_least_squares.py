"""Damped least squares."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import eigenpy
import numpy as np

from .base import Array, JacobianSolver, Patience
from .parameter import parameter

if TYPE_CHECKING:
    from ..problem.kinematics import Kinematics, Linearization

__all__ = ["SMALLEST_DAMPING_SQUARED", "DampedLeastSquares"]

SMALLEST_DAMPING_SQUARED = 1e-15
"""Relative to the trace of JJᵀ: keeps JJᵀ + λ²I positive definite if J lacks full row rank and λ is close to zero."""


@dataclass(frozen=True, kw_only=True)
class DampedLeastSquares(JacobianSolver):
    r"""$\Delta q = J^\top (JJ^\top + \lambda^2 I)^{-1} e
    = \sum_i \frac{\sigma_i}{\sigma_i^2 + \lambda^2} v_i u_i^\top e$.

    Minimises $\|J\Delta q - e\|^2 + \lambda^2\|\Delta q\|^2$. With λ the `damping`, the rules are:

    * "constant": λ² = damping².
    * "residual" (Chan and Lawrence 1988): λ² = damping² ‖e‖², so that the damping vanishes at the target.
    * "sugihara" (Sugihara 2011): λ² = ½‖e‖² + damping².
    * "manipulability" (Nakamura and Hanafusa 1986): λ² = damping² (1 − w/w₀)² if w = √det JJᵀ is below w₀, else 0. If
      J never has full row rank, as for a planar chain with a target in space, w is always 0.

    `solve` replaces ‖e‖ by `Linearization.distance`, in which a radian counts as 0.3 of the chain's length. Attempts
    that may be followed by a restart multiply the distance by √0.1, for larger steps.

    Source: thesis, §3.3–3.4, eqs. 3.3.6 and 3.4.9 (Wampler 1986; Nakamura and Hanafusa 1986).
    """

    name = "dls"
    title = "Damped least squares"
    about = "the default; robust near singular configurations"
    max_iterations = 200
    restarts = 100
    patience = Patience(3, 0.2)
    converges_quadratically = True

    damping: float = parameter(
        math.sqrt(0.5),
        "how much steps are damped, or the factor from which the rule computes that",
        low=1e-9,
        high=100.0,
        slider=(1e-3, 10.0),
        symbol="λ",
        level=1,
    )
    rule: str = parameter(
        "residual",
        "rule that computes λ in each step",
        choices=("constant", "residual", "sugihara", "manipulability"),
    )
    manipulability: float = parameter(
        0.05, "threshold of the manipulability rule", low=1e-9, slider=(1e-3, 1.0), symbol="w₀", level=3
    )
    factorization: str = parameter(
        "ldlt", "factorization that solves the linear system", choices=("ldlt", "svd"), level=3
    )

    def direction(self, J: Array, e: Array, residual: float | None = None) -> Array:
        """Jᵀ(JJᵀ + λ²I)⁻¹e. If `residual` [m] is given, the rules use it instead of ‖e‖."""
        damping_squared = self.damping_squared(J, math.sqrt(e.dot(e)) if residual is None else residual)
        if self.factorization == "svd":
            left, sigma, right = np.linalg.svd(J, full_matrices=False)
            return np.array((sigma / (sigma * sigma + damping_squared) * left.T.dot(e)).dot(right))
        A = J.dot(J.T)
        A.ravel()[:: len(e) + 1] += damping_squared
        return np.array(J.T.dot(eigenpy.LDLT(A).solve(e)))

    def damping_squared(self, J: Array, residual: float) -> float:
        """λ² [m²] by the rule, for a Jacobian (m, nv) and the norm of the residual [m]."""
        squared = self.damping * self.damping
        if self.rule == "residual":
            squared *= residual * residual
        elif self.rule == "sugihara":
            squared += 0.5 * residual * residual
        elif self.rule == "manipulability":
            w = math.sqrt(max(float(np.linalg.det(J.dot(J.T))), 0.0))
            squared *= max(0.0, 1.0 - w / self.manipulability) ** 2
        entries = J.ravel(order="K")
        return squared + SMALLEST_DAMPING_SQUARED * float(entries.dot(entries))

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """The step, with damping by the full distance even if D_max shortens the residual."""
        return self.direction(at.J, at.e, at.distance)
