"""How complete a search for all answers is: an estimate of what is missing, and what is said of it."""

from __future__ import annotations

import math

from .findings import Findings
from .search import LEAST

__all__ = ["estimate_missing", "words_of"]

_THOROUGH = ("dls", "pinv")
"""The methods that lead to every answer if one starts near it; of "ccd" and "jt" many runs end before, or elsewhere."""

_ARRIVED = 0.5
"""The share of the starts that must lead to an answer; in the median of random poses, 0.9 do with "dls"."""


def estimate_missing(found: Findings, is_complete: bool, method: str) -> float:
    """An estimate of how many answers are missing; see `Branches.estimate_missing`."""
    if is_complete:
        return 0.0
    if found.redundancy or found.ended_early or found.starts < LEAST:
        return math.inf
    if method not in _THOROUGH or found.arrived < _ARRIVED * found.starts:
        return math.inf
    once, twice = int((found.hits == 1).sum()), int((found.hits == 2).sum())
    return once * (once - 1) / (2 * (twice + 1))


def words_of(found: Findings, is_complete: bool, method: str) -> str:
    """One sentence on what was found, and on what may be missing."""
    count = len(found.q)
    begin = f"{count} answer{'s' * (count != 1)}"
    if found.colliding:
        begin += f" and {found.colliding} that collide{'s' * (found.colliding == 1)}"
    if is_complete:
        return f"{begin}, all that there are"
    begin += f" from {found.starts} start{'s' * (found.starts != 1)}{', ended by the time limit' * found.ended_early}"
    if found.redundancy:
        isolated = int((found.dimension == 0).sum())
        begin += f": {isolated} isolated, and {count - isolated}" if isolated else ","
        return f"{begin} of infinitely many in {_dimensions(found)}"
    if found.ended_early or found.starts < LEAST:
        return f"{begin}, too few to tell how many are missing"
    if found.arrived < _ARRIVED * found.starts:
        return f"{begin}, of which only {found.arrived} arrived, too few to tell how many are missing"
    if method not in _THOROUGH:
        return f"{begin}; others may be missing, to which {method!r} does not lead"
    left = estimate_missing(found, is_complete, method)
    missing = "none seems to be" if left < 0.5 else f"about {left:.0f} may be"
    return f"{begin}, the last new one from number {int(found.found_at.max(initial=0)) + 1}; {missing} missing"


def _dimensions(found: Findings) -> str:
    """The dimensions of the answers that are not isolated, such as "1 or 2 dimensions"."""
    several = sorted({found.redundancy or 0, *found.dimension[found.dimension > 0].tolist()})
    return f"{' or '.join(map(str, several))} dimension{'s' * (several != [1])}"
