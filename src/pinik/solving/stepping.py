"""One step of any solver: clamped, scaled and kept inside the joint limits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..checks import FARTHEST
from ..errors import InputError
from ..model.limits import Limits
from ..problem.kinematics import Kinematics, Linearization
from ..problem.tolerance import Tolerance
from ..solvers.base import JacobianSolver, Solver, SweepingSolver

__all__ = ["advance"]

Array = NDArray[np.float64]


def advance(
    solver: Solver, kinematics: Kinematics, limits: Limits, at: Linearization, tolerance: Tolerance, scale: float = 1.0
) -> tuple[Array, int]:
    """(the next configuration, the number of single-joint updates); `scale` shortens a Jacobian method's step."""
    if isinstance(solver, SweepingSolver):
        q, updates = solver.sweep(at.q, kinematics, limits, tolerance)
        if np.shape(q) != at.q.shape:
            raise InputError(f"{solver.name}.sweep must return q of shape {at.q.shape}; got {np.shape(q)}")
        return (limits.clip(q), updates) if np.isfinite(q).all() else (at.q, updates)
    assert isinstance(solver, JacobianSolver)
    if solver.max_residual < math.inf:
        at = at._replace(e=kinematics.shortened(at.e, solver.max_residual))
    q = _stepped(solver, kinematics, at, scale)
    if not limits.enabled:
        return q, 0
    inside = limits.clip(q)
    if (inside == q).all():
        return q, 0
    return _step_along_limits(q, solver, kinematics, limits, at, scale), 0


def _stepped(solver: JacobianSolver, kinematics: Kinematics, at: Linearization, scale: float) -> Array:
    """The configuration after the step, clamped and scaled. Joints that are not free keep their exact values.

    There is no step where residual or step are not finite, or where a joint would move by more than 1e9 [rad or m].
    """
    problem = kinematics.problem
    roots = solver.roots(problem)
    dq = solver.step(at if roots is None else at._replace(J=at.J * roots), kinematics)
    if np.shape(dq) != at.free.shape:
        raise InputError(f"{solver.name}.direction must return dq of shape {at.free.shape}; got {np.shape(dq)}")
    if not np.isfinite(dq).all():
        return at.q  # without a step, the run ends as stalled
    dq = dq * (at.free if roots is None else at.free * roots)
    largest = float(np.abs(dq).max(initial=0.0))
    scale *= solver.step_size
    if min(largest, solver.max_step) * scale > FARTHEST:
        return at.q
    if largest > solver.max_step:
        scale *= solver.max_step / largest
    if scale != 1.0:
        dq = dq * scale
    return problem.moved(at.q, dq)


def _step_along_limits(
    q: Array, solver: JacobianSolver, kinematics: Kinematics, limits: Limits, at: Linearization, scale: float
) -> Array:
    """Compute the step again after a first step to `q` left the limits.

    Joints that are at a limit and would cross it are held fixed, and the step is computed for the other joints. This
    repeats until no further joint would cross a limit; the result is then clipped.
    """
    held = np.zeros_like(at.free)
    while True:
        inside = limits.clip(q)
        pushing = limits.blocked(at.q, q, inside) & ~held
        if not pushing.any():
            return inside
        held |= pushing
        J = at.J.copy()
        J[:, held] = 0.0
        free = at._replace(J=J, free=at.free & ~held)
        q = _stepped(solver, kinematics, free, scale)
