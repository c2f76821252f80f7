"""What tells solvers of one method apart, where several stand side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .base import Solver
from .parameter import Parameter, parameters_of

__all__ = ["called", "distinctions"]

_MOST = 2  # parameters that are named; captions have no room for more


def distinctions(solvers: Sequence[Solver]) -> list[str]:
    """For each solver the parameters that differ among those of its method, such as "λ = 0.05"; "" if none does."""
    return [_distinction(one, [other for other in solvers if type(other) is type(one)]) for one in solvers]


def called(name: str, distinction: str) -> str:
    """The name of a method, with what tells it from others of that name."""
    return f"{name}, {distinction}" if distinction else name


def _distinction(solver: Solver, alike: Sequence[Solver]) -> str:
    differing = [
        own
        for own in sorted(parameters_of(type(solver)), key=lambda own: own.level)
        if any(getattr(other, own.name) != getattr(solver, own.name) for other in alike)
    ]
    words = [_in_words(own, getattr(solver, own.name)) for own in differing[:_MOST]]
    return ", ".join(words + ["…"] * (len(differing) > _MOST))


def _in_words(own: Parameter, value: Any) -> str:
    name = own.name.replace("_", " ")
    match own.kind:
        case "choice":
            return f"{name} {value}"
        case "truth":
            return f"{name} {'on' if value else 'off'}"
        case "joints":
            return f"{'own' if value else 'no'} {name}"
    plain = own.plain(value)
    return f"{own.symbol or name} = {own.none_means if plain is None else f'{plain:g} {own.unit}'.rstrip()}"
