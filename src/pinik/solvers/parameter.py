"""The parameters of solvers: range, unit and meaning, used for checks, help texts and sliders."""

from __future__ import annotations

import contextlib
import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import InputError

__all__ = ["JointValues", "Parameter", "max_step_parameter", "parameter", "parameters_of", "stiffness_parameter"]


class JointValues(Mapping[str, float]):
    """An immutable, hashable mapping from joint names to numbers, equal to any mapping with the same items."""

    __slots__ = ("_hash", "_values")

    def __init__(self, values: Mapping[str, float] = {}) -> None:
        self._values = dict(values)
        self._hash = hash(frozenset(self._values.items()))

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mapping) and self._values == dict(other)

    def __repr__(self) -> str:
        return repr(self._values)

    def __reduce__(self) -> tuple[Any, ...]:
        return JointValues, (self._values,)


@dataclass(frozen=True)
class Parameter:
    """One parameter of a solver.

    Attributes:
        default: The default value.
        help: The meaning, in one line.
        unit: The unit, such as "rad".
        low, high: The range, ends included; None for no bound.
        slider: The part of the range that a slider covers; the whole range when None.
        choices: The allowed strings, for a choice.
        optional: Whether None is allowed as a value with its own meaning.
        unbounded: Whether infinity is allowed; None stands for it too, because JSON has no infinity.
        symbol: The symbol that formulas use, such as "λ".
        level: 1 for the parameter that matters most, 2 for those worth trying, 3 for the rest.
        name: The name of the dataclass field.
    """

    default: Any
    help: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    slider: tuple[float, float] | None = None
    choices: tuple[str, ...] = ()
    optional: bool = False
    unbounded: bool = False
    symbol: str = ""
    level: int = 2
    name: str = ""

    @cached_property
    def kind(self) -> str:
        """One of "choice", "truth", "joints" (joint name → number) and "number"."""
        if self.choices:
            return "choice"
        if isinstance(self.default, bool):
            return "truth"
        return "joints" if isinstance(self.default, JointValues) else "number"

    def check(self, value: Any, method: str) -> Any:
        """Check a value for a method's parameter, and return it in its immutable form.

        Raises:
            InputError: The value has the wrong type or is out of range.
        """
        what = f"{method}: {self.name}"
        if value is None and self.optional:
            return None
        if value is None and self.unbounded:
            return math.inf
        match self.kind:
            case "choice":
                if not isinstance(value, str) or value not in self.choices:
                    raise InputError(f"{what} must be one of {', '.join(map(repr, self.choices))}; got {value!r}")
                return value
            case "truth":
                if not isinstance(value, (bool, np.bool_)):
                    raise InputError(f"{what} must be true or false; got {value!r}")
                return bool(value)
            case "joints":
                if not isinstance(value, Mapping):
                    raise InputError(f"{what} must map joint names to numbers; got {value!r}")
                return JointValues({str(n): self._number(v, f"{what}[{n!r}]") for n, v in value.items()})
        number = self._number(value, what)
        return int(number) if self.is_whole and number.is_integer() else number

    @property
    def is_whole(self) -> bool:
        """Whether the values are whole numbers."""
        return isinstance(self.default, int) and not isinstance(self.default, bool)

    def _number(self, value: Any, what: str) -> float:
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None else self.high
        number = math.nan
        if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
            with contextlib.suppress(OverflowError):
                number = float(value)
        if not low <= number <= high or not (self.unbounded or math.isfinite(number)):
            bounds = "a number" if self.unbounded else "a finite number"
            if math.isfinite(high):
                bounds += f" from {low:g} to {high:g}"
            elif math.isfinite(low):
                bounds += f" of at least {low:g}"
            unit = f" [{self.unit}]" if self.unit else ""
            none = " or None" if self.optional else ""
            raise InputError(f"{what} must be {bounds}{unit}{none}; got {value!r}")
        return number

    def plain(self, value: Any) -> Any:
        """A value in its JSON form: infinity becomes None, and a mapping becomes a dict."""
        if isinstance(value, float) and not math.isfinite(value):
            return None
        return dict(value) if isinstance(value, Mapping) else value

    @property
    def none_means(self) -> str | None:
        """The meaning of None, in words; None if None is not allowed."""
        return "automatic" if self.optional else "no limit" if self.unbounded else None

    @property
    def range_in_words(self) -> str:
        """The allowed values, such as "0.01 to 1.99 rad"; without a range, only the unit."""
        if self.choices:
            return " | ".join(self.choices)
        if self.kind == "truth":
            return "true | false"
        unit = f" {self.unit}" if self.unit else ""
        if self.low is None and self.high is None:
            return self.unit
        if self.high is None:
            return f"at least {self.low:g}{unit}"
        return f"at most {self.high:g}{unit}" if self.low is None else f"{self.low:g} to {self.high:g}{unit}"

    @property
    def default_in_words(self) -> str:
        """The default in the syntax of the command line."""
        if isinstance(self.default, float):
            return f"{self.default:.4g}"
        return "null" if self.default is None else str(self.default).lower()


def parameter(
    default: Any,
    help: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    slider: tuple[float, float] | None = None,
    choices: tuple[str, ...] = (),
    optional: bool = False,
    unbounded: bool = False,
    symbol: str = "",
    level: int = 2,
) -> Any:
    """A dataclass field for a solver's parameter; the arguments are those of `Parameter`."""
    own = JointValues(default) if isinstance(default, Mapping) else default
    described = Parameter(own, help, unit, low, high, slider, tuple(choices), optional, unbounded, symbol, level)
    return dataclasses.field(default=own, metadata={"parameter": described})


def parameters_of(solver: type[Any]) -> tuple[Parameter, ...]:
    """The parameters of a solver class, in field order; fields that were not made by `parameter` are left out."""
    known: tuple[Parameter, ...] | None = vars(solver).get("_parameters")
    if known is None:
        known = tuple(
            dataclasses.replace(field.metadata["parameter"], name=field.name)
            for field in dataclasses.fields(solver)
            if "parameter" in field.metadata
        )
        solver._parameters = known
    return known


def max_step_parameter(default: float) -> Any:
    """The parameter that limits a step; its default differs between methods."""
    help_ = "largest change of one joint in one step"
    return parameter(default, help_, unit="rad or m", low=1e-6, slider=(0.01, 3.2), unbounded=True)


def stiffness_parameter(help: str) -> Any:
    """The parameter with a weight from 0 to 1 for the motion of each joint."""
    return parameter({}, help, low=0.0, high=1.0, symbol="w_i")
