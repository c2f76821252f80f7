"""What `pinik solve --help` says about each method's parameters, made from the solvers themselves."""

from __future__ import annotations

import dataclasses
import textwrap
from typing import Any

from ...solvers.registry import known_methods

__all__ = ["method_names", "solvers_help"]


def method_names() -> str:
    """Every method's short name, as an option's metavar."""
    return "|".join(known_methods())


def solvers_help() -> str:
    """Every method's parameters with unit, range and default, as rich markup."""
    lines = {name: [_line(field) for field in dataclasses.fields(solver)] for name, solver in known_methods().items()}
    shared = [line for line in lines["dls"] if all(line in others for others in lines.values())]
    blocks = ["Parameters for --param, by method:"]
    for name, own in lines.items():
        blocks.append("\n".join([f"{name}:", *(line for line in own if line not in shared)]))
    blocks.append("\n".join(["every method:", *shared]))
    return "\n\n".join(blocks).replace("[", r"\[")


def _line(field: dataclasses.Field[Any]) -> str:
    about = field.metadata
    facts = [_range(field), f"default {_default(field)}"]
    text = f"{field.name}: {about['help']} ({'; '.join(filter(None, facts))})"
    return textwrap.fill(text, 78, initial_indent="  ", subsequent_indent="      ")


def _range(field: dataclasses.Field[Any]) -> str:
    about = field.metadata
    if about["choices"]:
        return " | ".join(about["choices"])
    if isinstance(field.default, bool):
        return "true | false"
    unit = f" {about['unit']}" if about["unit"] else ""
    low, high = about["low"], about["high"]
    if low is None and high is None:
        return unit.strip()
    if high is None:
        return f"from {low:g}{unit}"
    return f"{'up' if low is None else f'{low:g}'} to {high:g}{unit}"


def _default(field: dataclasses.Field[Any]) -> str:
    if field.default is dataclasses.MISSING:
        return "{}"
    if isinstance(field.default, float):
        return f"{field.default:.4g}"
    return "null" if field.default is None else str(field.default).lower()
