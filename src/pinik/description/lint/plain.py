"""Values of a URDF that are plain numbers, with the names of the elements around them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...echoes import QUOTED, shortened
from ..part import Vector
from ..xml import Element

__all__ = ["JointValues", "joint_values", "named", "plain_numbers", "plain_vector"]


@dataclass(frozen=True, slots=True)
class JointValues:
    """The numbers of a `<joint>`; None for each that is missing or no plain number.

    Attributes:
        element: The element.
        owner: Its name in messages, "joint 'elbow'".
        kind: Its type as written.
        origin: Its `<origin>`.
        xyz: The origin's xyz [m].
        limit: Its `<limit>`.
        lower, upper: The limits [rad or m]; 0 where the limit does not give them.
    """

    element: Element
    owner: str
    kind: str
    origin: Element | None
    xyz: Vector | None
    limit: Element | None
    lower: float | None
    upper: float | None

    @property
    def line(self) -> int:
        """The line of the limit, or of the joint."""
        return self.limit.line if self.limit is not None else self.element.line


def joint_values(robot: Element) -> Iterator[JointValues]:
    """The numbers of all joints, in the file's order."""
    for joint in robot.named("joint"):
        origin, limit = _only(joint, "origin"), _only(joint, "limit")
        lower, upper = (_bound(limit, side) for side in ("lower", "upper"))
        kind = joint.attributes.get("type", "").strip()
        xyz = plain_vector(origin, "xyz") if origin is not None else None
        yield JointValues(joint, named(joint), kind, origin, xyz, limit, lower, upper)


def named(element: Element) -> str:
    """An element in messages: "joint 'elbow'"."""
    return f"{element.tag} {shortened(element.attributes.get('name', ''), QUOTED)!r}"


def plain_numbers(text: str) -> list[float] | None:
    """The finite numbers in a text; None if it holds anything else, about which the reader complains."""
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        return None
    return values if all(map(math.isfinite, values)) else None


def plain_vector(element: Element, attribute: str) -> Vector | None:
    """An attribute's three numbers; None if it has others."""
    values = plain_numbers(element.attributes.get(attribute, ""))
    if values is None or len(values) != 3:
        return None
    x, y, z = values
    return x, y, z


def _bound(limit: Element | None, side: str) -> float | None:
    values = None if limit is None else plain_numbers(limit.attributes.get(side, "0"))
    return values[0] if values is not None and len(values) == 1 else None


def _only(element: Element, tag: str) -> Element | None:
    found = element.named(tag)
    return found[0] if len(found) == 1 else None
