"""The solvers, and how one is found by name."""

from __future__ import annotations

import importlib
from typing import Any

from ..errors import InputError, UnknownNameError
from .base import JacobianSolver, Patience, Solver, SweepingSolver, parameter
from .ccd import CCD
from .damped_least_squares import DampedLeastSquares
from .pseudo_inverse import PseudoInverse
from .transpose import JacobianTranspose

__all__ = [
    "CCD",
    "SOLVERS",
    "DampedLeastSquares",
    "JacobianSolver",
    "JacobianTranspose",
    "Patience",
    "PseudoInverse",
    "Solver",
    "SweepingSolver",
    "make_solver",
    "parameter",
]

SOLVERS: dict[str, type[Solver]] = {
    solver.name: solver for solver in (CCD, JacobianTranspose, PseudoInverse, DampedLeastSquares)
}
"""Short name → class. Add your own class here and every front of pinik knows it."""


def make_solver(method: str | type[Solver] | Solver, **parameters: Any) -> Solver:
    """The solver that is meant.

    Args:
        method: A name in `SOLVERS`, "module:Class" for one that is imported, a class, or an instance.
        **parameters: The solver's parameters; with an instance they replace its own.

    Raises:
        UnknownNameError: No such method or parameter.
        InputError: A value out of its range, or something that is no solver.
    """
    if isinstance(method, Solver):
        if not parameters:
            return method
        return type(method).make(**(method.parameters | parameters))
    if isinstance(method, str):
        method = _class_by_name(method)
    if not (isinstance(method, type) and issubclass(method, Solver)):
        raise InputError(f"method is a name ({', '.join(SOLVERS)}), a Solver class or an instance; got {method!r}")
    return method.make(**parameters)


def _class_by_name(name: str) -> Any:
    if name in SOLVERS:
        return SOLVERS[name]
    module, colon, attribute = name.partition(":")
    if colon:
        try:
            return getattr(importlib.import_module(module), attribute)
        except (ImportError, AttributeError) as error:
            raise UnknownNameError("method", name, SOLVERS, f"could not import it: {error}") from None
    raise UnknownNameError("method", name, SOLVERS)
