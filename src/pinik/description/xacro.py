"""Expand xacro files into URDF, in a process of their own that may take only so much time and memory.

xacro evaluates expressions and includes any file of the machine, so it runs only on files that the caller names by
their path: never on text, and never for a page.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ..errors import InputError, RobotLoadError, UnknownNameError
from ..extras import needed_by
from ..files import megabytes
from .packages import Surroundings
from .xml import COMMENT, MAX_BYTES

if TYPE_CHECKING:
    import subprocess

__all__ = ["Expansion", "check_arguments", "expand", "is_xacro"]

SECONDS = 60.0
"""The longest time that an expansion may take."""
_MOST_MEMORY = 2 * 1024**3  # bytes
_PROGRAM = Path(__file__).with_name("xacro_process.py")
_TAG = re.compile(rb"<xacro:\w")


@dataclass(frozen=True)
class Expansion:
    """What xacro made of a file.

    Attributes:
        document: The URDF.
        remarks: What xacro warned about.
    """

    document: bytes = field(repr=False)
    remarks: tuple[str, ...]


def is_xacro(path: Path, document: bytes) -> bool:
    """Whether a file is xacro, by its name or by the tags or expressions in it: many files that end in ".urdf" are."""
    plain = COMMENT.sub(b"", document)
    return (
        path.suffix.lower() == ".xacro"
        or _TAG.search(plain) is not None
        or (b"xmlns:xacro" in plain and b"${" in plain)
    )


def check_arguments(arguments: Mapping[str, object] | None) -> dict[str, str]:
    """The arguments of a xacro file as text, as xacro takes them; True becomes "true".

    Raises:
        InputError: They are no mapping from names to text, numbers or booleans.
    """
    if arguments is None:
        return {}
    if not isinstance(arguments, Mapping):
        raise InputError(f"must be a dict of names and values; got {arguments!r}", argument="xacro_args")
    for name, value in arguments.items():
        if not isinstance(name, str) or not isinstance(value, (str, int, float, os.PathLike)):
            text = f"must be a dict from names to text, numbers or booleans; got {name!r}: {value!r}"
            raise InputError(text, argument="xacro_args")
    return {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in arguments.items()}


def expand(path: Path, arguments: Mapping[str, str], package_dirs: Sequence[Path]) -> Expansion:
    """Expand a xacro file.

    Args:
        path: The file.
        arguments: The values of its `<xacro:arg>` elements, by name.
        package_dirs: Folders that are searched first for the packages of `$(find …)`.

    Raises:
        RobotLoadError: xacro refuses the file, or it takes too much time or memory; the message names file and line.
        UnknownNameError: The file has no argument of a given name.
        MissingExtraError: xacrodoc is not installed.
    """
    with needed_by("a xacro file", "xacro"):
        if importlib.util.find_spec("xacrodoc") is None:
            raise ModuleNotFoundError(name="xacrodoc")
    request = {"path": str(path.absolute()), "arguments": dict(arguments), "search": sys.path, "memory": _MOST_MEMORY}
    answer = _asked(request | {"bytes": MAX_BYTES}, Surroundings(path.absolute(), package_dirs), str(path))
    if "fault" in answer:
        raise RobotLoadError(f"xacro: {_at(answer, path)}", source=str(path))
    for name in arguments:
        if name not in answer["known"]:
            raise UnknownNameError("xacro argument", name, answer["known"])
    return Expansion(answer["document"].encode("utf-8"), tuple(answer["remarks"]))


def _at(answer: Mapping[str, Any], path: Path) -> str:
    """The fault with its line, and with its file if that is another one than the file that was given."""
    file, line = answer.get("file"), answer.get("line")
    places = [] if file is None or file == str(path.absolute()) else [str(file)]
    places += [] if line is None else [f"line {line}"]
    return str(answer["fault"]) + (f" ({', '.join(places)})" if places else "")


def _asked(request: Mapping[str, Any], surroundings: Surroundings, label: str) -> dict[str, Any]:
    """The answer of the process that runs xacro."""
    import subprocess  # slow to import

    command = [sys.executable, "-I", str(_PROGRAM)]
    included: list[str] = []
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8"
    ) as process:
        late = threading.Event()

        def stop() -> None:
            late.set()
            process.kill()

        clock = threading.Timer(SECONDS, stop)
        clock.daemon = True
        clock.start()
        try:
            answer = _conversation(process, request, surroundings, included)
        finally:
            clock.cancel()
            process.kill()
    last = f"; the last file that it included is {included[-1]}" if included else ""
    if late.is_set():
        raise RobotLoadError(f"xacro: the file takes longer than {SECONDS:g} s to expand{last}", source=label)
    if answer is None:
        cause = f"the file takes more than {megabytes(_MOST_MEMORY)} of memory to expand, or xacro itself failed{last}"
        raise RobotLoadError(f"xacro: {cause}", source=label)
    return answer


def _conversation(
    process: subprocess.Popen[str], request: Mapping[str, Any], surroundings: Surroundings, included: list[str]
) -> dict[str, Any] | None:
    """Answer where packages are, until the process says what it made of the file; None if it ends without a word.

    The files that the process is about to include are added to `included`.
    """
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        _say(process.stdin, request)
        for line in process.stdout:
            answer: dict[str, Any] = json.loads(line)
            if "include" in answer:
                included.append(answer["include"])
                continue
            if "find" not in answer:
                return answer
            name = answer["find"]
            place = surroundings.package(name)
            reply = {"why": surroundings.why_no_package(name)} if place is None else {"place": str(place.absolute())}
            _say(process.stdin, reply)
    except (BrokenPipeError, json.JSONDecodeError):
        return None
    return None


def _say(stream: IO[str], message: Mapping[str, Any]) -> None:
    stream.write(json.dumps(message) + "\n")
    stream.flush()
