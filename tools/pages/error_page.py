"""docs/errors.md, from the code: every class of error and warning, what to do about it, and its messages."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pinik
from pinik.description.advice import ADVICE
from pinik.scale.jobs import cluster

SOURCE = Path(pinik.__file__).parent

WHAT_TO_DO = {
    "PinikError": "Catch it to catch all errors that pinik raises on purpose. Any other exception is a fault of pinik: "
    "please report it.",
    "InputError": "Read the requirement in the message, and change the argument that it begins with. `error.argument` "
    "has its name.",
    "UnknownNameError": "Take one of the names that the message suggests; `error.valid` has all of them.",
    "RobotLoadError": "The message names the element and its line. `pinik check FILE` shows all that is wrong at once, "
    "and `pinik check FILE --fix OUT.urdf` mends what has one answer.",
    "SolveError": "The target was missed; `error.solution` has the best configuration and says why. "
    "[Missed targets](howto/answers.md#why-was-my-target-missed) has the usual causes.",
    "EngineError": 'Leave out `engine="native"`, or install pinik where a C++ compiler is, as the message says.',
    "MissingExtraError": "Run the install line that the message ends with.",
    "ClusterError": "Start the scheduler or its workers, or install the same versions on all machines.",
    "InputWarning": "The answer is for the nearest rotation matrix: give more digits, or take a quaternion. "
    "Angles are taken as radians, as everywhere.",
    "UrdfWarning": "The robot works, and something in its file is not as it should be. `pinik check FILE` says more. "
    "With `pinik.load(..., strict=True)` it is an error.",
    "RuntimeWarning": "Install pinik again: its compiled engine belongs to another build, so solves run in Python.",
    "DeprecationWarning": "Use the new name, which the message gives. The old one works for one more minor version; "
    "see [Versions](versions.md).",
}

INTERNAL = {  # the errors inside pinik, and what users meet instead
    "DocumentError": "RobotLoadError",
    "BrokenXMLError": "RobotLoadError",
    "NumberError": "RobotLoadError",
    "UnusableAddressError": "UrdfWarning",
    "MeshError": "UrdfWarning",
    "FileError": "InputError",
    "CommandError": "The command line",
}

STATUSES = {
    "CONVERGED": "Nothing.",
    "STALLED": "The message says what can be reached alone, and which joints are at their limits. Try more `restarts`, "
    "a wider `tolerance`, or an axis instead of a full orientation.",
    "MAX_ITERATIONS": "Raise `max_iterations`, or take `dls`.",
    "TIME_LIMIT": "Raise `time_limit`; the best configuration so far is the answer.",
    "UNREACHABLE": "It is proved that no configuration reaches it. The message says by how much; `solution.q` is the "
    "nearest configuration found.",
    "COLLIDING": "The message names what touches. Change the target or the world, or give `solve` more `restarts`.",
}

TRACKER_STATUSES = {
    "OK": "Nothing.",
    "LIMITED": "Call again: the next ticks bring the frame nearer. Raise the speeds if it lags behind.",
    "HELD": "Move the target back, or go on from another branch.",
    "BLOCKED": "Move the target or the obstacle away.",
}

INTRODUCTION = """\
# Errors and warnings

Wrong arguments and files raise an error that says what was expected and what was given. A target that is missed is no
error: the solution says so, and why. Every error is a `pinik.PinikError` and also the builtin that it resembles, so
`except ValueError` catches an `InputError`.

To find a message that you have met, paste its words into the search field of this site. `…` stands for what differs: a
name, a number, or the rest of a sentence. This page is made from the code.

## How a solve ends

`solution.status` is one of these, and `solution.message` says more:

