"""Where tags and attributes stand in the bytes of a document, and the edits that change them and nothing else."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from .flaw import Edit
from .xml import Element

__all__ = [
    "Attribute",
    "StartTag",
    "edited",
    "escaped",
    "moved_to_child",
    "new_attribute",
    "new_value",
    "overlap",
    "quoted",
    "removed",
    "renamed_attribute",
    "renamed_element",
    "start_tag",
    "whole_element",
]

_NAME = rb"""[^\s=/>"'<]+"""
_TAG = re.compile(rb"<(" + _NAME + rb")")
_ATTRIBUTE = re.compile(rb"(\s+)(" + _NAME + rb""")\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_CLOSE = re.compile(rb"\s*(/?)>")
# One piece of markup between a start tag and its end tag; text between them is skipped.
_MARKUP = re.compile(
    rb"<(?:!--.*?-->|!\[CDATA\[.*?\]\]>|\?.*?\?>"
    rb"|/(?P<end>" + _NAME + rb""")\s*>|(?P<start>"""
    rb"" + _NAME + rb""")(?:"[^"]*"|'[^']*'|[^"'>])*+>)""",
    re.DOTALL,
)
# The ampersand comes first, because the others contain ampersands.
_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}


@dataclass(frozen=True, slots=True)
class Attribute:
    """Where an attribute stands; all numbers are offsets in the bytes of the document.

    Attributes:
        start: The beginning of the white space before it.
        name: The beginning and the end of its name.
        value: The beginning and the end of its value, between the quotes.
        end: The end, after the second quote.
    """

    start: int
    name: tuple[int, int]
    value: tuple[int, int]
    end: int


@dataclass(frozen=True, slots=True)
class StartTag:
    """Where a start tag stands; all numbers are offsets in the bytes of the document.

    Attributes:
        name: The beginning and the end of the element's name.
        attributes: Each attribute by its name.
        close: The beginning of its ">" or "/>".
        end: The end, after the ">".
        is_empty: Whether it ends in "/>", so that it is the whole element.
    """

    name: tuple[int, int]
    attributes: Mapping[str, Attribute]
    close: int
    end: int
    is_empty: bool


def start_tag(document: bytes, element: Element) -> StartTag:
    """Find the parts of an element's start tag.

    Args:
        document: The bytes that were parsed, in UTF-8 or another encoding that contains ASCII.
        element: An element of this document.

    Raises:
        ValueError: No start tag begins where the element says; the document is another one.
    """
    tag = _TAG.match(document, element.start)
    if tag is None:
        raise ValueError(f"no element begins at byte {element.start}")
    attributes = {}
    place = tag.end()
    while found := _ATTRIBUTE.match(document, place):
        value = found.span(3) if found[3] is not None else found.span(4)
        name = found[2].decode("utf-8", "replace")
        attributes[name] = Attribute(found.start(), found.span(2), value, found.end())
        place = found.end()
    close = _CLOSE.match(document, place)
    if close is None:
        raise ValueError(f"the start tag at byte {element.start} has no end")
    is_empty = bool(close[1])
    return StartTag(tag.span(1), attributes, close.end() - 1 - is_empty, close.end(), is_empty)


def whole_element(document: bytes, element: Element) -> tuple[int, int, int]:
    """The beginning of an element, the beginning of its end tag, and its end, as offsets in the document.

    The end tag of an element without content "begins" at the end.
    """
    tag = start_tag(document, element)
    if tag.is_empty:
        return element.start, tag.end, tag.end
    depth = 1
    for markup in _MARKUP.finditer(document, tag.end):
        if markup["end"] is not None:
            depth -= 1
            if depth == 0:
                return element.start, markup.start(), markup.end()
        elif markup["start"] is not None and not markup[0].endswith(b"/>"):
            depth += 1
    raise ValueError(f"the element at byte {element.start} has no end tag")


def renamed_element(document: bytes, element: Element, name: str) -> tuple[Edit, ...]:
    """The edits that give an element another name, in its start tag and its end tag."""
    first = Edit(*start_tag(document, element).name, name)
    _, end_tag, end = whole_element(document, element)
    if end_tag == end:
        return (first,)
    begins = end_tag + len(b"</")
    return first, Edit(begins, begins + first.end - first.start, name)


def renamed_attribute(document: bytes, element: Element, attribute: str, name: str) -> tuple[Edit, ...]:
    """The edit that gives an attribute another name."""
    return (Edit(*start_tag(document, element).attributes[attribute].name, name),)


def new_value(document: bytes, element: Element, attribute: str, value: str) -> tuple[Edit, ...]:
    """The edit that gives an attribute another value; none if the document, which may be empty, does not hold it."""
    try:
        place = start_tag(document, element).attributes.get(attribute)
    except ValueError:
        return ()
    return () if place is None else (Edit(*place.value, escaped(value)),)


def new_attribute(document: bytes, element: Element, attribute: str, value: str) -> tuple[Edit, ...]:
    """The edit that adds an attribute to an element; none if the document, which may be empty, does not hold it."""
    try:
        _, end = start_tag(document, element).name
    except ValueError:
        return ()
    return (Edit(end, end, f' {attribute}="{escaped(value)}"'),)


def removed(document: bytes, element: Element) -> tuple[Edit, ...]:
    """The edit that takes an element out; none if the document, which may be empty, does not hold it."""
    try:
        start, _, end = whole_element(document, element)
    except ValueError:
        return ()
    return (Edit(start, end, ""),)


def moved_to_child(document: bytes, element: Element, attribute: str, child: str, name: str) -> tuple[Edit, ...]:
    """The edits that take an attribute out of an element and write it into a new child, as its attribute `name`."""
    tag = start_tag(document, element)
    place = tag.attributes[attribute]
    value = document[slice(*place.value)].decode("utf-8", "replace").replace('"', "&quot;")
    text = f'<{child} {name}="{value}"/>'
    away = Edit(place.start, place.end, "")
    if not tag.is_empty:
        return away, Edit(tag.end, tag.end, text)
    own_name = document[slice(*tag.name)].decode("utf-8", "replace")
    return away, Edit(tag.close, tag.end, f">{text}</{own_name}>")


def overlap(one: Iterable[Edit], others: Iterable[Edit]) -> bool:
    """Whether edits touch the same bytes. Two insertions at one place do not: they come one after the other."""
    taken = list(others)
    return any(edit.start < other.end and other.start < edit.end for edit in one for other in taken)


def edited(document: bytes, edits: Sequence[Edit]) -> bytes:
    """The document with all edits; all other bytes stay as they are.

    Args:
        document: The bytes, in UTF-8.
        edits: Edits that do not overlap, in any order.

    Raises:
        ValueError: Two edits overlap.
    """
    parts, place = [], 0
    for edit in sorted(edits, key=lambda one: (one.start, one.end)):
        if edit.start < place:
            raise ValueError(f"two edits overlap at byte {edit.start}")
        parts += [document[place : edit.start], edit.text.encode("utf-8")]
        place = edit.end
    return b"".join([*parts, document[place:]])


def escaped(text: str) -> str:
    """A text as it stands in the value of an attribute, between double quotes."""
    for character, entity in _ENTITIES.items():
        text = text.replace(character, entity)
    return text


def quoted(text: str) -> str:
    """A text as the value of an attribute, with its quotes."""
    return f'"{escaped(text)}"'
