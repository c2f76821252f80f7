"""How methods look in reports: the colour of each, and the word for its iterations."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable

from ...solvers.base import SweepingSolver
from ...solvers.registry import known_methods

__all__ = ["iteration_word", "method_colors"]

_COLORS = {"ccd": "#1f6fc4", "jt": "#d97a00", "pinv": "#0c9a72", "dls": "#b9559a"}
"""The colours of the live page's four instances."""
_LIGHTNESS, _SATURATION = 0.42, 0.7


def method_colors(methods: Iterable[str]) -> dict[str, str]:
    """Short name → colour, in the order given.

    pinik's own four keep their colours. Every other method gets the hue in the middle of the widest gap between the
    hues in use.
    """
    hues = sorted(map(_hue, _COLORS.values()))
    colors = {}
    for method in methods:
        if method in _COLORS:
            colors[method] = _COLORS[method]
            continue
        gaps = [(after - hue, hue) for hue, after in zip(hues, [*hues[1:], hues[0] + 1.0], strict=True)]
        width, start = max(gaps)
        hue = (start + width / 2) % 1.0
        hues = sorted([*hues, hue])
        red, green, blue = (round(255 * part) for part in colorsys.hls_to_rgb(hue, _LIGHTNESS, _SATURATION))
        colors[method] = f"#{red:02x}{green:02x}{blue:02x}"
    return colors


def iteration_word(method: str) -> str:
    """What a method's iterations are called: "sweeps" if it changes joint after joint, else "steps"."""
    return "sweeps" if issubclass(known_methods()[method], SweepingSolver) else "steps"


def _hue(color: str) -> float:
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return colorsys.rgb_to_hls(red, green, blue)[0]
