"""What `pinik solve --help` says about the methods and their parameters, made from the solvers themselves."""

from __future__ import annotations

import dataclasses
import textwrap
from typing import Any

from ...solvers.registry import known_methods

__all__ = ["solvers_help"]


def solvers_help() -> str:
    """Every registered method with its parameters, their units, ranges and defaults, as rich markup."""
    lines = {name: [_line(field) for field in dataclasses.fields(solver)] for name, solver in known_methods().items()}
    first = next(iter(lines.values()))
    shared = [line for line in first if all(line in others for others in lines.values())]
    blocks = ["Methods, and their parameters for --param:"]
    for name, own in lines.items():
        blocks.append("\n".join([f"{name}:", *(line for line in own if line not in shared)]))
    blocks.append("\n".join(["every method:", *shared]))
    return "\n\n".join(blocks).replace("[", r"\[")


def _line(field: dataclasses.Field[Any]) -> str:
    facts = "; ".join(filter(None, [_range(field), _default(field)]))
    about = field.metadata.get("help", "")
    text = f"{field.name}: {about} ({facts})" if about else f"{field.name} ({facts})"
    return textwrap.fill(text, 78, initial_indent="  ", subsequent_indent="      ")


def _range(field: dataclasses.Field[Any]) -> str:
    about = field.metadata
    if isinstance(field.default, bool):
        return "true | false"
    if not about:  # a field of a user's solver that was made without `parameter`
        return ""
    if about["choices"]:
        return " | ".join(about["choices"])
    unit = f" {about['unit']}" if about["unit"] else ""
    low, high = about["low"], about["high"]
    if low is None and high is None:
        return unit.strip()
    if high is None:
        return f"at least {low:g}{unit}"
    return f"at most {high:g}{unit}" if low is None else f"{low:g} to {high:g}{unit}"


def _default(field: dataclasses.Field[Any]) -> str:
    if field.default is dataclasses.MISSING:
        return "required" if field.default_factory is dataclasses.MISSING else "default {}"
    if isinstance(field.default, float):
        return f"default {field.default:.4g}"
    return f"default {'null' if field.default is None else str(field.default).lower()}"
