"""The `explanation` message: what a method does in its next iteration."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..simulation.explanation import Explanation
from ..simulation.turns import Turn

__all__ = ["explanation_message"]


def explanation_message(index: int, generation: int, explained: Explanation | str) -> dict[str, Any]:
    """Return the message; docs/live-protocol.md describes its fields. Numbers have five significant digits.

    Args:
        index: The number of the instance.
        generation: The number of the robot.
        explained: The explanation, or the reason why there is none.
    """
    message: dict[str, Any] = {"type": "explanation", "instance": index, "generation": generation}
    if isinstance(explained, str):
        return {**message, "reason": explained}
    spectrum = explained.spectrum
    return {
        **message,
        "reason": None,
        "method": explained.method,
        "columns": list(explained.columns),
        "rows": list(explained.rows),
        "J": _short(explained.J),
        "e": _short(explained.e),
        "held": list(explained.held),
        "sigma": _short(spectrum.sigma),
        "parts": _short(spectrum.parts),
        "gains": _short(spectrum.gains),
        "value": None if spectrum.value is None else _short(spectrum.value),
        "gradient": _short(spectrum.gradient),
        "freedom": _short(spectrum.freedom),
        "nullity": spectrum.nullity,
        "asked": _short(explained.asked),
        "step": _short(explained.step),
        "largest": explained.largest if math.isfinite(explained.largest) else None,
        "residual": _short(explained.residual),
        "predicted": _short(explained.predicted),
        "after": _short(explained.after),
        "reached": explained.reached,
        "turns": [_turn(turn) for turn in explained.turns],
    }


def _turn(turn: Turn) -> dict[str, Any]:
    return {
        "joint": turn.joint,
        "slides": turn.slides,
        "change": _short(turn.change),
        "limited": turn.limited,
        "target": turn.target,
        "axis": _short(turn.axis),
        "origin": _short(turn.origin),
        "amount": _short(turn.amount),
        "before": _short(turn.before),
        "after": _short(turn.after),
        "chain": _short(turn.chain),
        "moved": turn.moved,
    }


def _short(numbers: ArrayLike) -> Any:
    """Numbers with five significant digits; those that are not finite, which JSON does not have, as null."""
    array = np.asarray(numbers, dtype=float)
    if array.ndim:
        return [_short(part) for part in array]
    return float(f"{array:.5g}") if np.isfinite(array) else None
