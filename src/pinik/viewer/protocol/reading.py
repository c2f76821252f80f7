"""Read JSON that others have written."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

__all__ = ["read_json"]

_DEEPEST = 8


def read_json(text: str) -> Any:
    """Read JSON that nests at most eight levels deep, which is more than any message needs.

    Raises:
        ValueError: The text is not JSON, nests too deeply, or contains NaN or an infinity by name.
    """

    def refuse(word: str) -> None:
        raise ValueError(f"{word} is not a JSON number")

    try:
        value = json.loads(text, parse_constant=refuse)
    except RecursionError:
        raise ValueError("it nests too deeply") from None
    level = [value]
    for _ in range(_DEEPEST):
        level = [inner for outer in level if isinstance(outer, (list, dict)) for inner in _parts(outer)]
    if level:
        raise ValueError("it nests too deeply")
    return value


def _parts(outer: list[Any] | dict[str, Any]) -> Iterable[Any]:
    return outer.values() if isinstance(outer, dict) else outer
