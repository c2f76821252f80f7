"""Arrays on their way through JSON: a shape, and the float64 values in base64."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np


def pack(array: Any) -> dict[str, Any]:
    """An array as JSON takes it, without loss."""
    values = np.ascontiguousarray(array, dtype=np.float64)
    return {"shape": values.shape, "base64": base64.b64encode(values.tobytes()).decode("ascii")}


def unpack(packed: dict[str, Any]) -> np.ndarray:
    """The array that was packed, and writable."""
    return np.frombuffer(base64.b64decode(packed["base64"])).reshape(packed["shape"]).copy()
