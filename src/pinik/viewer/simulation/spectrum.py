"""The singular values of a Jacobian, and the factors by which a method turns a residual into a step along each."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...problem.kinematics import Linearization
from ...problem.problem import Problem
from ...solvers.base import Solver
from ...solvers.damped_least_squares import DampedLeastSquares
from ...solvers.pseudo_inverse import SMALLEST_CUTOFF, PseudoInverse
from ...solvers.transpose import JacobianTranspose

__all__ = ["Spectrum", "spectrum_of"]

Array = NDArray[np.float64]


class Spectrum(NamedTuple):
    """J = Σ σᵢ uᵢ vᵢᵀ, and the step Δq = Σ gᵢ (uᵢᵀe) vᵢ of a method; k is the smaller side of J.

    Attributes:
        sigma: σᵢ (k,) [m], the largest first.
        parts: uᵢᵀe (k,) [m]: how much of the residual points along each direction.
        gains: gᵢ (k,) [1/m]: ασᵢ for the transpose, 1/σᵢ or 0 for the pseudo-inverse, σᵢ/(σᵢ²+λ²) for damped least
            squares; empty for other methods.
        value: α, τ [m] or λ [m] of those three methods; None for other methods.
        gradient: Jᵀe (n,) for the n free coordinates.
        freedom: The diagonal of I − J†J (n,): the share of each coordinate's motion that moves no target.
        nullity: The dimension of the null space of J.
    """

    sigma: Array
    parts: Array
    gains: Array
    value: float | None
    gradient: Array
    freedom: Array
    nullity: int


def spectrum_of(solver: Solver, at: Linearization, problem: Problem, asked: Array) -> Spectrum:
    """The spectrum of the Jacobian that a method is given.

    Args:
        solver: The method.
        at: What it is given.
        problem: The targets.
        asked: The step (nv,) that it returns, from which the transpose's α follows.
    """
    J = at.J[:, problem.free]
    left, sigma, right = np.linalg.svd(J, full_matrices=False)
    gradient = J.T.dot(at.e)
    rank = int((sigma > SMALLEST_CUTOFF * sigma[:1].sum()).sum())
    gains, value = _gains(solver, at, problem, sigma, asked)
    return Spectrum(
        sigma=sigma,
        parts=left.T.dot(at.e),
        gains=gains,
        value=value,
        gradient=gradient,
        freedom=1.0 - (right[:rank] ** 2).sum(axis=0),
        nullity=J.shape[1] - rank,
    )


def _gains(
    solver: Solver, at: Linearization, problem: Problem, sigma: Array, asked: Array
) -> tuple[Array, float | None]:
    if isinstance(solver, JacobianTranspose):
        gradient = at.J.T.dot(at.e)
        squared = float(gradient.dot(gradient))
        alpha = float(gradient.dot(asked)) / squared if squared > 0.0 else 0.0
        return alpha * sigma, alpha
    if isinstance(solver, PseudoInverse):
        least = solver.smallest_kept(sigma, problem.lightest)
        return np.divide(1.0, sigma, out=np.zeros_like(sigma), where=sigma > least), least
    if isinstance(solver, DampedLeastSquares):
        squared = solver.damping_squared(at.J, at.distance)
        return sigma / (sigma * sigma + squared), math.sqrt(squared)
    return np.zeros(0), None
