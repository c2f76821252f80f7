"""Every public name of pinik is on exactly one page of docs/api/, and it and its public members are documented."""

from __future__ import annotations

import contextlib
import io
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import griffe

SHOWN = re.compile(r"^::: pinik\.([\w.]+)$", re.MULTILINE)


def check_public_names(root: Path) -> None:
    """Raise if a name is missing, shown twice, or undocumented."""
    faults = list(faults_of_public_names(root))
    if faults:
        from mkdocs.exceptions import PluginError

        raise PluginError("public names: " + "; ".join(faults))


def faults_of_public_names(root: Path) -> Iterator[str]:
    package = griffe.load("pinik", search_paths=[root / "src"], docstring_parser="google")
    shown = Counter(
        name for page in (root / "docs" / "api").glob("*.md") for name in SHOWN.findall(page.read_text("utf-8"))
    )
    public = [str(name) for name in package.exports or ()]
    for name in public:
        if shown[name] != 1:
            yield f"{name} is on {shown[name]} pages of docs/api"
        yield from undocumented(package[name], name)
    for name in sorted(set(shown) - set(public)):
        if "." not in name:
            yield f"docs/api shows {name}, which is not public"
        else:
            yield from undocumented(package[name], name)


def undocumented(named: griffe.Object | griffe.Alias, name: str) -> Iterator[str]:
    """The names, from this one inwards, that have no docstring."""
    if not named.has_docstring and not named.is_attribute:
        yield f"{name} has no docstring"
    if named.is_function:
        yield from _strange_parameters(named, name)
    if not named.is_class:
        return
    for key, member in named.members.items():
        if key.startswith("_") or member.is_alias or not (member.is_function or "property" in member.labels):
            continue
        if not member.has_docstring:
            yield f"{name}.{key} has no docstring"
        elif member.is_function:
            yield from _strange_parameters(member, f"{name}.{key}")


def _strange_parameters(function: griffe.Object | griffe.Alias, name: str) -> Iterator[str]:
    """Parameters that a docstring has, alone or as `a, b`, and the function has not."""
    known = {parameter.name.lstrip("*") for parameter in function.parameters}
    with contextlib.redirect_stderr(io.StringIO()):
        sections = function.docstring.parse("google", warn_unknown_params=False, warn_missing_types=False)
    for section in sections:
        if section.kind is griffe.DocstringSectionKind.parameters:
            for described in section.value:
                for one in described.name.split(", "):
                    if one.lstrip("*") not in known:
                        yield f"{name} documents a parameter {one} that it does not have"
