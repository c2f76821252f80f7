"""The JSON form of a target: its keywords, with plain numbers and lists."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError

__all__ = ["TARGET_KEYWORDS", "check_fields", "known", "plain_fields"]

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


def plain_fields(values: Mapping[str, Any]) -> dict[str, Any]:
    """The keywords of a target, from the values of its fields: only what it asks for."""
    fields: dict[str, Any] = {"frame": values["frame"]}
    for name in ("position", "rotation", "axis", "direction", "at"):
        numbers = values[name]
        if numbers is not None:
            fields[name] = known(numbers) if numbers.ndim == 1 else numbers.tolist()
    if values["_tool"] is not None:
        fields["tool"] = values["_tool"].homogeneous.tolist()
    if values["relative_to"] is not None:
        fields["relative_to"] = values["relative_to"]
    if values["weight"] != 1.0:
        fields["weight"] = values["weight"]
    tolerance = values["tolerance"]
    if tolerance is not None:
        largest = tolerance.position if tolerance.box is None else list(tolerance.box)
        fields["tolerance"] = [largest, tolerance.orientation]
    return fields


def known(numbers: NDArray[np.float64]) -> list[float | None]:
    """The numbers one by one, with None for NaN and 0 for −0, so that they can be compared."""
    return [x + 0.0 if x == x else None for x in numbers.ravel().tolist()]
