"""What users are told of is on the API's pages: public names, what these take and return, and names in other pages."""

from __future__ import annotations

import ast
import contextlib
import io
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import griffe
from for_users import ForUsers

SHOWN = re.compile(r"^::: pinik\.([\w.]+)$", re.MULTILINE)
PYTHON = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def check_public_names(root: Path) -> None:
    """Raise if a name is missing, shown twice, or undocumented."""
    faults = list(faults_of_public_names(root))
    if faults:
        from mkdocs.exceptions import PluginError

        raise PluginError("public names: " + "; ".join(faults))


def faults_of_public_names(root: Path) -> Iterator[str]:
    package = griffe.load(
        "pinik",
        search_paths=[root / "src"],
        docstring_parser="google",
        extensions=griffe.load_extensions(ForUsers),
    )
    shown = Counter(
        name for page in (root / "docs" / "api").glob("*.md") for name in SHOWN.findall(page.read_text("utf-8"))
    )
    public = {str(name) for name in package.exports or ()}
    for name in sorted(public | set(shown)):
        if shown[name] != 1:
            yield f"{name} is on {shown[name]} pages of docs/api"
        elif name not in public and "." not in name:
            yield f"docs/api shows {name}, which is not public"
            continue
        named = _found(package, name)
        if named is None:
            yield f"{name} is shown or public, and there is no such name"
        else:
            yield from undocumented(named, name)
    yield from _unshown_classes(package, set(shown))
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        if page.exists():
            told = {name for code in PYTHON.findall(page.read_text("utf-8")) for name in names_in(code)}
            for name in sorted(told - set(shown)):
                if not any(name.startswith(f"{one}.") for one in shown):
                    yield f"{page.name} uses {name}, which no page of docs/api shows"


def names_in(code: str) -> Iterator[str]:
    """The names below pinik that code imports or uses, such as `batch.run` for `pinik.batch.run`."""
    inner = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "pinik":
            below = (node.module or "").partition(".")[2]
            yield from (f"{below}.{alias.name}".lstrip(".") for alias in node.names)
        elif isinstance(node, ast.Attribute) and node not in inner:
            parts = [node.attr]
            while isinstance(node.value, ast.Attribute):
                node = node.value
                inner.add(node)
                parts.insert(0, node.attr)
            if isinstance(node.value, ast.Name) and node.value.id == "pinik":
                yield ".".join(parts)


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


def _unshown_classes(package: griffe.Object, shown: set[str]) -> Iterator[str]:
    """The classes of pinik that what is shown takes or returns, and that no page shows."""
    things = {name: thing for name in shown if (thing := _found(package, name)) is not None}
    known = {thing.path for thing in things.values()}
    known |= {base.path for thing in things.values() if thing.is_class for base in thing.mro()}
    for name, thing in sorted(things.items()):
        for place, annotation in _annotations(thing, name):
            for path in _paths(annotation):
                found = _found(package, path)
                if found is not None and found.is_class and found.path not in known:
                    yield f"{place} has the type {found.name}, which no page of docs/api shows"


def _found(package: griffe.Object, name: str) -> griffe.Object | None:
    try:
        return _itself(package[name])
    except KeyError:
        return None


def _itself(named: griffe.Object | griffe.Alias) -> griffe.Object:
    return named.final_target if named.is_alias else named


def _annotations(thing: griffe.Object, name: str) -> Iterator[tuple[str, object]]:
    """The annotations of a function, an attribute, or the members of a class, with the names of their places."""
    if thing.is_function:
        yield from ((f"{name}({own.name})", own.annotation) for own in thing.parameters)
        yield name, thing.returns
    elif thing.is_attribute:
        yield name, thing.annotation
    elif thing.is_class:
        for key, member in thing.all_members.items():
            if not key.startswith("_") and _itself(member).path.startswith("pinik."):
                yield from _annotations(_itself(member), f"{name}.{key}")


def _paths(annotation: object) -> Iterator[str]:
    """The paths below pinik of the names in an annotation."""
    if isinstance(annotation, griffe.Expr):
        for part in annotation.iterate(flat=True):
            if isinstance(part, griffe.ExprName) and part.canonical_path.startswith("pinik."):
                yield part.canonical_path.removeprefix("pinik.")
