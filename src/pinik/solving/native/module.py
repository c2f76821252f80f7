"""The methods that the compiled engine knows, and the reason why it cannot run others."""

from __future__ import annotations

from ...engine import load
from ...errors import EngineError
from ...solvers.base import Solver
from ...solvers.ccd import CCD
from ...solvers.damped_least_squares import DampedLeastSquares
from ...solvers.pseudo_inverse import PseudoInverse
from ...solvers.transpose import JacobianTranspose

__all__ = ["METHODS", "engine_for", "why_not"]

METHODS: tuple[type[Solver], ...] = (CCD, JacobianTranspose, PseudoInverse, DampedLeastSquares)
"""The solvers that the compiled engine implements; a class derived from one of them runs in Python."""


def why_not(solver: Solver | None = None) -> str | None:
    """Return why the compiled engine cannot run (this solver), or None if it can."""
    module = load()
    if isinstance(module, str):
        return module
    if solver is not None and type(solver) not in METHODS:
        return f"the method {solver.name!r} is written in Python"
    return None


def engine_for(solver: Solver, asked: str) -> str:
    """The engine to use; for "auto", the compiled engine if it is available for this solver.

    Raises:
        EngineError: The compiled engine was asked for but cannot be used.
    """
    why = why_not(solver)
    if asked == "native" and why:
        raise EngineError(f"the compiled engine cannot be used: {why}; use engine='auto' or 'python' instead")
    return "python" if asked == "python" or why else "native"
