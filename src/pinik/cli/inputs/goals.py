"""The targets of `pinik solve`: one from options, or several from a JSON file."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...errors import InputError, PinikError
from ...problem.targets import Target
from ...robot import Robot
from ..terminal.exits import CommandError

__all__ = ["as_options", "check_frames", "target_from_options", "targets_from_file"]

_MOST_BYTES = 16 * 1024 * 1024
_MOST_TARGETS = 100
_ORIENTATIONS = ("rpy", "quat_xyzw", "axis")
_FORM = 'a list of targets such as [{"frame": …, "position": [x, y, z]}], or {"targets": [...]}'


def target_from_options(frame: str | None, wanted: Mapping[str, Any]) -> Target:
    """The one target that the options describe.

    Args:
        frame: The frame that should move.
        wanted: `Target`'s other keywords; None where an option was not given.

    Raises:
        CommandError: No frame.
        InputError: What `Target` refuses.
    """
    if frame is None:
        raise CommandError("what should move where? give --frame F --position X Y Z, or --targets FILE.json")
    given = {name for name, value in wanted.items() if value is not None}
    orientations = [f"--{name.replace('_', '-')}" for name in _ORIENTATIONS if name in given]
    aims = [name for name in ("direction", "at") if name in given]
    if len(aims) == 2:
        raise CommandError("give --direction or --at, not both")
    if ("axis" in given) != bool(aims):
        raise CommandError("--axis goes with --direction or --at, and these with --axis")
    if len(orientations) > 1:
        raise CommandError(f"give the orientation once; got {' and '.join(orientations)}")
    if not orientations and "position" not in given:
        raise CommandError(
            "nothing is asked for; give --position, --rpy, --quat-xyzw, or --axis with --direction or --at"
        )
    try:
        return Target(frame, **wanted)
    except InputError as error:
        raise CommandError(as_options(str(error).removeprefix(f"target {frame!r}: "), wanted)) from None


def as_options(sentence: str, names: Iterable[str]) -> str:
    """A sentence that begins with the name of a keyword, begun with the option instead."""
    word = re.match(r"\w+", sentence)
    if word is None or word[0] not in names:
        return sentence
    return f"--{word[0].replace('_', '-')}{sentence[word.end() :]}"


def targets_from_file(path: str) -> list[Target]:
    """The targets of a JSON file; "-" is stdin.

    Raises:
        CommandError: Not readable, not JSON, or a target that `Target.from_dict` refuses; the message names
            file, index and key.
    """
    label = "stdin" if path == "-" else path
    try:
        if path == "-":
            data = sys.stdin.buffer.read(_MOST_BYTES + 1)
        else:
            with open(Path(path).expanduser(), "rb") as file:
                data = file.read(_MOST_BYTES + 1)
        if len(data) > _MOST_BYTES:
            raise CommandError(f"{label}: larger than {_MOST_BYTES // 1024**2} MB, too large for a list of targets")
        document = json.loads(data.decode("utf-8-sig"), object_pairs_hook=_without_duplicates)
    except OSError as error:
        raise CommandError(f"{label}: the file cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise CommandError(f"{label}: not JSON: {error}") from None
    items = _items(document, label)
    return [_target(item, f"{label}: target {index}") for index, item in enumerate(items)]


def check_frames(robot: Robot, targets: list[Target], path: str) -> None:
    """Look the frames of a file's targets up.

    Raises:
        CommandError: The robot has no such frame; the message names file, index and key.
    """
    label = "stdin" if path == "-" else path
    for index, target in enumerate(targets):
        for key, frame in (("frame", target.frame), ("relative_to", target.relative_to)):
            try:
                if frame is not None:
                    robot.frame_id(frame)
            except PinikError as error:
                raise CommandError(f"{label}: target {index}: {key}: {error}") from None


def _items(document: Any, label: str) -> list[Any]:
    if isinstance(document, Mapping):
        others = [key for key in document if key not in ("targets", "schema")]
        if others or "targets" not in document:
            found = ", ".join(map(repr, document)) or "nothing"
            raise CommandError(f"{label}: {_FORM} is expected; got an object with {found}")
        document = document["targets"]
    if not isinstance(document, list):
        raise CommandError(f"{label}: {_FORM} is expected; got {json.dumps(document)[:60]}")
    if len(document) > _MOST_TARGETS:
        raise CommandError(
            f"{label}: {len(document):,} targets; at most {_MOST_TARGETS} are taken, because they are solved together, "
            "by one configuration; to solve many one after the other, which is a batch, run one command for each"
        )
    if not document:
        raise CommandError(f"{label}: there are no targets")
    return document


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields: dict[str, Any] = {}
    for key, value in pairs:
        if key in fields:
            raise ValueError(f"the key {key!r} is there twice in one object")
        fields[key] = value
    return fields


def _target(item: Any, where: str) -> Target:
    try:
        return Target.from_dict(item)
    except PinikError as error:
        raise CommandError(f"{where}: {error}") from None
