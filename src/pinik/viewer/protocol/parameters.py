"""A solver's parameters, and a ball's tolerance, in the form that the page and links need."""

from __future__ import annotations

from typing import Any

from ...solvers.base import Solver
from ...solvers.parameter import Parameter, parameters_of
from ..simulation.ball import Ball

__all__ = ["changed_parameters", "describe_parameters", "tolerance_of"]


def describe_parameters(solver: Solver) -> list[dict[str, Any]]:
    """Describe each parameter: value, default, range, unit and help. docs/live-protocol.md lists the fields."""
    return [_described(own, getattr(solver, own.name)) for own in parameters_of(type(solver))]


def changed_parameters(solver: Solver) -> dict[str, Any]:
    """Name → value of the parameters that differ from their defaults, in their JSON form."""
    return {p["name"]: p["value"] for p in describe_parameters(solver) if p["value"] != p["default"]}


def tolerance_of(ball: Ball) -> list[Any] | None:
    """A ball's own tolerance as [metres, radians], the metres a list of three for a box; None if it has none."""
    tolerance: list[Any] | None = ball.target.to_dict().get("tolerance")
    return tolerance


def _described(own: Parameter, value: Any) -> dict[str, Any]:
    low, high = own.slider or (own.low, own.high)
    slider = None if low is None or high is None else [low, high]
    return {
        "name": own.name,
        "kind": own.kind,
        "value": own.plain(value),
        "default": own.plain(own.default),
        "low": own.low,
        "high": own.high,
        "slider": slider,
        "logarithmic": slider is not None and slider[0] > 0.0 and slider[1] / slider[0] >= 100.0,
        "whole": own.is_whole,
        "unit": own.unit,
        "help": own.help,
        "symbol": own.symbol,
        "level": own.level,
        "choices": list(own.choices),
        "none": own.none_means,
    }
