"""Everything pinik raises: a `PinikError` that is also the builtin it resembles."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from functools import partial
from typing import Any

__all__ = [
    "EngineError",
    "InputError",
    "PinikError",
    "RobotLoadError",
    "SolveError",
    "UnknownNameError",
    "UrdfWarning",
]


class PinikError(Exception):
    """The root of all errors that pinik raises on purpose."""


class RobotLoadError(PinikError, ValueError):
    """A robot description that cannot become a model; the message names the element and the cause.

    Attributes:
        source: The file (or "<text>") that was read.
        element: The faulty element, such as "joint 'elbow'", or None where the whole document is at fault.
    """

    def __init__(self, message: str, *, source: str = "<text>", element: str | None = None) -> None:
        self.source = source
        self.element = element
        self._message = message
        where = f"{source}: {element}" if element else source
        super().__init__(f"{where}: {message}")

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), source=self.source, element=self.element), (self._message,)


class InputError(PinikError, ValueError):
    """An argument of the wrong shape, kind or range; the message says what would be right."""


class UnknownNameError(PinikError, KeyError):
    """A name that the robot (or a registry) does not have.

    Attributes:
        kind: What was asked for: "frame", "joint", "robot", "method", "parameter".
        name: The name given.
        valid: The names that would have been right.
    """

    def __init__(self, kind: str, name: object, valid: Iterable[str], hint: str = "") -> None:
        self.kind = kind
        self.name = name
        self.valid = tuple(valid)
        self._hint = hint
        near = get_close_matches(str(name), self.valid, n=4, cutoff=0.6)
        if near:
            help_ = "near: " + ", ".join(repr(n) for n in near)
        else:
            shown = ", ".join(repr(n) for n in self.valid[:12]) or "none"
            help_ = f"there are: {shown}" + (f" and {len(self.valid) - 12} more" if len(self.valid) > 12 else "")
        super().__init__(f"no {kind} {name!r}; {help_}" + (f"; {hint}" if hint else ""))

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.kind, self.name, self.valid, self._hint)


class SolveError(PinikError, RuntimeError):
    """Raised by `Solution.raise_for_status` when the targets were missed.

    Attributes:
        solution: The `Solution` with the best configuration found.
    """

    def __init__(self, message: str, solution: object) -> None:
        self.solution = solution
        super().__init__(message)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.solution)


class EngineError(PinikError, RuntimeError):
    """The engine that was asked for is not there; the message says why."""


class UrdfWarning(UserWarning):
    """Something in a robot description that pinik mended or left out, named in words."""
