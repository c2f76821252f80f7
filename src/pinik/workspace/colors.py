"""Colours for numbers in 0..1, the same in pictures and pages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["ANCHORS", "colors_of"]

Array = NDArray[np.float64]

ANCHORS = ("#3a2f77", "#2f6cb5", "#12a08b", "#a9cf3c", "#fde74c")
"""The colours of 0, ¼, ½, ¾ and 1, each lighter than the one before."""


def colors_of(values: Array) -> Array:
    """The colours (…, 3) of numbers (…), red, green and blue in 0..1; numbers outside count as 0 or 1."""
    table = np.array([[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name in ANCHORS]) / 255.0
    at = np.linspace(0.0, 1.0, len(table))
    return np.stack([np.interp(values, at, channel) for channel in table.T], axis=-1)
