"""Classes as the API's pages show them: with the attributes of their bases, without what is for pinik itself."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator
from typing import Any

import griffe

from pinik.solvers.parameter import Parameter, parameters_of

MARK = "For pinik itself: "
_SECTION = re.compile(r"^Attributes\b[^\n]*:\n(?P<entries>(?:(?:    .*)?(?:\n|\Z))+)", re.MULTILINE)
_ENTRY = re.compile(r"^    (?P<names>\w[\w, ]*): (?P<words>.*(?:\n {5,}.*)*)$", re.MULTILINE)


class ForUsers(griffe.Extension):
    """Changes what griffe read of a package, before pages are made of it."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        classes = list(_classes(pkg))
        told = [(one, _attributes(one)) for one in classes]  # all of them, before any is changed
        for one, attributes in told:
            for own in _parameters(one):
                attributes[own.name] = _in_words(own)
                if own.name in one.members:
                    default = own.default
                    one.members[own.name].value = f"{default:.4g}" if isinstance(default, float) else repr(default)
            inner = {name for name, member in one.members.items() if not member.is_alias and _is_inner(member)}
            for names, words in attributes.items():
                if words.startswith(MARK):
                    inner |= set(names.split(", ")) & set(one.members)
            if attributes and one.docstring is not None:
                entries = [f"    {names}: {words}" for names, words in attributes.items() if not words.startswith(MARK)]
                one.docstring.value = "\n".join(
                    [_SECTION.sub("", one.docstring.value).rstrip(), "", "Attributes:", *entries]
                )
            for name in inner:
                del one.members[name]
        for function in _functions(pkg):
            for parameter in function.parameters:
                if isinstance(parameter.default, griffe.ExprName):
                    parameter.default = _constant(pkg, parameter.default) or parameter.default


def _classes(within: griffe.Module | griffe.Class) -> Iterator[griffe.Class]:
    for member in within.members.values():
        if not member.is_alias and (member.is_module or member.is_class):
            if member.is_class:
                yield member
            yield from _classes(member)


def _functions(within: griffe.Module | griffe.Class) -> Iterator[griffe.Function]:
    for member in within.members.values():
        if not member.is_alias:
            if member.is_function:
                yield member
            elif member.is_module or member.is_class:
                yield from _functions(member)


def _constant(package: griffe.Module, name: griffe.ExprName) -> str | None:
    """The number that a name of pinik stands for; None if it is none."""
    try:
        named = package[name.canonical_path.removeprefix("pinik.")]
        value = str((named.final_target if named.is_alias else named).value)
    except (KeyError, AttributeError, griffe.AliasResolutionError):
        return None
    return value if re.fullmatch(r"[\d._e+-]+", value) else None


def _is_inner(member: griffe.Object) -> bool:
    return member.docstring is not None and member.docstring.value.startswith(MARK)


def _attributes(cls: griffe.Class) -> dict[str, str]:
    """What the docstrings of a class and of its bases say about attributes, by their names; the bases come first."""
    found: dict[str, str] = {}
    if cls.docstring is not None:
        for one in [*reversed(cls.mro()), cls]:
            section = None if one.docstring is None else _SECTION.search(one.docstring.value)
            if section is not None:
                found |= {entry["names"]: entry["words"] for entry in _ENTRY.finditer(section["entries"])}
    return found


def _parameters(cls: griffe.Class) -> tuple[Parameter, ...]:
    """The parameters of a solver, in its signature and on the command line; none for any other class."""
    if not cls.path.startswith("pinik.solvers."):
        return ()
    found = getattr(importlib.import_module(cls.module.path), cls.name)
    return parameters_of(found) if hasattr(found, "parameters") else ()


def _in_words(parameter: Parameter) -> str:
    symbol = f" ({parameter.symbol})" if parameter.symbol else ""
    allowed = parameter.range_in_words
    return f"{parameter.help}{symbol}{f': {allowed}' if allowed else ''}."
