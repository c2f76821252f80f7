"""Read and check the smallest parts of a URDF: names, numbers, vectors and origins."""

from __future__ import annotations

import math
import re

from .xml import DocumentError, Element

__all__ = [
    "FARTHEST",
    "Vector",
    "attribute_text",
    "bad_value",
    "number",
    "numbers",
    "only_child",
    "read_origin",
    "required_name",
    "vector",
]

# [m]: beyond this, sums and squares of distances could overflow, and placements would not be finite.
FARTHEST = 1e12
LONGEST_NUMBER = 400
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
NON_FINITE = re.compile(r"[+-]?(nan|inf|infinity)", re.IGNORECASE)

Vector = tuple[float, float, float]


def required_name(element: Element) -> str:
    """The `name` of a link or joint.

    Raises:
        DocumentError: The name is missing or empty.
    """
    name = element.attributes.get("name")
    if name is None or not name.strip():
        what = "has no name" if name is None else "has an empty name"
        raise DocumentError(what, owner=f"<{element.tag}>", line=element.line)
    return name


def only_child(parent: Element, tag: str, owner: str) -> Element | None:
    """The child with this tag, or None.

    Raises:
        DocumentError: There are several children with this tag; URDF readers differ in which one they take.
    """
    found = parent.named(tag)
    if len(found) > 1:
        raise DocumentError(f"has {len(found)} <{tag}> elements", owner=owner, line=found[1].line)
    return found[0] if found else None


def attribute_text(element: Element, attribute: str, owner: str) -> str:
    """The text of a required attribute.

    Raises:
        DocumentError: The attribute is missing or empty.
    """
    text = element.attributes.get(attribute)
    if text is None or not text.strip():
        what = f"no {attribute}" if text is None else f"an empty {attribute}"
        raise DocumentError(f"<{element.tag}> has {what}", owner=owner, line=element.line)
    return text


def number(element: Element, attribute: str, owner: str) -> float | None:
    """One finite number, or None if the attribute is missing."""
    if attribute not in element.attributes:
        return None
    return numbers(element, attribute, 1, owner)[0]


def vector(element: Element, attribute: str, owner: str, default: Vector) -> Vector:
    """Three finite numbers, or `default` if the attribute is missing."""
    if attribute not in element.attributes:
        return default
    x, y, z = numbers(element, attribute, 3, owner)
    return x, y, z


def numbers(element: Element, attribute: str, count: int, owner: str) -> list[float]:
    """Exactly `count` finite numbers, in the notation that all URDF readers accept.

    Raises:
        DocumentError: A number is malformed or not finite, or there are more or fewer than `count`.
    """
    values = []
    for word in element.attributes[attribute].split():
        plain = len(word) <= LONGEST_NUMBER and NUMBER.fullmatch(word)
        if not plain and not NON_FINITE.fullmatch(word):
            raise bad_value(element, attribute, owner, f"{_shortened(word)!r} is not a number")
        value = float(word)
        if not math.isfinite(value):
            raise bad_value(element, attribute, owner, f"{word!r} is not finite")
        values.append(value)
    if len(values) != count:
        needed = "one number" if count == 1 else f"{count} numbers"
        raise bad_value(element, attribute, owner, f"must be {needed}; {len(values)} given")
    return values


def bad_value(element: Element, attribute: str, owner: str, cause: str) -> DocumentError:
    """An error that quotes an attribute and says what is wrong with it."""
    text = _shortened(element.attributes[attribute])
    return DocumentError(f'<{element.tag} {attribute}="{text}">: {cause}', owner=owner, line=element.line)


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def read_origin(parent: Element, owner: str) -> tuple[Vector, Vector]:
    """The `<origin>` of an element: xyz [m] and rpy [rad], zero if missing."""
    zero = (0.0, 0.0, 0.0)
    element = only_child(parent, "origin", owner)
    if element is None:
        return zero, zero
    if "quat_xyzw" in element.attributes:
        raise bad_value(element, "quat_xyzw", owner, "quaternions (URDF 1.1) are not supported; use rpy instead")
    xyz = vector(element, "xyz", owner, zero)
    if max(map(abs, xyz)) > FARTHEST:
        raise bad_value(element, "xyz", owner, f"must be at most {FARTHEST:g} m")
    return xyz, vector(element, "rpy", owner, zero)
