"""Names that are slips of the keyboard: which known name was meant, and how surely."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from difflib import SequenceMatcher

from ..echoes import QUOTED, shortened
from ..errors import near_names
from .vocabulary import URDF
from .xml import Element

__all__ = ["is_slip", "is_sure", "meant", "misspelt", "rivals"]

_RESEMBLES = 0.7  # of 1: how much two names have in common
_SURELY = 0.8  # so much that only a slip of the keyboard explains it
_LETTERS = 4  # so many letters are needed for one of them to be wrong


def meant(name: str, known: Collection[str], given: Collection[str] = ()) -> str | None:
    """The known name that this one resembles most, or None; one that is given beside it only if it is very near."""
    for near in near_names(shortened(name, QUOTED), known):
        if _likeness(name, near) >= (_SURELY if near in given else _RESEMBLES):
            return near
    return None


def misspelt(element: Element) -> set[str]:
    """The attributes of URDF that an element holds under names that are near to theirs."""
    known = URDF[element.tag].attributes
    others = [name for name in element.attributes if name not in known]
    return {near for name in others if (near := meant(name, known, element.attributes)) is not None}


def rivals(element: Element, given: Collection[str]) -> dict[str, list[str]]:
    """The names of children and attributes that several words in an element seem to mean, each with these words.

    Children that differ in their name alone are no rivals, as it does not matter which of them counts.

    Args:
        element: The element, which URDF knows.
        given: Those of its children that are given under their right name.
    """
    word = URDF[element.tag]
    children: dict[str, list[Element]] = {}
    words: dict[str, list[str]] = {}
    for child in element.children:
        if child.tag not in word.children and (near := meant(child.tag, word.children, given)) is not None:
            children.setdefault(near, []).append(child)
    for near, found in children.items():
        if not all(replace(child, tag=found[0].tag).says_the_same(found[0]) for child in found):
            words[near] = list(map(_shown, found))
    for attribute in (name for name in element.attributes if name not in word.attributes):
        near = meant(attribute, word.attributes, element.attributes)
        near = attribute.casefold() if near is None and attribute.casefold() in word.children else near
        if near is not None:
            others = list(map(_shown, children.get(near, [])))
            words.setdefault(near, others).append(f"{shortened(attribute, QUOTED)}=")
    return {near: found for near, found in words.items() if len(found) > 1}


def is_sure(name: str, known: Collection[str]) -> bool:
    """Whether one known name is so near that it must be the one, and no other is."""
    return sum(_likeness(name, one) >= _SURELY for one in known) == 1


def is_slip(name: str, known: str) -> bool:
    """Whether a name of one's own making, with numbers in it, is a slip for a known one: its digits are right."""
    digits, others = ([sign for sign in word if sign.isdigit()] for word in (name, known))
    return digits == others and abs(len(name) - len(known)) <= 1 and _likeness(name, known) >= _SURELY


def _shown(element: Element) -> str:
    return f"<{shortened(element.tag, QUOTED)}> (line {element.line})"


def _likeness(name: str, known: str) -> float:
    """From 0 to 1: how much two names have in common; case, the order of letters and one wrong letter hardly count."""
    word, other = name[:QUOTED].casefold(), known.casefold()
    if sorted(word) == sorted(other):
        return 1.0
    if len(word) == len(other) >= _LETTERS and sum(one != two for one, two in zip(word, other, strict=True)) == 1:
        return _SURELY
    return SequenceMatcher(None, word, other).ratio()
