"""A plate with a name on it, which leans back like those on desks."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray

from ..extras import needed_by
from ..picture.solids import Solid

__all__ = ["CORNERS", "plate", "printed_name"]

CORNERS = ((0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0))
"""Where the corners of a plate are in its picture, from the left and the top."""

_LETTERS, _MARGIN = 64, 26  # [pixels]
_LEANING = np.deg2rad(60.0)  # from the ground


def printed_name(text: str, color: str) -> tuple[bytes, float]:
    """A name in white on a colour as a PNG file, and how many times wider than high it is."""
    with needed_by("the names of robots", "pictures"):
        from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(size=_LETTERS)
    left, _, right, _ = font.getbbox(text)
    size = (int(right - left) + 2 * _MARGIN, _LETTERS + 2 * _MARGIN)
    picture = Image.new("RGB", size, color)
    ImageDraw.Draw(picture).text((size[0] / 2, size[1] / 2), text, "white", font, anchor="mm")
    file = io.BytesIO()
    picture.save(file, "png", optimize=True)
    return file.getvalue(), size[0] / size[1]


def plate(width: float, height: float) -> Solid:
    """A plate [m] that faces x, with the middle of its lower edge at the origin."""
    back, up = height * np.cos(_LEANING), height * np.sin(_LEANING)
    half = width / 2
    corners = np.array([[0.0, -half, 0.0], [0.0, half, 0.0], [-back, half, up], [-back, -half, up]])
    normal: NDArray[np.float64] = np.array([np.sin(_LEANING), 0.0, np.cos(_LEANING)])
    return Solid(corners, np.tile(normal, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))