| status | meaning | what to do |
|---|---|---|
"""


def error_page() -> str:
    text = INTRODUCTION
    text += "".join(f"| `{one.name}` | {one.value} | {STATUSES[one.name]} |\n" for one in pinik.Status)
    text += "\nA `Tracker` says after each tick how it went:\n\n| status | meaning | what to do |\n|---|---|---|\n"
    text += "".join(f"| `{one.name}` | {one.value} | {TRACKER_STATUSES[one.name]} |\n" for one in pinik.TrackerStatus)
    found = messages()
    for name, advice in WHAT_TO_DO.items():
        text += f"\n## {name}\n\n{_meaning(name)}\n\n**What to do:** {advice}\n" + _table(found.get(name, set()))
        if name == "UrdfWarning":
            text += _flaws()
    text += "\n## The command line\n\nA command prints its error on stderr and ends with a [status](command-line.md"
    text += "#exit-statuses) other than 0. It has all messages above, and these:\n" + _table(found["The command line"])
    return text


def _meaning(name: str) -> str:
    named = getattr(pinik, name, getattr(cluster, name, None))
    if named is None:
        return f"Python's own `{name}`."
    builtins = [base.__name__ for base in named.__bases__ if base.__module__ == "builtins" and base is not Exception]
    meaning = re.sub(r"\n(?=\S)", " ", inspect.cleandoc(named.__doc__).split("\n\n")[0])
    return f"{meaning} It is also a `{builtins[0]}`." if builtins else meaning


def _table(found: set[str]) -> str:
    if not found:
        return ""
    in_order = sorted(found, key=lambda message: (message.casefold(), message))
    rows = "".join(f"    * {_escaped(message)}\n" for message in in_order)
    return f'\n??? info "{len(found)} message{"s" * (len(found) > 1)}"\n\n{rows}'


def _escaped(message: str) -> str:
    return "`` " + message.replace("\n", " ").replace("``", "` `") + " ``"


def _flaws() -> str:
    rows = "".join(f"| `{code}` | {advice.why} | {advice.mend} |\n" for code, advice in ADVICE.items())
    return (
        "\nA flaw of a robot description has a code, which `warning.code` and [`pinik check`](check.md#codes) show:\n\n"
        "| code | why it matters | what to do |\n|---|---|---|\n" + re.sub(r"(<[^>|`]+>)", r"`\1`", rows)
    )


def messages() -> dict[str, set[str]]:
    """Class → its messages, with … for what differs, read from the source."""
    found: dict[str, set[str]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        for name, message in _said_in(ast.parse(path.read_text("utf-8"))):
            name = INTERNAL.get(name, name)
            if name in WHAT_TO_DO or name in INTERNAL.values():
                found.setdefault(name, set()).add(message)
    return found


def _said_in(tree: ast.Module) -> Iterator[tuple[str, str]]:
    for node, words in _with_words(tree, Words(tree, tree)):
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            call = node.exc
            name = ast.unparse(call.func).rpartition(".")[2]
            if name == "UnknownNameError":
                yield name, f"no {_template(call.args[0])} '…'; did you mean '…'?"
                continue
            argument = next((one.value for one in call.keywords if one.arg == "argument"), None)
            for message in words.of(call.args[0]) if call.args else ():
                if _is_sentence(message):
                    yield name, message if argument is None else f"{_template(argument)} {message}"
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in NOTES:
            for message in words.of(node.args[-1]):
                if _is_sentence(message):
                    yield "InputError", message
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in WARNS:
            category = WARNS[ast.unparse(node.func)] or ast.unparse(node.args[1])
            for message in words.of(node.args[0]):
                if _is_sentence(message):
                    yield category, message


NOTES = {"faults.add", "on_bad"}
"""What notes the faults of rows, each with its words last; `batch` raises the first, or leaves the rows out."""

WARNS = {"warnings.warn": None, "_warn": "InputWarning"}
"""What warns → the class of its warnings, or None if the second argument names it."""


class Words:
    """What expressions in a function say."""

    def __init__(self, module: ast.Module, scope: ast.AST) -> None:
        self._module, self._values, self._returned = module, {}, {}
        for part in {module, scope}:
            for node in module.body if part is module else ast.walk(scope):
                if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                    self._values.setdefault(node.targets[0].id, []).append(node.value)
        for node in module.body:
            if isinstance(node, ast.FunctionDef):
                self._returned[node.name] = [one.value for one in ast.walk(node) if isinstance(one, ast.Return)]

    def of(self, node: ast.expr | None, depth: int = 3) -> list[str]:
        """All that an expression can be: a name what is assigned to it, a call what the module's function returns."""
        found: list[ast.expr | None] = []
        if isinstance(node, ast.Name):
            found = self._values.get(node.id, [])
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            found = self._returned.get(node.func.id, [])
        elif isinstance(node, ast.IfExp):
            found = [node.body, node.orelse]
        elif isinstance(node, ast.BoolOp):
            found = node.values
        if found and depth:
            return [words for one in found for words in self.of(one, depth - 1)]
        return [] if node is None else [_template(node)]


def _with_words(module: ast.Module, words: Words, node: ast.AST | None = None) -> Iterator[tuple[ast.AST, Words]]:
    """All nodes of a module, each with the words of the innermost function around it."""
    for child in ast.iter_child_nodes(node or module):
        inner = Words(module, child) if isinstance(child, ast.FunctionDef) else words
        yield child, inner
        yield from _with_words(module, inner, child)


def _is_sentence(message: str) -> bool:
    """Whether there is a word in it, apart from remarks such as "(line …)"."""
    return re.search(r"\w", re.sub(r"\(.*?\)", "", message)) is not None


def _template(node: ast.expr) -> str:
    """A message with … in place of what is known only when it is said."""
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return re.sub(r"…(\s*…)+", "…", "".join(_template(value) for value in node.values))
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return re.sub(r"…(\s*…)+", "…", _template(node.left) + _template(node.right))
    return "…"
