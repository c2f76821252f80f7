"""A solver's parameters as the page's sliders and menus need them, made from the solver's own fields."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

from ...solvers.base import Solver

__all__ = ["changed_parameters", "describe_parameters", "plain"]


def describe_parameters(solver: Solver) -> list[dict[str, Any]]:
    """Each parameter with its value, default, range, unit and help; docs/live-protocol.md lists the fields."""
    return [_described(field, getattr(solver, field.name)) for field in dataclasses.fields(solver) if field.metadata]


def changed_parameters(solver: Solver) -> dict[str, Any]:
    """Name → value of what differs from the defaults, infinities as None."""
    return {p["name"]: p["value"] for p in describe_parameters(solver) if p["value"] != p["default"]}


def _described(field: dataclasses.Field[Any], value: Any) -> dict[str, Any]:
    about = field.metadata
    default = {} if field.default is dataclasses.MISSING else field.default
    low, high = about["slider"] or (about["low"], about["high"])
    has_slider = low is not None and high is not None
    return {
        "name": field.name,
        "kind": _kind(default, about),
        "value": plain(value),
        "default": plain(default),
        "low": about["low"],
        "high": about["high"],
        "slider": [low, high] if has_slider else None,
        "logarithmic": has_slider and low > 0.0 and high / low >= 100.0,
        "whole": isinstance(default, int) and not isinstance(default, bool),
        "unit": about["unit"],
        "help": about["help"],
        "choices": list(about["choices"]),
        "none": "automatic" if about["optional"] else "no limit" if about["unbounded"] else None,
    }


def _kind(default: Any, about: Mapping[str, Any]) -> str:
    if about["choices"]:
        return "choice"
    if isinstance(default, bool):
        return "truth"
    return "joints" if isinstance(default, dict) else "number"


def plain(value: Any) -> Any:
    """A parameter's value for JSON, where infinity is None."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return dict(value) if isinstance(value, Mapping) else value
