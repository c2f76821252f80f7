"""The options of a solve, defined and checked in one place."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..checks import as_count, as_finite_number, as_names, as_positive_number
from ..errors import InputError, UnknownNameError
from ..problem.tolerance import Tolerance
from ..shapes.avoid import Avoid, Avoided
from ..solvers.base import Solver
from ..solvers.damped_least_squares import DampedLeastSquares
from ..solvers.parameter import JointValues
from ..solvers.registry import Method, make_solver

__all__ = ["CHOICES", "ENGINES", "OPTION_NAMES", "Options"]

ENGINES = ("auto", "python", "native")
CHOICES = ("first", "nearest")

# The maximum number of iterations of the last run, which continues the best failed attempt.
_TO_THE_END_AT_MOST = 5000


def _truth(value: object, what: str) -> bool:
    """`value` as a truth value; InputError for anything else."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"must be True or False; got {value!r}", argument=what)
    return bool(value)


def _names(value: Iterable[str], what: str) -> tuple[str, ...]:
    return as_names(value, what)


def _count(value: int, what: str) -> int:
    return as_count(value, what, least=0)


def _count_or_none(least: int) -> Callable[[int | None, str], int | None]:
    return lambda value, what: None if value is None else as_count(value, what, least)


def _tolerance(value: Tolerance | ArrayLike | None, what: str) -> Tolerance:
    return Tolerance.of(value)


def _seconds(value: float | None, what: str) -> float:
    return math.inf if value is None or value == math.inf else as_positive_number(value, what, "seconds")


def _engine(value: str, what: str) -> str:
    if value not in ENGINES:
        raise UnknownNameError("engine", value, ENGINES)
    return value


def _choice(value: str, what: str) -> str:
    if value not in CHOICES:
        raise UnknownNameError("choice", value, CHOICES)
    return value


def _factors(value: Mapping[str, float] | None, what: str) -> JointValues:
    if value is not None and not isinstance(value, Mapping):
        raise InputError(f"must map joint names to numbers; got {value!r}", argument=what)
    factors = {name: as_finite_number(factor, f"{what}[{name!r}]") for name, factor in (value or {}).items()}
    for name, factor in factors.items():
        if factor < 0.0:
            raise InputError(f"must be at least 0; got {factor:g}", argument=f"{what}[{name!r}]")
    return JointValues(factors)


def _avoided(value: Avoided, what: str) -> Avoid:
    return Avoid.of(value)


@dataclass(frozen=True)
class Options:
    """The options of a solve: checked, immutable and hashable.

    Attributes:
        method: The solver with its parameters; given as a name, a class or an instance.
        limits: Whether to enforce the joint limits.
        locked: The names of joints that must not move.
        restarts: The maximum number of restarts after a failed attempt; the solver's default when None.
        seed: The seed of the random starts.
        max_iterations: The maximum number of iterations per attempt; the solver's default when None.
        tolerance: The errors that count as reached.
        time_limit: Time limit for one problem [s]; infinite, or None, for no limit.
        engine: "auto", "python" or "native".
        trace: Whether to keep every state.
        polish: Whether methods that converge quadratically go on within the tolerance, while a step still halves the
            residual.
        choose: "first" for the first answer found; "nearest" for the distinct answer nearest to the start.
        choose_weights: Joint name → factor on the change of that joint in "nearest"; 1 for joints not named.
        avoid: What must not touch; given as "self", a World, or a list of these.

    Raises:
        UnknownNameError: There is no such method, engine or choice.
        InputError: A value has the wrong type or is out of range.
    """

    method: Solver = field(default=DampedLeastSquares(), metadata={"check": lambda value, what: make_solver(value)})
    limits: bool = field(default=True, metadata={"check": _truth})
    locked: tuple[str, ...] = field(default=(), metadata={"check": _names})
    restarts: int | None = field(default=None, metadata={"check": _count_or_none(0)})
    seed: int = field(default=0, metadata={"check": _count})
    max_iterations: int | None = field(default=None, metadata={"check": _count_or_none(1)})
    tolerance: Tolerance = field(default=Tolerance(), metadata={"check": _tolerance})
    time_limit: float = field(default=math.inf, metadata={"check": _seconds})
    engine: str = field(default="auto", metadata={"check": _engine})
    trace: bool = field(default=False, metadata={"check": _truth})
    polish: bool = field(default=True, metadata={"check": _truth})
    choose: str = field(default="first", metadata={"check": _choice})
    choose_weights: Mapping[str, float] = field(default=JointValues(), metadata={"check": _factors})
    avoid: Avoid = field(default=Avoid(), metadata={"check": _avoided})

    def __post_init__(self) -> None:
        """Check every option."""
        for own in dataclasses.fields(self):
            object.__setattr__(self, own.name, own.metadata["check"](getattr(self, own.name), own.name))

    @classmethod
    def of(cls, method: Method = "dls", parameters: dict[str, Any] | None = None, **options: Any) -> Options:
        """Make options from a method, its parameters and the other options.

        Args:
            method: A solver's name, class or instance.
            parameters: The solver's parameters, by name.
            **options: The other options.
        """
        return cls(make_solver(method, **(parameters or {})), **options)

    @property
    def restarts_at_most(self) -> int:
        """For pinik itself: the maximum number of restarts after a failed attempt."""
        return self.method.restarts if self.restarts is None else self.restarts

    @property
    def iterations_at_most(self) -> int:
        """For pinik itself: the maximum number of iterations per attempt."""
        return self.method.max_iterations if self.max_iterations is None else self.max_iterations

    @property
    def iterations_to_the_end(self) -> int:
        """For pinik itself: that of the last run, which continues the best failed attempt."""
        return _TO_THE_END_AT_MOST if self.max_iterations is None else self.max_iterations


OPTION_NAMES = tuple(own.name for own in dataclasses.fields(Options) if own.name != "method")
"""The names of all options except the method."""
