"""What pinik repaired, assumed or ignored in a robot description, and the edits that mend it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..echoes import bounded
from .advice import ADVICE, Advice

__all__ = ["Edit", "Flaw", "summarised"]

_MOST_NAMED = 6


@dataclass(frozen=True, slots=True)
class Edit:
    """A replacement of bytes in a document.

    Attributes:
        start: The offset of the first byte that is replaced.
        end: The offset after the last one; equal to `start` for an insertion.
        text: What stands there instead.
    """

    start: int
    end: int
    text: str


class Flaw(str):
    """What pinik repaired, assumed or ignored in a robot description: a sentence that also knows its parts.

    Attributes:
        element: The element, such as "joint 'elbow'".
        cause: What is wrong and what was assumed, without the element.
        line: The line of the file, from 1; None if the flaw belongs to no line.
        code: The sort of flaw in a word for programs, such as "unknown-attribute".
        common: For pinik itself: the cause without names and numbers, equal for all flaws that are reported together.
        why: Why it matters, in one sentence.
        mend: What to do about it, in one sentence.
        edits: For pinik itself: the edits of the document that mend it; empty if there is no mend, or more than one.
        mesh: The address of a mesh that was not found; None for all other flaws.
        expanded: Whether the line is one of the URDF that xacro made of the file.
    """

    element: str
    cause: str
    line: int | None
    code: str
    common: str
    why: str
    mend: str
    edits: tuple[Edit, ...]
    mesh: str | None
    expanded: bool

    def __new__(
        cls,
        element: str,
        cause: str,
        *,
        code: str,
        line: int | None = None,
        common: str | None = None,
        why: str = "",
        mend: str = "",
        edits: Sequence[Edit] = (),
        mesh: str | None = None,
        expanded: bool = False,
    ) -> Flaw:
        """The sentence "element: cause (line 12)"; without words of its own, `why` and `mend` are those of its code."""
        advice = ADVICE.get(code, Advice("", ""))
        element, cause, common = bounded(element), bounded(cause), bounded(cause if common is None else common)
        self = super().__new__(cls, f"{element}: {cause}{_at(line, expanded)}")
        self.element, self.cause, self.line, self.code = element, cause, line, code
        self.common, self.expanded = common, expanded
        self.why, self.mend, self.edits, self.mesh = why or advice.why, mend or advice.mend, tuple(edits), mesh
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        given = {name: value for name, value in vars(self).items() if name not in ("element", "cause")}
        return partial(type(self), **given), (self.element, self.cause)

    def of_expansion(self) -> Flaw:
        """For pinik itself: the same flaw, whose line is one of the URDF that xacro made of the file."""
        given = {name: value for name, value in vars(self).items() if name not in ("element", "cause", "expanded")}
        return type(self)(self.element, self.cause, **given, expanded=True)


def _at(line: int | None, expanded: bool) -> str:
    return f" (line {line}{' of the expanded file' if expanded else ''})" if line else ""


def summarised(warnings: Iterable[str]) -> list[str]:
    """The warnings without repetitions, with one line for all flaws that have the same cause."""
    lines: list[str] = []
    sorts: dict[str, list[Flaw]] = {}
    for words in dict.fromkeys(warnings):
        if not isinstance(words, Flaw):
            lines.append(words)
            continue
        if words.common not in sorts:
            lines.append(words.common)
        sorts.setdefault(words.common, []).append(words)
    return [_together(line, sorts[line]) if line in sorts else line for line in lines]


def _together(common: str, flaws: Sequence[Flaw]) -> str:
    """One line for flaws of one sort: where they are, how many, what is wrong, and the first one in full."""
    if len(flaws) == 1:
        return flaws[0]
    places = list(dict.fromkeys(f.element + _at(f.line, f.expanded) for f in flaws))
    more = f" and {len(places) - _MOST_NAMED} more" if len(places) > _MOST_NAMED else ""
    count = f", {len(flaws)} times" if more or len(flaws) > len(places) else ""
    first = "" if flaws[0].cause == common else f" (the first: {flaws[0].cause})"
    return f"{', '.join(places[:_MOST_NAMED])}{more}{count}: {common}{first}"
