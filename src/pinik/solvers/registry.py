"""The registry of solvers, and their look-up by name."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
from typing import Any, TypeGuard

from ..errors import InputError, UnknownNameError
from .base import JacobianSolver, Solver, SweepingSolver
from .ccd import CCD
from .damped_least_squares import DampedLeastSquares
from .pseudo_inverse import PseudoInverse
from .transpose import JacobianTranspose
from .two_bone import TwoBoneSolver

__all__ = ["CLOSED_FORMS", "SOLVERS", "Method", "known_methods", "make_solver", "meant_by"]

Method = str | type[Solver] | Solver
"""How users give a method: a short name or "module:Class", a class, or an instance with its parameters."""

SOLVERS: dict[str, type[Solver]] = {
    solver.name: solver for solver in (CCD, JacobianTranspose, PseudoInverse, DampedLeastSquares)
}
"""Short name → class. A class that you add here is available everywhere in pinik."""

CLOSED_FORMS: dict[str, type[Solver]] = {TwoBoneSolver.name: TwoBoneSolver}
"""Short name → class of the methods that suit only some robots; for others they raise an error with the reason."""


def known_methods() -> dict[str, type[Solver]]:
    """Short name → class of every method: first those for any robot, then the closed forms."""
    return SOLVERS | {name: solver for name, solver in CLOSED_FORMS.items() if name not in SOLVERS}


def meant_by(method: Method) -> type[Solver] | Solver:
    """The class that a method's name refers to; a class or an instance is returned unchanged.

    Raises:
        UnknownNameError: There is no such method.
    """
    if isinstance(method, str):
        return SOLVERS.get(method) or _class_by_name(method)
    return method


def make_solver(method: Method, **parameters: Any) -> Solver:
    """Make a solver from a method and its parameters.

    Args:
        method: A name in `SOLVERS` or `CLOSED_FORMS`, "module:Class" for a class to import, a class, or an instance.
        **parameters: The solver's parameters; they replace those of an instance.

    Raises:
        UnknownNameError: There is no such method or parameter.
        InputError: A value is out of range, or `method` is not a solver.
    """
    if isinstance(method, Solver) and _is_complete(type(method)):
        return type(method).make(**(method.parameters | parameters)) if parameters else method
    method = meant_by(method)
    if not _is_complete(method):
        raise InputError(f"method must be a name ({', '.join(SOLVERS)}), a Solver class or an instance; got {method!r}")
    if any(isinstance(value, dataclasses.Field) for value in vars(method).values()):
        raise InputError(f"{method.name}: the class must be decorated with @dataclass(frozen=True, kw_only=True)")
    return method.make(**parameters)


def _is_complete(method: object) -> TypeGuard[type[Solver]]:
    """Whether it is a solver class that defines all required methods."""
    bases = (JacobianSolver, SweepingSolver)
    return isinstance(method, type) and issubclass(method, bases) and not inspect.isabstract(method)


def _class_by_name(name: str) -> Any:
    known = known_methods()
    if name in known:
        return known[name]
    module, colon, attribute = name.partition(":")
    if colon:
        try:
            return getattr(importlib.import_module(module), attribute)
        except (ImportError, AttributeError, ValueError, TypeError) as error:
            raise UnknownNameError("method", name, known, f"could not import it: {error}") from None
    raise UnknownNameError("method", name, known)
