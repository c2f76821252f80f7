"""docs/check.md: the codes of flaws that it lists are those that the source gives to flaws."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from pinik.description.lint.front import NOTES
from pinik.shapes.mesh_checks import UNDRAWN

ROOT = Path(__file__).parents[2]
CODE = re.compile(r"[a-z]+(-[a-z]+)*")


def values_named_code(tree: ast.AST) -> Iterator[ast.expr]:
    """What is given as `code=…`, assigned to `code`, or returned by a function `code`."""
    for node in ast.walk(tree):
        if (isinstance(node, ast.keyword) and node.arg == "code") or (
            isinstance(node, ast.Assign)
            and any(
                isinstance(name, ast.Name) and name.id == "code" for target in node.targets for name in ast.walk(target)
            )
        ):
            yield node.value
        elif isinstance(node, ast.FunctionDef) and node.name == "code":
            yield from (one.value for one in ast.walk(node) if isinstance(one, ast.Return) and one.value is not None)


def used() -> set[str]:
    """The codes of flaws in the source; those of XML errors and of processes are no texts."""
    return set(UNDRAWN) | {
        part.value
        for file in sorted((ROOT / "src" / "pinik").rglob("*.py"))
        for value in values_named_code(ast.parse(file.read_text("utf-8")))
        for part in ast.walk(value)
        if isinstance(part, ast.Constant) and isinstance(part.value, str) and CODE.fullmatch(part.value)
    }


def documented() -> list[str]:
    section = (ROOT / "docs" / "check.md").read_text("utf-8").partition("## Codes")[2]
    return re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE)


def test_every_code_is_documented_and_every_documented_code_exists():
    codes = documented()
    assert sorted(codes) == sorted(set(codes))
    assert set(codes) == used()


def test_the_document_names_the_notes():
    section = (ROOT / "docs" / "check.md").read_text("utf-8").partition("## Codes")[2]
    assert set(re.findall(r"^\| `([^`]+)` \|.*\(a note\)", section, re.MULTILINE)) == NOTES
