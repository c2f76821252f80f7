"""What `pinik solve --help` says about the methods and their parameters, made from the solvers themselves."""

from __future__ import annotations

import dataclasses
import textwrap

from ...solvers.base import Solver
from ...solvers.parameter import Parameter, parameters_of
from ...solvers.registry import known_methods

__all__ = ["solvers_help"]


def solvers_help() -> str:
    """Every registered method with its parameters, their units, ranges and defaults, as rich markup."""
    lines = {name: _lines(solver) for name, solver in known_methods().items()}
    first = next(iter(lines.values()))
    shared = [line for line in first if all(line in others for others in lines.values())]
    blocks = ["Methods, and their parameters for --param:"]
    for name, own in lines.items():
        blocks.append("\n".join([f"{name}:", *(line for line in own if line not in shared)]))
    blocks.append("\n".join(["every method:", *shared]))
    return "\n\n".join(blocks).replace("[", r"\[")


def _lines(solver: type[Solver]) -> list[str]:
    """A line for each parameter; of a field that was made without `parameter`, only the name and the default."""
    described = {own.name: own for own in parameters_of(solver)}
    texts = []
    for field in dataclasses.fields(solver):
        own = described.get(field.name, Parameter(field.default, "", name=field.name))
        facts = "; ".join(filter(None, [own.range_in_words, f"default {own.default_in_words}"]))
        name = f"{own.name} [{own.symbol}]" if own.symbol else own.name
        texts.append(f"{name}: {own.help} ({facts})" if own.help else f"{name} ({facts})")
    return [textwrap.fill(text, 78, initial_indent="  ", subsequent_indent="      ") for text in texts]
