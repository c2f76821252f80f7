"""The messages of all errors and warnings of pinik, read from its source."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pinik
from pages.words import Words, plain, with_words

__all__ = ["BY_CHECK", "COMMAND_LINE", "messages"]

SOURCE = Path(pinik.__file__).parent
COMMAND_LINE = "The command line"
BY_CHECK = "pinik check"

INTERNAL = {  # the errors inside pinik, and what users meet instead
    "DocumentError": ("RobotLoadError",),
    "BrokenXMLError": ("RobotLoadError",),
    "UnusableAddressError": ("UrdfWarning",),
    "MeshError": ("UrdfWarning",),
    "FileError": ("RobotLoadError", "InputError", "UrdfWarning"),
    "CommandError": (COMMAND_LINE,),
    "_BeyondLimitsError": (BY_CHECK,),
}

LEFT_OUT = {  # the modules whose `DocumentError`s make a flaw of a part that is left out, and the end of its sentence
    "description/shape_tags.py": "the shape is left out",
    "description/materials.py": "its colour is left out",
    "description/links.py": "the link is taken as massless",
}
READ_BY_ALL = "description/part.py"
"""The module whose `DocumentError`s are of links, joints and shapes alike."""

CHECKED = ("description/lint/", "shapes/sizes.py", "cli/reports/inspection.py")
"""The modules whose flaws only `pinik check` tells."""

SAID = {  # what notes an error or warning → the class that users meet, and the place of the words among its arguments
    "faults.add": ("InputError", -1),
    "on_bad": ("InputError", -1),
    "_warn": ("InputWarning", 0),
    ".fault": ("DocumentError", 0),
    ".flaw": ("UrdfWarning", 0),
    ".misread": ("UrdfWarning", 1),
    "Flaw": ("UrdfWarning", 1),
    "_Fault": (BY_CHECK, 1),
    "Found.nothing": ("UrdfWarning", 0),
}
QUOTED = '<… …="…">: '
UNFOUND = "not found: {}; kinematics works without it"


def messages() -> dict[str, set[str]]:
    """Class → its messages, with … for what differs."""
    found: dict[str, set[str]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        module = path.relative_to(SOURCE).as_posix()
        for name, message in _said_in(ast.parse(path.read_text("utf-8"))):
            for met, words in _met(module, name, message):
                found.setdefault(met, set()).add(words)
    return found


def _met(module: str, name: str, message: str) -> Iterator[tuple[str, str]]:
    """As what users meet a message, and in which words."""
    if name == "UrdfWarning" and module.startswith(CHECKED):
        yield BY_CHECK, message
    elif name == "DocumentError" and module in LEFT_OUT:
        yield "UrdfWarning", f"{message}; {LEFT_OUT[module]}"
    elif name == "NumberError" or (name == "DocumentError" and module == READ_BY_ALL):
        whole = QUOTED + message if name == "NumberError" else message
        yield "RobotLoadError", whole
        yield "UrdfWarning", f"{whole}; …"
    else:
        yield from ((met, message) for met in INTERNAL.get(name, (name,)))


def _said_in(tree: ast.Module) -> Iterator[tuple[str, str]]:
    for node, words in with_words(tree, Words(tree, tree)):
        for name, message in _said_by(node, words):
            if _is_sentence(message):
                yield name, message


def _said_by(node: ast.AST, words: Words) -> Iterator[tuple[str, str]]:
    """The class and the words of each message that a statement or a call makes."""
    if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
        yield from _raised(node.exc, words)
    if not isinstance(node, ast.Call):
        return
    function = ast.unparse(node.func)
    if function == "warnings.warn":
        yield from ((ast.unparse(node.args[1]), message) for message in words.of(node.args[0]))
    elif function.endswith(".bad_value"):
        yield from (("DocumentError", QUOTED + message) for message in words.of(node.args[1]) if message != "…")
    elif (said := _kind_of_note(node, function)) is not None:
        name, place = said
        of_file = UNFOUND if function == "Found.nothing" else "{}"
        argument = words.argument(node, "cause", place)
        yield from ((name, of_file.format(message)) for message in words.of(argument) if _is_sentence(message))
    elif (helper := words.helper(node)) is not None:
        inside = words.inside(helper, node)
        for inner in ast.walk(helper):
            # A helper that adds words to those that it is given, such as `_note(flaws, cause)`.
            passed = isinstance(inner, ast.Call) and _kind_of_note(inner, ast.unparse(inner.func))
            if passed and isinstance(words.argument(inner, "cause", passed[1]), ast.Name):
                yield from _said_by(inner, inside)


def _kind_of_note(call: ast.Call, function: str) -> tuple[str, int] | None:
    """What a call that notes an error or warning is by `SAID`; None for other calls."""
    said = SAID.get(function) or SAID.get("." + function.rpartition(".")[2] if "." in function else "")
    enough = said is not None and (len(call.args) > said[1] or any(one.arg == "cause" for one in call.keywords))
    return said if enough else None


def _raised(call: ast.Call, words: Words) -> Iterator[tuple[str, str]]:
    name = ast.unparse(call.func).rpartition(".")[2]
    helper = words.helper(call)
    if helper is not None and helper.returns is not None:
        given = (one.id for one in call.args if isinstance(one, ast.Name) and one.id.endswith("Error"))
        name = next(given, ast.unparse(helper.returns))
        inside = words.inside(helper, call)
        for end in ast.walk(helper):
            if isinstance(end, ast.Return) and isinstance(end.value, ast.Call):
                yield from ((name, message) for message in _with_argument(end.value, inside))
    elif name == "UnknownNameError":
        yield name, f"no {plain(call.args[0])} '…'; did you mean '…'?"
    elif name.endswith("Error"):
        yield from ((name, message) for message in _with_argument(call, words))


def _with_argument(error: ast.Call, words: Words) -> Iterator[str]:
    """The messages of an error, behind the name of the argument at fault if it is given."""
    argument = next((one.value for one in error.keywords if one.arg == "argument"), None)
    for message in words.of(error.args[0]) if error.args else ():
        if _is_sentence(message):
            yield message if argument is None else f"{plain(argument)} {message}"


def _is_sentence(message: str) -> bool:
    """Whether there is a word in it, apart from remarks such as "(line …)"."""
    return re.search(r"\w", re.sub(r"\(.*?\)", "", message)) is not None
