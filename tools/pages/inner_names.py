"""What is public in Python but only for pinik itself: a docstring that begins so keeps a name out of the API's pages."""

from __future__ import annotations

import re
from typing import Any

import griffe

MARK = "For pinik itself: "
_IN_ATTRIBUTES = re.compile(rf"^    (?P<names>\w[\w, ]*): {MARK}.*\n(?:^     +.*(?:\n|\Z))*", re.MULTILINE)


def is_inner(member: griffe.Object | griffe.Alias) -> bool:
    """Whether the docstring of a member begins with the mark."""
    return member.docstring is not None and member.docstring.value.startswith(MARK)


def without_inner(docstring: str) -> tuple[str, set[str]]:
    """The docstring of a class without the attributes whose description begins with the mark, and their names."""
    names = {name for entry in _IN_ATTRIBUTES.finditer(docstring + "\n") for name in entry["names"].split(", ")}
    return _IN_ATTRIBUTES.sub("", docstring + "\n").rstrip("\n"), names


class WithoutInnerNames(griffe.Extension):
    """Takes the names with the mark from classes, before pages are made of them."""

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        inner = {name for name, member in cls.members.items() if not member.is_alias and is_inner(member)}
        if cls.docstring is not None:
            cls.docstring.value, others = without_inner(cls.docstring.value)
            inner |= others & set(cls.members)
        for name in inner:
            del cls.members[name]
