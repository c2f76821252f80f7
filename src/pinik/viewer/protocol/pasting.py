"""Angles that somebody pastes, in the forms in which programs print them, read without running anything."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Mapping
from typing import Any

import pinocchio

from ...echoes import QUOTED, shortened
from ...errors import InputError
from ...robot import Robot
from ...rotations import as_se3
from ..simulation.by_hand import set_angles
from ..simulation.session import Session
from .reading import read_json

__all__ = ["angles_by_joint", "paste_angles", "read_angles"]

_LONGEST = 20_000
_MOST_JOINTS = 1000
_FORMS = "numbers in the order of the joints, JSON, or YAML with one joint: value in a line"
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_COMMENT = re.compile(r'("(?:[^"\\]|\\.)*")|(?:^|\s)#.*')  # or a name in quotes, which may contain a #
_PLACEMENTS = "joint_placements"
_WRAPPERS = ("angles", "positions", "joint_positions", "joints", "q0", "solution", "pose")
"""Names under which programs put the angles of joints."""


def angles_by_joint(what: str, value: Any) -> dict[str, Any]:
    """Check that a value is an object of at most 1000 joints; whoever sets the angles checks names and numbers."""
    if not isinstance(value, Mapping) or len(value) > _MOST_JOINTS:
        raise InputError(
            f"{what} must be an object of at most {_MOST_JOINTS} joints; got {shortened(str(value), QUOTED)!r}"
        )
    return dict(value)


def paste_angles(session: Session, instance: int | None, text: str) -> None:
    """Set the joints of one visible instance, or of all, to angles given as text; `read_angles` explains the forms.

    Raises:
        UnknownNameError, InputError: The text is none of the forms, or as for `set_angles`.
    """
    set_angles(session, instance, read_angles(session.robot, text))


def read_angles(robot: Robot, text: str) -> dict[str, Any]:
    """Read angles [rad, or m for sliding joints] from text.

    The forms are: numbers, one for each joint that can be set, in the robot's order, with or without brackets and
    commas; a JSON object of joint: number, or one that contains it, or such numbers, as "angles", as `pinik solve
    --json` prints it, with the "joint_placements" of floating and planar joints if there are any; and YAML lines
    "joint: number", indented or not, or the two lists `name` and `position` of a ROS joint state. Followers are left
    out, because they follow.

    Returns:
        Joint name → number or placement, as `set_angles` takes them.

    Raises:
        InputError: The text is none of these; the message names the line or the count that does not fit.
    """
    if len(text) > _LONGEST:
        raise InputError(f"pasted angles must have at most {_LONGEST} characters; got {len(text)}")
    plain = text.strip()
    if not plain:
        raise InputError(f"nothing was pasted; paste {_FORMS}")
    if plain[0] == "{":
        given = _from_json(robot, plain)
    elif words := _only_numbers(plain):
        given = _in_order(robot, [float(word) for word in words])
    else:
        given = _from_lines(robot, plain)
    followers = {name for name in given if name in robot.mimics}
    return {name: value for name, value in given.items() if name not in followers}


def _only_numbers(text: str) -> list[str]:
    """The numbers of a text that contains nothing else but brackets and separators, or an empty list."""
    words = re.sub(r"[\[\](),;]", " ", text).split()
    return words if words and all(_NUMBER.fullmatch(word) for word in words) else []


def _in_order(robot: Robot, numbers: list[Any]) -> dict[str, Any]:
    names = robot.joint_names
    if len(numbers) != len(names):
        shown = shortened(", ".join(names), 120)
        raise InputError(f"{robot.name} has {len(names)} joints that can be set ({shown}); got {len(numbers)} numbers")
    return dict(zip(names, numbers, strict=True))


def _from_json(robot: Robot, text: str) -> dict[str, Any]:
    try:
        value = read_json(text)
    except ValueError as error:
        raise InputError(f"the pasted text begins like JSON, but is not: {error}") from None
    placements = angles_by_joint(_PLACEMENTS, value.pop(_PLACEMENTS, {}))
    inner = next((value[name] for name in _WRAPPERS if isinstance(value.get(name), dict | list)), value)
    angles = _in_order(robot, inner) if isinstance(inner, list) else angles_by_joint("the pasted JSON", inner)
    return angles | {name: _placement(name, matrix) for name, matrix in placements.items()}


def _placement(name: str, matrix: Any) -> list[float]:
    """The placement of a floating or planar joint, as `set_angles` takes it."""
    return list(pinocchio.SE3ToXYZQUATtuple(as_se3(matrix, f"the placement of joint {name!r}")))


def _from_lines(robot: Robot, text: str) -> dict[str, Any]:
    """Read YAML lines: "joint: number", or the lists "name" and "position"."""
    angles: dict[str, Any] = {}
    lists: dict[str, list[str]] = {}
    current = ""
    for number, line in enumerate(text.split("\n"), 1):
        words = _COMMENT.sub(lambda found: found[1] or "", line).strip()
        if not words or words in ("---", "..."):
            continue
        if words.startswith("- ") and current:
            lists[current].append(_unquoted(words[2:]))
            continue
        name, colon, value = words.removeprefix("- ").rpartition(":")
        name, value = _unquoted(name), value.strip()
        if not colon or not name:
            raise InputError(f"line {number} of the pasted text must be joint: value; got {shortened(words, QUOTED)!r}")
        if value == "" or value[0] == "[":
            current = name
            lists[name] = [_unquoted(word) for word in value.strip("[]").split(",") if word.strip()]
        elif _NUMBER.fullmatch(value):
            if name in angles:
                raise InputError(f"line {number} of the pasted text sets joint {name!r} a second time")
            angles[name] = float(value)
        elif name in robot.joint_names:
            raise InputError(f"line {number}: joint {name!r} must have a number; got {shortened(value, QUOTED)!r}")
    return _joint_state(lists) if not angles or {"name", "position"} <= set(lists) else angles


def _joint_state(lists: Mapping[str, list[str]]) -> dict[str, Any]:
    names, positions = lists.get("name", []), lists.get("position", [])
    if not names or len(names) != len(positions) or not all(map(_NUMBER.fullmatch, positions)):
        raise InputError(f"the pasted text has no angles; paste {_FORMS}")
    return {name: float(position) for name, position in zip(names, positions, strict=True)}


def _unquoted(text: str) -> str:
    """A name without its quotes; double ones are those of JSON, as YAML's are."""
    text = text.strip()
    if text[:1] == '"':
        with contextlib.suppress(ValueError):
            return str(json.loads(text))
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "'\"" else text
