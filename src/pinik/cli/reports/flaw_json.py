"""A flaw as JSON fields, and the bounds of what reports list."""

from __future__ import annotations

from typing import Any

from ...description.flaw import Flaw
from ...description.lint.front import NOTES

__all__ = ["MOST_LISTED", "flaw_fields", "shortened"]

MOST_LISTED = 1000
"""The largest number of entries in each list, and of flaws of each sort."""
_LONGEST = 1000


def flaw_fields(flaw: Flaw) -> dict[str, Any]:
    """A flaw as JSON."""
    return {
        "code": flaw.code,
        "severity": "note" if flaw.code in NOTES else "warning",
        "element": shortened(flaw.element),
        "line": flaw.line,
        "cause": shortened(flaw.cause),
        "why": flaw.why,
        "mend": shortened(flaw.mend),
        "fixable": bool(flaw.edits),
    }


def shortened(text: str, most: int = _LONGEST) -> str:
    """A text without its middle where it is longer than `most` characters, as names can be of any length."""
    half = most // 2 - 1
    return text if len(text) <= most else f"{text[:half]} … {text[-half:]}"
