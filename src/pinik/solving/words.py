"""The keywords that fronts take: those of a target, the options, and the method's own parameters, told apart."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from ..errors import InputError, UnknownNameError
from ..problem.targets import TARGET_KEYWORDS, Target, as_targets
from ..solvers.base import Solver, field_names
from ..solvers.registry import Method, meant_by
from .options import OPTION_NAMES

__all__ = ["PLACE_WORDS", "UNWEIGHTED", "Wanted", "asked_targets", "check_words"]

Wanted = tuple[Any, ...]
"""The values of a target's keywords, in the order of `PLACE_WORDS`."""

PLACE_WORDS = ("position", *TARGET_KEYWORDS)
"""The keywords of a target besides its frame."""

UNWEIGHTED = 1.0
"""The weight of a target that is given none; this very object tells that none was given."""


def check_words(method: Method, words: Collection[str], options: Sequence[str] = OPTION_NAMES) -> None:
    """Check that all words left over are parameters of the method.

    Args:
        method: The method.
        words: What was given besides targets and options.
        options: The options of this front.

    Raises:
        UnknownNameError: One is not; the error lists what it resembles among all words that the front takes.
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
        known = dict.fromkeys([*PLACE_WORDS, "q0", "method", *options, *own])
        hint = f"the method is {solver.name!r}" if own else ""
        raise UnknownNameError("keyword", unknown, known, hint)


def asked_targets(
    targets: str | Target | Iterable[Target], wanted: Wanted, method: Method, parameters: Mapping[str, Any]
) -> tuple[Target, ...]:
    """The targets that are meant: one made from a frame's name and the target's keywords, or those given.

    Raises:
        UnknownNameError: A keyword that nobody knows.
        InputError: The target is faulty; or there are Target objects and keywords of a target besides.
    """
    check_words(method, parameters)
    if isinstance(targets, str):
        return (Target(targets, **dict(zip(PLACE_WORDS, wanted, strict=True))),)
    given = [
        word for word, value in zip(PLACE_WORDS, wanted, strict=True) if value is not None and value is not UNWEIGHTED
    ]
    if given:
        raise InputError(f"{given[0]}= goes with the name of a frame; with Target objects it belongs in Target(...)")
    return as_targets(targets)
