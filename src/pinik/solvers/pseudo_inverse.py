"""The pseudo-inverse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from .base import Array, JacobianSolver, Patience
from .parameter import max_step_parameter, parameter

if TYPE_CHECKING:
    from ..problem.kinematics import Kinematics, Linearization

__all__ = ["SMALLEST_CUTOFF", "PseudoInverse"]

SMALLEST_CUTOFF = 1e-9
"""The smallest cutoff that counts, relative to the largest singular value. The rounding of J, some 1e-15 of it, changes
smaller singular values by a millionth and more, and steps along them can be a billion times as long as the residual."""


@dataclass(frozen=True, kw_only=True)
class PseudoInverse(JacobianSolver):
    r"""$\Delta q = J^\dagger e + (I - J^\dagger J)\,\varphi$ with
    $J^\dagger = \sum_{\sigma_i > \tau} \sigma_i^{-1} v_i u_i^\top$.

    This is the shortest step that minimises the linearised residual. Singular values below τ = cutoff · σ₁ are dropped,
    and those below 1e-9 · σ₁ whatever the cutoff, because they are mostly rounding.
    φ pulls towards a rest posture in the null space, without moving the effector.

    Source: thesis, §3.2, eqs. 3.2.2 and 3.4.5 (Whitney 1969; Liégeois 1977).
    """

    name = "pinv"
    title = "Pseudo-inverse"
    about = "needs few steps away from singular configurations, but is unstable near them"
    max_iterations = 200
    restarts = 100
    patience = Patience(6, 0.05)
    converges_quadratically = True

    max_step: float = max_step_parameter(0.5)
    cutoff: float = parameter(
        1e-3,
        "singular values below this fraction of the largest are dropped",
        low=0.0,
        high=0.5,
        slider=(0.0, 0.2),
        level=1,
    )
    rest_posture: Mapping[str, float] = parameter({}, "joint angles to move towards in the null space", unit="rad or m")
    rest_gain: float = parameter(0.1, "fraction of the way to the rest posture covered per step", low=0.0, high=1.0)

    def direction(self, J: Array, e: Array, pull: Array | None = None, lightest: float = 1.0) -> Array:
        """J†e, plus (I − J†J)·pull for a pull (nv,); `lightest` is the smallest row weight divided by the largest."""
        left, sigma, right = np.linalg.svd(J, full_matrices=False)
        rank = int((sigma > self.smallest_kept(sigma, lightest)).sum())
        basis = right[:rank]  # (rank, nv): the row space
        dq: Array = (left[:, :rank].T.dot(e) / sigma[:rank]).dot(basis)
        return dq if pull is None else dq + pull - basis.T.dot(basis.dot(pull))

    def smallest_kept(self, sigma: Array, lightest: float = 1.0) -> float:
        """τ [m], up to which singular values (k,) are dropped; `lightest` as for `direction`."""
        return max(self.cutoff * lightest, SMALLEST_CUTOFF) * float(sigma[:1].sum())

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """The step, with the pull towards the rest posture if one is set."""
        problem = kinematics.problem
        if not self.rest_posture:
            return self.direction(at.J, at.e, None, problem.lightest)
        robot = kinematics.robot
        rest = at.q.copy()
        for name, angle in self.rest_posture.items():
            robot.settable_joint(name).set_angle(rest, angle)
        pull = self.rest_gain * pinocchio.difference(robot.model, at.q, rest) * at.free
        roots = self.roots(problem)
        if roots is not None:
            pull = pull * roots
        return self.direction(at.J, at.e, pull, problem.lightest)
