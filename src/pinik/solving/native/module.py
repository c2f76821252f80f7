"""The compiled module `pinik._native`, or the reason why it cannot be used."""

from __future__ import annotations

import functools
import importlib.util
import warnings
from typing import Any

import pinocchio

from ...solvers.base import Solver
from ...solvers.ccd import CCD
from ...solvers.damped_least_squares import DampedLeastSquares
from ...solvers.pseudo_inverse import PseudoInverse
from ...solvers.transpose import JacobianTranspose

__all__ = ["ABI", "METHODS", "load", "why_not"]

ABI = "8e56e3da008999bf"
"""The digest of the module's stub, which identifies its signatures; the module contains the same digest
(src/native/bindings/abi.hpp)."""

METHODS: tuple[type[Solver], ...] = (CCD, JacobianTranspose, PseudoInverse, DampedLeastSquares)
"""The solvers that the compiled engine implements; a class derived from one of them runs in Python."""


@functools.cache
def load() -> Any:
    """Return the compiled module, or a string that says why it cannot be used."""
    if importlib.util.find_spec("pinik._native") is None:
        return "it was not built when pinik was installed, because no C++ compiler worked"
    try:
        from ... import _native
    except ImportError as error:
        return f"it does not load: {error}"
    if getattr(_native, "abi", None) != ABI:
        why = "the compiled module belongs to another build of pinik; install pinik again"
        warnings.warn(f"pinik solves in Python, tens of times slower: {why}", RuntimeWarning, stacklevel=2)
        return why
    if _native.pinocchio_version != pinocchio.__version__:
        return (
            f"it was built against Pinocchio {_native.pinocchio_version}, and {pinocchio.__version__} is installed; "
            "install pinik again"
        )
    return _native


def why_not(solver: Solver | None = None) -> str | None:
    """Return why the compiled engine cannot run (this solver), or None if it can."""
    module = load()
    if isinstance(module, str):
        return module
    if solver is not None and type(solver) not in METHODS:
        return f"the method {solver.name!r} is written in Python"
    return None
