"""Names that are slips of the keyboard: which known name was meant, and how surely."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import lru_cache

from ..echoes import QUOTED, shortened
from ..errors import near_names
from .vocabulary import URDF
from .xml import Element

__all__ = ["is_slip", "is_sure", "meant", "misspelt", "rivals"]

_RESEMBLES = 0.7  # of 1: how much two names have in common
_SURELY = 0.8  # so much that only a slip of the keyboard explains it
_LETTERS = 4  # so many letters are needed for one of them to be wrong
_REMEMBERED = 2**14  # comparisons; the reader and the lint ask for all unknown names of a document several times


def meant(name: str, known: Collection[str], given: Collection[str] = ()) -> str | None:
    """The known name that this one resembles most, or None; one that is given beside it only if it is very near."""
    ranked = _ranked(name[:QUOTED], frozenset(known))
    return next((near for near, likeness in ranked if near not in given or likeness >= _SURELY), None)


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
    return sum(likeness >= _SURELY for likeness in _resembling(name[:QUOTED], frozenset(known)).values()) == 1


def is_slip(name: str, known: str) -> bool:
    """Whether a name of one's own making, with numbers in it, is a slip for a known one: its digits are right."""
    digits, others = ([sign for sign in word if sign.isdigit()] for word in (name, known))
    return digits == others and abs(len(name) - len(known)) <= 1 and _likeness(name, known) >= _SURELY


def _shown(element: Element) -> str:
    return f"<{shortened(element.tag, QUOTED)}> (line {element.line})"


@lru_cache(maxsize=_REMEMBERED)
def _ranked(name: str, known: frozenset[str]) -> tuple[tuple[str, float], ...]:
    """The known names that a name resembles, the nearest first, each with its likeness."""
    likeness = _resembling(name, known)
    is_plain = not likeness or (len(likeness) == 1 and 1.0 not in likeness.values())
    names = likeness if is_plain else near_names(name, likeness)  # which knows letters in disorder
    return tuple((near, likeness[near]) for near in names)


@lru_cache(maxsize=_REMEMBERED)
def _resembling(name: str, known: frozenset[str]) -> Mapping[str, float]:
    """The known names that a name may be a slip for, each with its likeness."""
    word = name.casefold()
    letters = set(word)
    found = {}
    for one in sorted(known):
        # A letter that only one of the two has belongs to nothing that they have in common.
        common = min(len(word) - len(letters.difference(one.casefold())), len(one) - len(set(one.casefold()) - letters))
        if 2 * common >= _RESEMBLES * (len(word) + len(one)) and (likeness := _likeness(name, one)) >= _RESEMBLES:
            found[one] = likeness
    return found


def _likeness(name: str, known: str) -> float:
    """From 0 to 1: how much two names have in common; case, the order of letters and one wrong letter hardly count."""
    word, other = name[:QUOTED].casefold(), known.casefold()
    if sorted(word) == sorted(other):
        return 1.0
    if len(word) == len(other) >= _LETTERS and sum(one != two for one, two in zip(word, other, strict=True)) == 1:
        return _SURELY
    if abs(len(word) - len(other)) == 1 and _has_one_more(*sorted((word, other), key=len)):
        return 2.0 * min(len(word), len(other)) / (len(word) + len(other))
    from difflib import SequenceMatcher  # which few runs need

    return SequenceMatcher(None, word, other).ratio()


def _has_one_more(short: str, long: str) -> bool:
    """Whether a word is another one with one letter more, which needs no search for what they have in common."""
    place = next((index for index, (one, two) in enumerate(zip(short, long, strict=False)) if one != two), len(short))
    return short[place:] == long[place + 1 :]
