"""Every error and warning of pinik. Each error is a `PinikError` and also the builtin that it resembles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any

from .echoes import bounded

__all__ = [
    "EngineError",
    "InputError",
    "InputWarning",
    "PinikError",
    "RobotLoadError",
    "SolveError",
    "UnknownNameError",
    "UrdfWarning",
    "near_names",
]

_MOST_SHOWN = 12


class PinikError(Exception):
    """The base class of all errors that pinik raises on purpose. Long names in a message lose their middle."""

    def __init__(self, message: str, **fields: Any) -> None:
        super().__init__(bounded(message), **fields)


class RobotLoadError(PinikError, ValueError):
    """A robot description cannot become a model; the message names the element and the cause.

    Attributes:
        source: The file (or "<text>") that was read.
        element: The faulty element, such as "joint 'elbow'", or None if the whole document is at fault.
        cause: What is wrong, without source and element.
        others: The errors for the other joints that are faulty, too.
    """

    def __init__(
        self,
        message: str,
        *,
        source: str = "<text>",
        element: str | None = None,
        others: Iterable[RobotLoadError] = (),
    ) -> None:
        self.source = source
        self.others = tuple(others)
        self.element = None if element is None else bounded(element)
        self.cause = bounded(message)
        where = f"{source}: {element}" if element else source
        super().__init__(f"{where}: {message}")

    def __reduce__(self) -> tuple[Any, ...]:
        given: dict[str, Any] = {"source": self.source, "element": self.element, "others": self.others}
        return partial(type(self), **given), (self.cause,)


class InputError(PinikError, ValueError):
    """An argument has the wrong shape, type or range; the message says what it must be.

    Attributes:
        argument: The argument at fault, such as "restarts"; None if it is not a single one.
        requirement: The message without the argument: "must be a whole number of at least 0; got -1".
    """

    def __init__(self, message: str, *, argument: str | None = None) -> None:
        """With `argument` the message starts with it: `InputError("must be positive", argument="time_limit")`."""
        self.argument = argument
        self.requirement = message
        super().__init__(message if argument is None else f"{argument} {message}")

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), argument=self.argument), (self.requirement,)


class UnknownNameError(PinikError, KeyError):
    """The robot, or a registry, has no such name.

    Attributes:
        kind: What was looked up: "frame", "joint", "robot", "method", "parameter".
        name: The name given.
        valid: The names that exist.
    """

    def __init__(self, kind: str, name: object, valid: Iterable[str], hint: str = "") -> None:
        """The message suggests similar names, or lists the valid ones; `hint` adds a remark."""
        self.kind = kind
        self.name = name
        self.valid = tuple(valid)
        self._hint = hint
        remark = f" ({hint})" if hint else ""
        super().__init__(f"no {kind} {name!r}; {_advice(name, self.valid)}{remark}")

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.kind, self.name, self.valid, self._hint)


def near_names(name: object, valid: Iterable[str], most: int = 4) -> tuple[str, ...]:
    """The valid names that a mistyped one resembles, the likeliest first.

    Names that begin with the given word come first, then close matches, then names that the word begins with.
    Upper and lower case count as equal.
    """
    from difflib import get_close_matches  # which few runs need

    word = str(name).casefold()
    if not word:
        return ()
    names: dict[str, str] = {}
    for one in valid:
        names.setdefault(one.casefold(), one)
    # A much longer word is close to none of the names, and a search with it would take long.
    similar = len(word) <= 3 * max(map(len, names), default=0)
    close = get_close_matches(word, names, n=most, cutoff=0.6) if similar else []
    longer = sorted((one for one in names if one.startswith(word)), key=len)
    shorter = sorted((one for one in names if one and word.startswith(one)), key=len, reverse=True)
    ranked = dict.fromkeys([*longer, *close, *shorter])
    return tuple(names[one] for one in ranked)[:most]


def _advice(name: object, valid: Sequence[str]) -> str:
    near = [repr(one) for one in near_names(name, valid)]
    if near:
        *others, last = near
        return f"did you mean {', '.join(others)} or {last}?" if others else f"did you mean {last}?"
    if not valid:
        return "there are none"
    more = len(valid) - _MOST_SHOWN
    return f"available: {', '.join(map(repr, valid[:_MOST_SHOWN]))}" + (f" and {more} more" if more > 0 else "")


class SolveError(PinikError, RuntimeError):
    """Raised by `Solution.raise_for_status` if a target was missed.

    Attributes:
        solution: The `Solution` with the best configuration found.
    """

    def __init__(self, message: str, solution: object) -> None:
        self.solution = solution
        super().__init__(message)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.solution)


class EngineError(PinikError, RuntimeError):
    """The requested engine is not available; the message says why."""


class InputWarning(UserWarning):
    """pinik changed an argument that was slightly off, such as a rounded rotation matrix; or one looks like degrees."""


class UrdfWarning(UserWarning):
    """pinik repaired or ignored something in a robot description."""
