"""The keywords of `solve` and its relatives, sorted into targets, options and the method's parameters."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from ..errors import InputError, UnknownNameError
from ..problem.target_json import TARGET_KEYWORDS
from ..problem.targets import Target, as_targets
from ..solvers.base import Solver, field_names
from ..solvers.registry import SOLVERS, Method, meant_by
from .options import OPTION_NAMES, Options

__all__ = ["PLACE_WORDS", "UNWEIGHTED", "Wanted", "asked_targets", "check_words", "options_of"]

Wanted = tuple[Any, ...]
"""The values of a target's keywords, in the order of `PLACE_WORDS`."""

PLACE_WORDS = ("position", *TARGET_KEYWORDS)
"""The keywords of a target besides its frame."""

UNWEIGHTED = 1.0
"""The default weight of a target; this very object shows that no weight was given."""


def check_words(method: Method, words: Collection[str], offered: Sequence[str]) -> None:
    """Check that all remaining keywords are parameters of the method.

    Args:
        method: The method.
        words: The keywords given in addition to those of targets and options.
        offered: The keywords that the calling function has.

    Raises:
        UnknownNameError: A keyword is not a parameter of the method; the error suggests similar keywords.
    """
    if not words:
        return
    unknown = None
    meant = meant_by(method)
    solver = meant if isinstance(meant, type) else type(meant)
    own = field_names(solver) if isinstance(solver, type) and issubclass(solver, Solver) else []
    for word in words:
        if word not in own:
            unknown = word
            break
    if unknown is not None:
        known = dict.fromkeys([*offered, "method", *own])
        hint = f"the method is {solver.name!r}{_whose(unknown)}" if own else ""
        raise UnknownNameError("keyword", unknown, known, hint)


def _whose(word: str) -> str:
    """Say where a word that this call does not have belongs."""
    if word == "solver":
        return ", given as method="
    others = [name for name, solver in SOLVERS.items() if word in field_names(solver)]
    return f"; {word} belongs to {', '.join(map(repr, others))}" if others else ""


def asked_targets(
    targets: str | Target | Iterable[Target],
    wanted: Wanted,
    method: Method,
    parameters: Mapping[str, Any],
    options: Sequence[str] = ("q0", *OPTION_NAMES),
) -> tuple[Target, ...]:
    """The targets of a call: one made from a frame's name and the target's keywords, or the Target objects as given.

    Args:
        targets: A frame's name or targets.
        wanted: The values of a target's keywords, in the order of `PLACE_WORDS`.
        method: The method.
        parameters: The keywords given in addition to those of targets and options.
        options: The other keywords that the calling function has.

    Raises:
        UnknownNameError: There is no such keyword.
        InputError: The target is faulty, a target's keywords were given together with Target objects, or the method is
            none.
    """
    check_words(method, parameters, (*PLACE_WORDS, *options))
    if not isinstance(method, (str, Solver, type)):
        raise InputError(
            f"must be a name, a Solver class or an instance; a position is given as position=…; got {method!r}",
            argument="method",
        )
    if isinstance(targets, str):
        return (Target(targets, **dict(zip(PLACE_WORDS, wanted, strict=True))),)
    given = [
        word for word, value in zip(PLACE_WORDS, wanted, strict=True) if value is not None and value is not UNWEIGHTED
    ]
    if given:
        raise InputError(f"{given[0]}= needs the name of a frame; with Target objects, pass it to Target(...)")
    return as_targets(targets)


def options_of(method: Method, given: tuple[Any, ...], parameters: dict[str, Any]) -> Options:
    """The options of a call, checked.

    Args:
        method: The method.
        given: The values of the options, in the order of `OPTION_NAMES`.
        parameters: The solver's parameters.

    Raises:
        UnknownNameError, InputError: As for `solve`.
    """
    return Options.of(method, parameters, **dict(zip(OPTION_NAMES, given, strict=True)))
