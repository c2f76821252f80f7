"""The targets of `pinik solve`: one from options, or several from a JSON file."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import PinikError
from ..robot import Robot
from ..targets import Target
from .exits import CommandError

__all__ = ["check_frames", "target_from_options", "targets_from_file"]

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
    return Target(frame, **wanted)


def targets_from_file(path: str) -> list[Target]:
    """The targets of a JSON file; "-" is stdin.

    Raises:
        CommandError: Not readable, not JSON, or a target that `Target.from_dict` refuses; the message names
            file, index and key.
    """
    label = "stdin" if path == "-" else path
    try:
        data = sys.stdin.buffer.read() if path == "-" else Path(path).read_bytes()
        document = json.loads(data.decode("utf-8-sig"))
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
    if not document:
        raise CommandError(f"{label}: there are no targets")
    return document


def _target(item: Any, where: str) -> Target:
    try:
        return Target.from_dict(item)
    except PinikError as error:
        raise CommandError(f"{where}: {error}") from None
