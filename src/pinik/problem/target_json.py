"""The JSON form of a target: its keywords, with plain numbers and lists."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError

__all__ = ["TARGET_KEYWORDS", "check_fields", "known"]

TARGET_KEYWORDS = (
    "rotation", "rpy", "quat_xyzw", "quat_wxyz", "placement", "axis", "direction", "at", "tool", "relative_to",
    "weight",
)  # fmt: skip
"""What `Target` takes besides frame, position and tolerance."""


def check_fields(fields: Mapping[str, Any]) -> None:
    """Check that these are `Target`'s own keywords, and `frame` among them.

    Raises:
        InputError: Not an object, or no frame.
        UnknownNameError: A key that is not one of the keywords.
    """
    if not isinstance(fields, Mapping):
        raise InputError(f'a target must be an object such as {{"frame": …, "position": [x, y, z]}}; got {fields!r}')
    keywords = ("frame", "position", *TARGET_KEYWORDS, "tolerance")
    for key in fields:
        if key not in keywords:
            raise UnknownNameError("target keyword", key, keywords)
    if "frame" not in fields:
        raise InputError(f"a target must name its frame; got only {', '.join(fields) or 'nothing'}")


def known(numbers: NDArray[np.float64]) -> list[float | None]:
    """The numbers one by one, with None for NaN and 0 for −0, so that they can be compared."""
    return [x + 0.0 if x == x else None for x in numbers.ravel().tolist()]
