"""What `pinik solve --help` says about each method's parameters, made from the solvers themselves."""

from __future__ import annotations

import textwrap

from ...solvers.parameter import Parameter, parameters_of
from ...solvers.registry import known_methods

__all__ = ["method_names", "solvers_help"]


def method_names() -> str:
    """Every method's short name, as an option's metavar."""
    return "|".join(known_methods())


def solvers_help() -> str:
    """Every method's parameters with unit, range and default, as rich markup."""
    lines = {name: [_line(own) for own in parameters_of(solver)] for name, solver in known_methods().items()}
    shared = [line for line in lines["dls"] if all(line in others for others in lines.values())]
    blocks = ["Parameters for --param, by method:"]
    for name, own in lines.items():
        blocks.append("\n".join([f"{name}:", *(line for line in own if line not in shared)]))
    blocks.append("\n".join(["every method:", *shared]))
    return "\n\n".join(blocks).replace("[", r"\[")


def _line(own: Parameter) -> str:
    facts = [own.range_in_words, f"default {own.default_in_words}"]
    text = f"{own.name}: {own.help} ({'; '.join(filter(None, facts))})"
    return textwrap.fill(text, 78, initial_indent="  ", subsequent_indent="      ")
