"""Targets from options, from a JSON file, or from the JSON form of one."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from ...checks import as_point, as_unit_vector, as_vector
from ...echoes import QUOTED, shortened
from ...errors import InputError, InputWarning, PinikError
from ...problem.target_values import as_position
from ...problem.targets import Target
from ...robot import Robot
from ..terminal import output
from ..terminal.exits import CommandError
from .files import label_of, read_bytes

__all__ = [
    "asked_targets",
    "check_frames",
    "named_by_option",
    "option_of",
    "read_position",
    "read_target",
    "target_from_options",
    "targets_from_file",
]

_MOST_BYTES = 16 * 1024 * 1024
_MOST_TARGETS = 100
_ORIENTATIONS = ("rpy", "quat_xyzw", "axis")
_FORM = 'must be a list of targets such as [{"frame": …, "position": [x, y, z]}], or {"targets": [...]}'
_CHECKS: Mapping[str, Callable[[Any, str], object]] = {
    "position": as_position,
    "rpy": lambda value, option: as_vector(value, 3, option),
    "quat_xyzw": lambda value, option: as_vector(value, 4, option),
    "direction": as_unit_vector,
    "at": as_point,
    "tool": as_point,
}
"""What `Target` checks as well; here the errors name the option instead of the keyword."""


def asked_targets(frame: str | None, wanted: Mapping[str, Any], file: str | None) -> list[Target]:
    """The targets, from the options or from the file.

    Args:
        frame: The frame to move.
        wanted: The other keywords of `Target`; None for an option that was not given.
        file: The path of a JSON file, which leaves no room for the others.

    Raises:
        CommandError, InputError: As for `target_from_options` and `targets_from_file`, or both ways were taken.
    """
    if file is None:
        return [target_from_options(frame, wanted)]
    for name, value in {"frame": frame, **wanted}.items():
        if value is not None:
            raise CommandError(f"--targets reads all targets from the file; put {option_of(name)} into it")
    return targets_from_file(file)


def target_from_options(frame: str | None, wanted: Mapping[str, Any]) -> Target:
    """The target that the options describe.

    Args:
        frame: The frame to move.
        wanted: The other keywords of `Target`; None for an option that was not given.

    Raises:
        CommandError: No frame, nothing to solve for, or options that contradict each other.
        InputError: A value that `Target` refuses.
    """
    if frame is None:
        raise CommandError("no target; give --frame F --position X Y Z, or --targets FILE.json")
    given = {name for name, value in wanted.items() if value is not None}
    orientations = [option_of(name) for name in _ORIENTATIONS if name in given]
    aims = [name for name in ("direction", "at") if name in given]
    if len(aims) == 2:
        raise CommandError("give --direction or --at, not both")
    if ("axis" in given) != bool(aims):
        raise CommandError("--axis needs --direction or --at, and both of these need --axis")
    if len(orientations) > 1:
        raise CommandError(f"give only one orientation; got {' and '.join(orientations)}")
    if not orientations and "position" not in given:
        raise CommandError("no target; give --position, --rpy, --quat-xyzw, or --axis with --direction or --at")
    for name, check in _CHECKS.items():
        if name in given:
            check(wanted[name], option_of(name))
    return Target(frame, **wanted)


def read_position(words: Sequence[str] | None) -> list[float | None] | None:
    """The coordinates [m] of `--position`, with None for "-".

    Raises:
        CommandError: A word is neither a number nor "-".
    """
    if words is None:
        return None
    try:
        return [None if word == "-" else float(word) for word in words]
    except ValueError:
        raise CommandError(
            f"--position must be three numbers, with - for an axis that is free; got {' '.join(words)}; "
            "see 'pinik solve --help'"
        ) from None


def option_of(keyword: str) -> str:
    """The option that sets a keyword of the library."""
    return "--" + keyword.replace("_", "-")


@contextmanager
def named_by_option(options: Mapping[str, Any]) -> Iterator[None]:
    """Let the library's errors about these keywords name the option instead.

    Raises:
        CommandError: In place of an InputError about one of the keywords.
    """
    try:
        yield
    except InputError as error:
        if error.argument is None or error.argument not in options:
            raise
        raise CommandError(f"{option_of(error.argument)} {error.requirement}") from None


def targets_from_file(path: str) -> list[Target]:
    """The targets in a JSON file; "-" is stdin.

    Raises:
        CommandError: The file is unreadable or not JSON, or `Target.from_dict` refuses a target; the message names
            file, index and key.
    """
    label = label_of(path)
    data = read_bytes(path, _MOST_BYTES, "a file of targets")
    try:
        document = json.loads(data.decode("utf-8-sig"), object_pairs_hook=_without_duplicates)
    except (ValueError, RecursionError) as error:
        raise CommandError(f"{label}: not JSON: {error}") from None
    items = _items(document, label)
    return [read_target(item, f"{label}: target {index}") for index, item in enumerate(items)]


def check_frames(robot: Robot, targets: list[Target], path: str) -> None:
    """Check that the robot has every frame that a file's targets name.

    Raises:
        CommandError: It does not have one of them; the message names file, index and key.
    """
    for index, target in enumerate(targets):
        for key, frame in (("frame", target.frame), ("relative_to", target.relative_to)):
            try:
                if frame is not None:
                    robot.frame_id(frame)
            except PinikError as error:
                raise CommandError(f"{label_of(path)}: target {index}: {key}: {error}") from None


def _items(document: Any, label: str) -> list[Any]:
    if isinstance(document, Mapping):
        others = [key for key in document if key not in ("targets", "schema")]
        if others or "targets" not in document:
            found = ", ".join(map(repr, document)) or "no keys"
            raise CommandError(f"{label}: {_FORM}; got an object with {found}")
        document = document["targets"]
    if not isinstance(document, list):
        raise CommandError(f"{label}: {_FORM}; got {shortened(json.dumps(document), QUOTED)}")
    if len(document) > _MOST_TARGETS:
        raise CommandError(
            f"{label}: a file must hold at most {_MOST_TARGETS} targets, as one configuration has to meet all of them; "
            f"got {len(document):,}. To solve targets one after the other, run one command for each"
        )
    if not document:
        raise CommandError(f"{label}: there are no targets")
    return document


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields: dict[str, Any] = {}
    for key, value in pairs:
        if key in fields:
            raise ValueError(f"duplicate key {key!r} in an object")
        fields[key] = value
    return fields


def read_target(item: Any, where: str) -> Target:
    """A target from its JSON form; warnings go to stderr and begin with `where`.

    Raises:
        CommandError: `Target.from_dict` refuses it.
    """
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always", InputWarning)
        try:
            target = Target.from_dict(item)
        except PinikError as error:
            raise CommandError(f"{where}: {error}") from None
    for warning in given:
        output.warn(f"{where}: {warning.message}")
    return target
