"""The pseudo-inverse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio

from .base import Array, JacobianSolver, Patience, max_step_parameter, parameter

if TYPE_CHECKING:
    from ..problem.kinematics import Kinematics, Linearization

__all__ = ["PseudoInverse"]

SMALLEST_SINGULAR_VALUE = 1e-12


@dataclass(frozen=True, kw_only=True)
class PseudoInverse(JacobianSolver):
    r"""$\Delta q = J^\dagger e + (I - J^\dagger J)\,\varphi$ with
    $J^\dagger = \sum_{\sigma_i > \tau} \sigma_i^{-1} v_i u_i^\top$.

    The shortest step that solves the linearised problem best. Singular values below τ = cutoff · σ₁ (and
    1e-12) are dropped; φ pulls towards a rest posture inside the null space, where it does not move the effector.

    Source: thesis, §3.2, eqs. 3.2.2 and 3.4.5 (Whitney 1969; Liégeois 1977).
    """

    name = "pinv"
    title = "Pseudo-inverse"
    about = "few steps away from singular configurations, wild near them"
    max_iterations = 200
    restarts = 100
    patience = Patience(6, 0.05)

    max_step: float = max_step_parameter(0.5)
    cutoff: float = parameter(
        1e-3, "singular values below this part of the largest are dropped", low=0.0, high=0.5, slider=(0.0, 0.2)
    )
    rest_posture: Mapping[str, float] = parameter({}, "joint angles to tend to in the null space", unit="rad or m")
    rest_gain: float = parameter(0.1, "part of the way to the rest posture taken in one step", low=0.0, high=1.0)

    def direction(self, J: Array, e: Array, pull: Array | None = None, lightest: float = 1.0) -> Array:
        """J†e, and (I − J†J)·pull with a pull (nv,); rows may be as light as the part `lightest` of the others."""
        left, sigma, right = np.linalg.svd(J, full_matrices=False)
        rank = int((sigma > max(self.cutoff * lightest * sigma[:1].sum(), SMALLEST_SINGULAR_VALUE)).sum())
        basis = right[:rank]  # (rank, nv): the row space
        dq: Array = (left[:, :rank].T.dot(e) / sigma[:rank]).dot(basis)
        return dq if pull is None else dq + pull - basis.T.dot(basis.dot(pull))

    def step(self, at: Linearization, kinematics: Kinematics) -> Array:
        """`direction`, with the pull towards the rest posture where one is set."""
        if not self.rest_posture:
            return self.direction(at.J, at.e, None, kinematics.lightest)
        robot = kinematics.robot
        rest = at.q.copy()
        for name, angle in self.rest_posture.items():
            robot.settable_joint(name).set_angle(rest, angle)
        pull = self.rest_gain * pinocchio.difference(robot.model, at.q, rest) * at.free
        roots = self.roots(kinematics)
        if roots is not None:
            pull = pull * roots
        return self.direction(at.J, at.e, pull, kinematics.lightest)
