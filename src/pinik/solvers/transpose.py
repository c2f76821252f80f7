"""The Jacobian transpose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .base import Array, JacobianSolver, Patience
from .parameter import max_step_parameter, parameter

__all__ = ["JacobianTranspose"]


@dataclass(frozen=True, kw_only=True)
class JacobianTranspose(JacobianSolver):
    r"""$\Delta q = \alpha J^\top e$ with $\alpha = \langle e, JJ^\top e\rangle / \langle JJ^\top e, JJ^\top e\rangle$.

    This α minimises the linearised residual $\|e - \alpha JJ^\top e\|$. The method gets stuck where $J^\top e = 0$, for
    example when the target lies inwards along a straight arm.

    Source: thesis, §3.1, eq. 3.1.2 (Buss 2004; Wolovich and Elliott 1984).
    """

    name = "jt"
    title = "Jacobian transpose"
    about = "the cheapest step, without a linear system; needs many steps"
    max_iterations = 1000
    restarts = 20
    patience = Patience(50, 0.02)

    max_step: float = max_step_parameter(0.5)
    alpha: float | None = parameter(
        None,
        "length of a step along the gradient; automatic is the optimal value in every step",
        low=1e-6,
        high=1e3,
        slider=(1e-2, 10.0),
        optional=True,
        symbol="α",
        level=1,
    )

    def direction(self, J: Array, e: Array) -> Array:
        """α Jᵀe."""
        dq: Array = J.T.dot(e)
        if self.alpha is not None:
            return self.alpha * dq
        JJte = J.dot(dq)
        squared = float(JJte.dot(JJte))
        return dq * (float(e.dot(JJte)) / squared) if squared > 0.0 else np.zeros_like(dq)
