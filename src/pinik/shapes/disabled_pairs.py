"""The pairs of links whose collisions an SRDF disables, read and written."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..description.edits import quoted
from ..description.xml import MAX_BYTES, DocumentError, parse
from ..errors import RobotLoadError
from ..files import FileError, read_within

__all__ = ["LinkPair", "link_pair", "read_disabled_pairs", "written_disabled_pairs"]

LinkPair = tuple[str, str]
"""The names of two links, in the order of their names."""


def link_pair(a: str, b: str) -> LinkPair:
    """Two links in the order of their names."""
    return (a, b) if a <= b else (b, a)


def read_disabled_pairs(srdf: Path, links: Iterable[str]) -> dict[LinkPair, str]:
    """The disabled pairs of an SRDF file, each with the reason that it gives, which may be empty.

    Pairs with links that the robot does not have are skipped, as robots with fewer links share the SRDF.

    Raises:
        RobotLoadError: The file cannot be read, or is not XML.
    """
    try:
        robot = parse(read_within(srdf, MAX_BYTES, "an SRDF file"))
    except FileError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault}", source=str(srdf)) from None
    except DocumentError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault.message}", source=str(srdf)) from None
    known = set(links)
    pairs = {}
    for element in robot.named("disable_collisions"):
        first, second = (element.attributes.get(name, "") for name in ("link1", "link2"))
        if {first, second} <= known and first != second:
            pairs[link_pair(first, second)] = element.attributes.get("reason", "")
    return pairs


def written_disabled_pairs(name: str, pairs: Mapping[LinkPair, str]) -> str:
    """An SRDF that disables these pairs, each for its reason."""
    lines = [
        f"  <disable_collisions link1={quoted(first)} link2={quoted(second)} reason={quoted(reason)}/>"
        for (first, second), reason in pairs.items()
    ]
    return "\n".join(['<?xml version="1.0"?>', f"<robot name={quoted(name)}>", *lines, "</robot>", ""])
