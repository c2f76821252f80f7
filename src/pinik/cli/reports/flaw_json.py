"""A flaw as JSON fields, and the bounds of what reports list."""

from __future__ import annotations

from typing import Any

from ...description.flaw import Flaw
from ...description.lint.front import NOTES
from ...echoes import shortened

__all__ = ["MOST_LISTED", "flaw_fields"]

MOST_LISTED = 1000
"""The largest number of entries in each list, and of flaws of each sort."""


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
