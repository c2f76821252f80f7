"""What expressions in Python's source say: the texts that they can be, with … for what is known only later."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import product

__all__ = ["Words", "plain", "with_words"]

_LEAST_REMARK = 20  # a shorter text that may be missing is no more than …
_MOST_VARIANTS = 8


class Words:
    """What expressions in a function say.

    Args:
        module: The module.
        scope: The function, or the module itself.
        given: What is known about the function's parameters.
    """

    def __init__(self, module: ast.Module, scope: ast.AST, given: dict[str, list[ast.expr]] | None = None) -> None:
        self._module, self._values = module, dict(given or {})
        for node in [*module.body, *(ast.walk(scope) if scope is not module else ())]:
            if isinstance(node, ast.Assign):
                for name, value in _assigned(node.targets[0], node.value):
                    self._values.setdefault(name, []).append(value)
        self._functions = {one.name: one for one in ast.walk(module) if isinstance(one, ast.FunctionDef)}

    def of(self, node: ast.expr | None, depth: int = 3) -> list[str]:
        """All that an expression can be: a name what is assigned to it, a call what the module's function returns."""
        found: list[ast.expr | None] = []
        if isinstance(node, ast.Name):
            found = list(self._values.get(node.id, []))
        elif isinstance(node, ast.Call) and (helper := self.helper(node)) is not None:
            found = [one.value for one in ast.walk(helper) if isinstance(one, ast.Return)]
        elif isinstance(node, ast.IfExp):
            found = [node.body, node.orelse]
        elif isinstance(node, ast.BoolOp):
            found = list(node.values)
        elif isinstance(node, ast.Call):
            found = self._looked_up(node)
        if found and depth:
            return list(dict.fromkeys(words for one in found for words in self.of(one, depth - 1)))
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return self._joined([node.left, node.right], depth)
        if isinstance(node, ast.JoinedStr):
            return self._joined(node.values, depth)
        return [] if node is None else [plain(node)]

    def helper(self, call: ast.Call) -> ast.FunctionDef | None:
        """The module's own function, or method of the same class, that is called."""
        function = call.func
        if isinstance(function, ast.Attribute) and ast.unparse(function.value) == "self":
            return self._functions.get(function.attr)
        return self._functions.get(function.id) if isinstance(function, ast.Name) else None

    def inside(self, helper: ast.FunctionDef, call: ast.Call) -> Words:
        """The words in a function that is called with these arguments."""
        names = [one.arg for one in helper.args.args if one.arg != "self"]
        pairs = [*zip(names, call.args, strict=False), *((one.arg, one.value) for one in call.keywords if one.arg)]
        given = {name: [ast.Constant(text) for text in self.of(value)] for name, value in pairs}
        return Words(self._module, helper, given)

    def argument(self, call: ast.Call, name: str, place: int) -> ast.expr:
        """An argument that is given by its place or its name."""
        return next((one.value for one in call.keywords if one.arg == name), None) or call.args[place]

    def _looked_up(self, call: ast.Call) -> list[ast.expr | None]:
        """What `TABLE.get(key, default)` can be, of a table of the module."""
        table, _, method = ast.unparse(call.func).rpartition(".")
        tables = [one for one in self._values.get(table, []) if isinstance(one, ast.Dict) and method == "get"]
        return [*(value for table in tables for value in table.values), *call.args[1:]] if tables else []

    def _joined(self, parts: list[ast.expr], depth: int) -> list[str]:
        """Texts one after the other, with the words that parts of them stand for, if these are few."""
        variants = [self._known(part, depth) for part in parts]
        if _count(variants) > _MOST_VARIANTS:
            variants = [known if len(known) == 1 else ["…"] for known in variants]
        return [re.sub(r"…(\s*…)+", "…", "".join(one)) for one in product(*variants)]

    def _known(self, part: ast.expr, depth: int) -> list[str]:
        """What a part of a text can be: itself, what is known of a name, or … for a number or a short remark."""
        value = part.value if isinstance(part, ast.FormattedValue) else part
        formatted = isinstance(part, ast.FormattedValue) and (part.conversion != -1 or part.format_spec is not None)
        if formatted or isinstance(value, ast.BinOp):
            return ["…"]
        known = self.of(value, depth - 1) if depth else [plain(value)]
        remarks = [one for one in known if one != "…"]
        if "" in known and max(map(len, remarks)) < _LEAST_REMARK:
            return ["…"]
        return known or ["…"]


def _assigned(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    if isinstance(target, ast.Name):
        yield target.id, value
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for one, its in zip(target.elts, value.elts, strict=False):
            yield from _assigned(one, its)


def _count(variants: list[list[str]]) -> int:
    number = 1
    for one in variants:
        number *= len(one)
    return number


def with_words(module: ast.Module, words: Words, node: ast.AST | None = None) -> Iterator[tuple[ast.AST, Words]]:
    """All nodes of a module, each with the words of the innermost function around it."""
    for child in ast.iter_child_nodes(node or module):
        inner = Words(module, child) if isinstance(child, ast.FunctionDef) else words
        yield child, inner
        yield from with_words(module, inner, child)


def plain(node: ast.expr) -> str:
    """The text of a constant, and … for anything that is known only when it is said."""
    if isinstance(node, ast.Constant) and node.value is not None:
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return re.sub(r"…(\s*…)+", "…", "".join(map(plain, node.values)))
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return re.sub(r"…(\s*…)+", "…", plain(node.left) + plain(node.right))
    return "…"
