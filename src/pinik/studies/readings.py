"""The ways to read the thesis's parameters, and the presets of `pinik compare`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from .steps import LAP

__all__ = ["PRESETS", "SEGMENTS", "THESIS", "Reading"]

ALPHA = 0.01
MAX_ANGLE = math.pi / 16
SEGMENTS = 7


@dataclass(frozen=True)
class Reading:
    """One way to read the parameters.

    Attributes:
        about: A description in one line.
        alpha: The factor on the steps of the pseudo-inverse and DLS.
        transpose_alpha: The factor on Jᵀe in the transpose method [1/units²].
        max_angle: The clamp on a DLS step, before α [rad].
        units: The length of the chain in the thesis's units; None if a unit is a metre.
        lap: Steps per lap of the curve.
        rest: Steps that a random ball stays at one place.
        program: Whether the thesis's own pseudo-code moves the bones, as ball joints.
        unit_axes: Whether the program's axes have length one.
    """

    about: str
    alpha: float = ALPHA
    transpose_alpha: float = ALPHA
    max_angle: float = MAX_ANGLE
    units: float | None = SEGMENTS
    lap: int = LAP
    rest: int = 1
    program: bool = False
    unit_axes: bool = True


_IN_DEGREES = ALPHA * 180.0 / math.pi
_AT_60_HZ = ALPHA * 60.0

THESIS: Mapping[str, Reading] = {
    "literal": Reading("the parameters as stated, on hinges; α scales every iteration after the clamp"),
    "bones": Reading(
        "the same with the thesis's pseudo-code: each bone is a ball joint with one unit axis", program=True
    ),
    "printed-axes": Reading(
        "like bones, with the axes as printed: cross products of any length", program=True, unit_axes=False
    ),
    "degrees": Reading(
        "α applies to angles in degrees that are then taken for radians: 0.573", _IN_DEGREES, _IN_DEGREES
    ),
    "sixty-hertz": Reading("α counts per frame at 60 frames per second: 0.6", _AT_60_HZ, _AT_60_HZ),
    "whole-steps": Reading("α applies to the transpose only; the pseudo-inverse and DLS take full steps", 1.0),
    "late-clamp": Reading("the clamp applies after α instead of before it", max_angle=MAX_ANGLE / ALPHA),
    "metres": Reading("one unit of the thesis is one metre on pinik's arm", units=None),
    "fast-ball": Reading("the ball completes its curve in one second instead of eight", lap=60),
    "resting": Reading("a random ball stays at each place for ten frames, and each frame counts", rest=10),
}

_TUNED = {
    "defaults": "pinik's defaults, with restarts and a tolerance of 0.1 mm",
    "no-restarts": "pinik's defaults without restarts",
    "thesis-tolerance": "pinik's defaults with the thesis's tolerance",
}

PRESETS: Mapping[str, Mapping[str, str]] = {
    "thesis": {name: reading.about for name, reading in THESIS.items()},
    "tuned": _TUNED,
}
"""Preset → reading → description; the first reading of each preset is its default."""
