"""Mend the flaws of a robot description that have one answer, in its own text, and check the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ...errors import RobotLoadError
from ..document import read_document
from ..edits import edited, overlap
from ..encodings import as_utf_8
from ..flaw import Edit, Flaw
from ..reader import Description, read_content
from ..source import Source
from ..xml import DocumentError
from .front import lint

__all__ = ["Left", "Mending", "mended"]

# One mend may uncover another, such as a misspelt attribute in a misspelt element.
_MOST_ROUNDS = 10
_MOST_ATTEMPTS = 20  # at a set of mends that spoils the file, to find out which one of them it is
_KINEMATIC = frozenset({"unknown-element", "unknown-attribute", "misplaced-attribute", "misplaced-element"})


@dataclass(frozen=True)
class Left:
    """A flaw that is left to the user.

    Attributes:
        flaw: The flaw.
        why: Why it is left, as a clause.
    """

    flaw: Flaw
    why: str


@dataclass(frozen=True)
class Mending:
    """A robot description whose flaws were mended as far as they have one answer.

    Attributes:
        document: The bytes of the mended description, in UTF-8; it can be loaded if `fault` is empty.
        done: The flaws that were mended.
        left: The other flaws.
        fault: Why the mended description cannot be loaded; empty if it can.
    """

    document: bytes
    done: tuple[Flaw, ...]
    left: tuple[Left, ...]
    fault: str = ""


def mended(document: bytes, path: Path | None = None) -> Mending:
    """Mend all flaws that have edits, and read the result again.

    The edits change nothing but what they mend, so that comments and the layout stay. Mends that do not concern joints
    must leave the checked joints and links exactly as they were, and no mend may make the file unreadable; those that
    would do so are left out.

    Args:
        document: The bytes of a robot description, in any encoding.
        path: The file that holds the document; a robot without a name is named after it.

    Raises:
        DocumentError: The encoding that the document declares is unknown, or its bytes are not in it.
    """
    workshop = _Workshop(document, path)
    for _ in range(_MOST_ROUNDS):
        # Mends that must not change joints come first, so that it can be seen whether they do.
        worked = [workshop.mend(kinematic=kinematic) for kinematic in (False, True)]
        if not any(worked):
            break
    return workshop.result()


class _Workshop:
    """A description that is being mended."""

    def __init__(self, document: bytes, path: Path | None) -> None:
        self._path = path
        self._done: list[Flaw] = []
        try:
            cleared = read_document(document)
        except DocumentError:  # `self._read` says why
            content = as_utf_8(document)
        else:
            content = as_utf_8(cleared.content)
            self._done.extend(cleared.flaws)
        self._take(content, *self._read(content))
        self._refused: dict[str, str] = {}

    def mend(self, *, kinematic: bool) -> bool:
        """Mend what can be mended at once, of one of the two kinds; return whether there was anything."""
        chosen = [flaw for flaw in self._choice() if _is_kinematic(flaw) is kinematic]
        pending, attempts = [chosen] if chosen else [], 0
        while pending:
            group = pending.pop(0)
            after = edited(self._content, [edit for flaw in group for edit in flaw.edits])
            description, fault = self._read(after)
            harm = _harm(self._description, description, fault, kinematic=kinematic)
            if not harm:
                self._take(after, description, fault)
                self._done.extend(group)
                break  # the offsets of the others have changed; they come in the next round
            attempts += 1
            if len(group) == 1 or attempts > _MOST_ATTEMPTS:
                self._refused.update({_key(flaw): harm for flaw in group})
            else:
                pending.extend(_parts(group))
        return bool(chosen)

    def result(self) -> Mending:
        """What came of it."""
        several = "it has more than one answer, or none in this file"
        left = [Left(flaw, self._refused.get(_key(flaw), several)) for flaw in self._flaws()]
        return Mending(self._content, tuple(self._done), tuple(left), self._fault)

    def _take(self, content: bytes, description: Description | None, fault: str) -> None:
        """Go on with a document, in the bytes to which the edits of its flaws belong."""
        self._description, self._fault = description, fault
        self._content = content if description is None else as_utf_8(description.document)

    def _read(self, content: bytes) -> tuple[Description | None, str]:
        try:
            return read_content(content, Source(content, "", self._path)), ""
        except RobotLoadError as error:
            return None, f"{error.element}: {error.cause}" if error.element else error.cause

    def _flaws(self) -> list[Flaw]:
        """The flaws that the reader and the lint find."""
        found = lint(self._content, self._description)
        said = set(map(str, found))
        read_too = () if self._description is None else self._description.warnings
        return [*(flaw for flaw in read_too if isinstance(flaw, Flaw) and str(flaw) not in said), *found]

    def _choice(self) -> list[Flaw]:
        """The flaws with edits that do not touch each other; the others wait for the next round."""
        chosen: list[Flaw] = []
        taken: list[Edit] = []
        last = 0
        for flaw in sorted((one for one in self._flaws() if one.edits), key=_first):
            if _key(flaw) not in self._refused and not (_first(flaw) < last and overlap(flaw.edits, taken)):
                chosen.append(flaw)
                taken.extend(flaw.edits)
                last = max(last, *(edit.end for edit in flaw.edits))
        return chosen


def _first(flaw: Flaw) -> int:
    return min(edit.start for edit in flaw.edits)


def _parts(flaws: Sequence[Flaw]) -> list[list[Flaw]]:
    """The flaws by their sorts, or in halves if they are all of one sort."""
    by_sort: dict[str, list[Flaw]] = {}
    for flaw in flaws:
        by_sort.setdefault(flaw.code, []).append(flaw)
    if len(by_sort) > 1:
        return list(by_sort.values())
    return [list(flaws[: len(flaws) // 2]), list(flaws[len(flaws) // 2 :])]


def _harm(before: Description | None, after: Description | None, fault: str, *, kinematic: bool) -> str:
    """What a mend breaks, as a clause; empty if nothing."""
    if before is None:
        return ""
    if after is None:
        return f"with this mend the file cannot be loaded: {fault}"
    same = before.joints == after.joints and before.links == after.links and before.root == after.root
    return "" if same or kinematic else "this mend would change the joints"


def _is_kinematic(flaw: Flaw) -> bool:
    """Whether the mend of a flaw is meant to change joints or links."""
    return flaw.code in _KINEMATIC and not flaw.element.startswith(("link", "material"))


def _key(flaw: Flaw) -> str:
    """What stays of a flaw when lines before it change."""
    return f"{flaw.code} {flaw.element} {flaw.cause}"
