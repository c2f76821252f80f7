"""The process that runs xacro: it reads a request, asks where packages are, and answers with the URDF or the fault.

Before it reads an included file it says which, as that file may have no end.
It is a program of its own and imports nothing of pinik. Requests and answers are lines of JSON on stdin and stdout.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import sys
from collections.abc import Iterator
from functools import partial
from types import TracebackType
from typing import Any, TextIO
from xml.dom import expatbuilder, minidom
from xml.parsers.expat import ExpatError

_MOST_REMARKS = 20
_CLASS = re.compile(r"<class '[^']*'>: ")
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")


class _Arguments(dict[str, str]):
    """The arguments of a xacro file, which remember the names that the file asked for."""

    def __init__(self, given: dict[str, str]) -> None:
        super().__init__(given)
        self.known: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.known.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.known.add(name)
        return super().__getitem__(name)


class _LineBuilder(expatbuilder.ExpatBuilderNS):
    """Builds a document whose elements know their file and line."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self._file = file

    def start_element_handler(self, name: str, attributes: Any) -> None:
        super().start_element_handler(name, attributes)
        element: Any = self.curNode
        element.place = (self._file, self.getParser().CurrentLineNumber)


class _NoPackageError(Exception):
    """No package of a name was found; the message says so in words."""


class _Packages:
    """Packages, as the process that started this one finds them."""

    def __init__(self, stdin: TextIO, stdout: TextIO) -> None:
        self._stdin, self._stdout = stdin, stdout

    def __call__(self, name: str) -> str:
        _say(self._stdout, {"find": name})
        answer = json.loads(self._stdin.readline())
        if "why" in answer:
            raise _NoPackageError(f"{answer['why']}; name its folder in package_dirs (--package-dir)")
        return str(answer["place"])


def main() -> None:
    """Answer one request."""
    stdin, stdout = sys.stdin, sys.stdout
    remarks = io.StringIO()
    sys.stdin, sys.stdout, sys.stderr = io.StringIO(), remarks, remarks
    request = json.loads(stdin.readline())
    sys.path[:] = request["search"]
    _bound(request["memory"])
    try:
        answer = _expanded(request, _Packages(stdin, stdout), stdout)
        lines = dict.fromkeys(line.strip() for line in _COLOUR.sub("", remarks.getvalue()).splitlines())
        answer["remarks"] = [line for line in lines if line][:_MOST_REMARKS]
    except MemoryError:
        return
    if len(answer.get("document", "")) > request["bytes"]:
        answer = {"fault": f"the URDF is larger than {request['bytes'] // 1024**2} MB"}
    _say(stdout, answer)


def _say(stream: TextIO, message: dict[str, Any]) -> None:
    stream.write(json.dumps(message) + "\n")
    stream.flush()


def _bound(memory: int) -> None:
    """Bound the memory of this process, where the system can."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _expanded(request: dict[str, Any], packages: _Packages, stdout: TextIO) -> dict[str, Any]:
    import xacro
    import xacrodoc

    path = request["path"]
    xacrodoc.packages.get_path = packages
    xacro.parse = partial(_parse, stdout=stdout)
    xacro.print_location = lambda: None
    _keep_places_of_copies()
    _support_dirname()
    xacro.init_stacks(path)
    arguments = _Arguments(request["arguments"])
    try:
        with open(path, "rb") as file:
            text = file.read()
        made = xacrodoc.XacroDoc.from_string(
            _parse(text, path, stdout=stdout), subargs=arguments, resolve_packages=False
        )
        document = made.dom.documentElement.toprettyxml(indent="  ")
    except Exception as error:
        return _fault(error, xacro.filestack)
    return {"document": document, "known": sorted(arguments.known)}


def _parse(source: Any, filename: str | None = None, *, stdout: TextIO) -> Any:
    """Stands in for `xacro.parse`: a document whose elements know where they are."""
    import xacro

    if isinstance(source, minidom.Document):
        return source
    if source is None:
        path = os.path.join(xacro.root_dir, str(filename))
        _say(stdout, {"include": path})
        try:
            with open(path, "rb") as file:
                source = file.read()
        except OSError as error:
            xacro.filestack.pop()
            raise xacro.XacroException(f"{error.strerror}: {filename}", exc=error) from None
    return _LineBuilder(str(filename)).parseString(source)


def _keep_places_of_copies() -> None:
    original = minidom._clone_node  # type: ignore[attr-defined]

    def clone(node: Any, deep: bool, owner: Any) -> Any:
        copy = original(node, deep, owner)
        if hasattr(node, "place"):
            copy.place = node.place
        return copy

    minidom._clone_node = clone  # type: ignore[attr-defined]


def _support_dirname() -> None:
    """Tell xacro the file of `$(dirname)`: the one that is being read, where its relative includes begin too."""
    import xacro

    original = xacro.eval_extension

    def evaluated(text: str) -> Any:
        xacro.substitution_args_context["filename"] = xacro.filestack[-1]
        return original(text)

    xacro.eval_extension = evaluated


def _fault(error: Exception, files: list[str | None] | None) -> dict[str, Any]:
    """An error in words, with the file and line of the element that was being expanded."""
    file, line = _place(error.__traceback__)
    words = " ".join(str(error).split()) or "xacro gives no reason"
    cause: BaseException = error
    while isinstance(getattr(cause, "exc", None), BaseException):  # as xacro wraps errors
        cause = cause.exc  # type: ignore[attr-defined]
    match cause:
        case MemoryError():
            raise cause
        case ExpatError():
            file, line = (files or [None])[-1], cause.lineno
            words = f"not XML: {str(cause).partition(': line')[0]}"
        case RecursionError():
            words = "files include each other, or macros call each other, without end"
        case _NoPackageError():
            words = str(cause)
        case OSError():
            words = f"{cause.filename} cannot be read: {cause.strerror}"
        case _ if type(cause).__name__ == "ArgException":
            words = f"the argument {str(cause)!r} has no value; give one in xacro_args (--xacro-arg {cause}:=VALUE)"
        case KeyError():
            words = words.replace(str(cause), f"there is no key {cause}", 1)
        case _ if _CLASS.match(words):  # xacro writes the class of an error, its words, and its words again
            words = str(cause)
        case RuntimeError() if cause is error:  # xacro's own, about an attribute that is missing
            pass
        case _ if cause is error and type(error).__name__ != "XacroException":
            words = f"it cannot be expanded: {words}"
    return {"fault": words[:1000], "file": file, "line": line}


def _place(trace: TracebackType | None) -> tuple[str | None, int | None]:
    """The file and line of the innermost element whose expansion failed."""
    places = [place for place in _places(trace) if place is not None]
    return places[-1] if places else (None, None)


def _places(trace: TracebackType | None) -> Iterator[tuple[str, int] | None]:
    while trace is not None:
        names = trace.tb_frame.f_locals
        if trace.tb_frame.f_code.co_name in ("eval_all", "handle_macro_call"):
            yield getattr(names.get("node"), "place", None)
        trace = trace.tb_next


if __name__ == "__main__":
    main()
