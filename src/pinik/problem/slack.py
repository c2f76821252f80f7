r"""Residuals that stop pulling inside a tolerance.

For an error $e = d\,u$ of length $d$ and a tolerance $t$, the loss $\tfrac12 \max(0, d - t)^2$ has the gradient
$-J^\top (d - t)\,u$. Without the curvature of the kinematics its Hessian is
$J^\top (u u^\top + (1 - t/d)(I - u u^\top)) J$. So the residual is $(d - t)\,u$, and the Jacobian's rows across $u$
are multiplied by $\sqrt{1 - t/d}$. Inside the tolerance both are zero, and the joints are free to serve other targets.

Source: after the ranges of RangedIK (Wang et al. 2023).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .tolerance import Three

__all__ = ["SHARE", "outside_ball", "outside_box"]

Array = NDArray[np.float64]

SHARE = 0.9
"""The part of a tolerance inside which a residual stops pulling; the rest keeps it from swinging across the edge."""


def outside_ball(e: Array, tolerance: float) -> tuple[Array, Array]:
    """(the part of an error (3,) outside a ball, the factor (3, 3) on its Jacobian's rows).

    Args:
        e: The error [m or rad].
        tolerance: The tolerance in the same unit, of which `SHARE` counts.
    """
    length, allowed = math.sqrt(e.dot(e)), SHARE * tolerance
    if length <= allowed:
        return np.zeros(3), np.zeros((3, 3))
    u = e / length
    across = math.sqrt(1.0 - allowed / length)
    return (length - allowed) * u, across * np.eye(3) + (1.0 - across) * np.outer(u, u)


def outside_box(e: Array, tolerance: Three, axes: Array) -> tuple[Array, Array]:
    """The same for a box whose axes are the columns of `axes` (3, 3)."""
    own = axes.T.dot(e)
    allowed = SHARE * np.array(tolerance)
    left = np.sign(own) * np.maximum(np.abs(own) - allowed, 0.0)
    return axes.dot(left), (axes * (left != 0.0)).dot(axes.T)
