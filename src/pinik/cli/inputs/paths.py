"""The path of `pinik track`: places or targets, one a line, as CSV or JSON Lines."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ...echoes import QUOTED, shortened
from ...errors import PinikError
from ...problem.targets import Target
from ...robot import Robot
from ..terminal.exits import CommandError
from ..terminal.units import Units
from .files import label_of, read_bytes
from .targets import option_of, read_target

__all__ = ["PathPoints", "read_path"]

_MOST_BYTES = 256 * 1024 * 1024
_POSITION = ("x", "y", "z")
_QUATERNION = ("qx", "qy", "qz", "qw")
_RPY = ("roll", "pitch", "yaw")
_HEADERS = (
    "the header must be x,y,z, then qx,qy,qz,qw or roll,pitch,yaw if there is an orientation, then t if there are times"
)


@dataclass
class PathPoints:
    """The points of a path.

    Attributes:
        targets: The targets of each point.
        times: When each point is reached [s]; empty if the file gives no times.
    """

    targets: list[tuple[Target, ...]] = field(default_factory=list)
    times: list[float] = field(default_factory=list)


@dataclass(frozen=True)
class _Given:
    """What the options say about every point."""

    frame: str | None
    common: Mapping[str, Any]
    units: Units


def read_path(path: str, frame: str | None, common: Mapping[str, Any], units: Units, robot: Robot) -> PathPoints:
    """Read a path; "-" is stdin. Lines that start with { or [ are JSON, anything else is CSV with a header.

    Args:
        path: The file.
        frame: The frame that places are meant for.
        common: Keywords of `Target` that hold for all places, such as the tool.
        units: The unit of roll, pitch and yaw in CSV.
        robot: The robot, which must have the frames.

    Raises:
        CommandError: The file is unreadable, or a line is faulty; the message names file and line.
    """
    label = label_of(path)
    lines = [(number, line) for number, line in enumerate(_text(path, label).splitlines(), start=1) if line.strip()]
    if not lines:
        raise CommandError(f"{label}: there are no points")
    given = _Given(frame, {name: value for name, value in common.items() if value is not None}, units)
    read = _json_points if lines[0][1].lstrip().startswith(("{", "[")) else _csv_points
    points = PathPoints()
    for number, targets, time in read(lines, given, label):
        where = f"{label}: line {number}"
        if points.targets and [t.shape for t in targets] != [t.shape for t in points.targets[0]]:
            raise CommandError(f"{where}: every line must ask for the same frames and the same kinds of targets")
        if points.targets and (time is None) == bool(points.times):
            raise CommandError(f"{where}: give the time t in every line or in none")
        if time is not None and not abs(time) <= sys.float_info.max:
            raise CommandError(f"{where}: t must be a finite number of seconds; got {shortened(str(time), QUOTED)}")
        if time is not None and points.times and not time > points.times[-1]:
            raise CommandError(f"{where}: the times must increase; got {points.times[-1]:g} and then {time:g}")
        points.targets.append(targets)
        points.times += [] if time is None else [float(time)]
        if len(points.targets) == 1:
            _check_frames(robot, targets, where)
    if not points.targets:
        raise CommandError(f"{label}: there are no points after the header")
    return points


def _text(path: str, label: str) -> str:
    try:
        return read_bytes(path, _MOST_BYTES, "a path").decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CommandError(f"{label}: not UTF-8: {error.reason} at byte {error.start}") from None


def _check_frames(robot: Robot, targets: tuple[Target, ...], where: str) -> None:
    for frame in (frame for target in targets for frame in (target.frame, target.relative_to) if frame is not None):
        try:
            robot.frame_id(frame)
        except PinikError as error:
            raise CommandError(f"{where}: {error}") from None


_Point = tuple[int, tuple[Target, ...], float | None]


def _csv_points(lines: list[tuple[int, str]], given: _Given, label: str) -> Iterator[_Point]:
    number, header = lines[0]
    names = [name.strip().lower() for name in next(csv.reader([header]))]
    _check_header(names, f"{label}: line {number}")
    if given.frame is None:
        raise CommandError("a path of places needs the frame that should follow it; give --frame F")
    for number, line in lines[1:]:
        where = f"{label}: line {number}"
        cells = next(csv.reader([line]))
        if len(cells) != len(names):
            raise CommandError(f"{where}: there must be {len(names)} numbers, as in the header; got {len(cells)}")
        values = {name: _number(name, cell, where) for name, cell in zip(names, cells, strict=True) if cell.strip()}
        for name in names:
            if name not in values and name not in _POSITION:
                raise CommandError(f"{where}: {name} must be a number; only x, y and z may be empty, to be free")
        position = [values.get(name) for name in _POSITION]
        free = all(coordinate is None for coordinate in position) and len(values) > ("t" in values)
        fields: dict[str, Any] = {} if free else {"position": position}
        if "qx" in values:
            fields["quat_xyzw"] = [values[name] for name in _QUATERNION]
        elif "roll" in values:
            fields["rpy"] = [given.units.radians(values[name]) for name in _RPY]
        yield number, (read_target({"frame": given.frame, **given.common, **fields}, where),), values.get("t")


def _check_header(names: list[str], where: str) -> None:
    turned = tuple(name for name in names if name in (*_QUATERNION, *_RPY))
    allowed = (*_POSITION, *_QUATERNION, *_RPY, "t")
    fits = (
        len(set(names)) == len(names)
        and set(names) <= set(allowed)
        and set(_POSITION) <= set(names)
        and set(turned) in (set(), set(_QUATERNION), set(_RPY))
    )
    if not fits:
        raise CommandError(f"{where}: {_HEADERS}; got {','.join(names)}")


def _number(name: str, cell: str, where: str) -> float:
    try:
        return float(cell)
    except ValueError:
        raise CommandError(f"{where}: {name} must be a number; got {cell.strip()!r}") from None


def _json_points(lines: list[tuple[int, str]], given: _Given, label: str) -> Iterator[_Point]:
    for number, line in lines:
        where = f"{label}: line {number}"
        try:
            item = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise CommandError(f"{where}: not JSON: {error}") from None
        time = item.pop("t", None) if isinstance(item, dict) else None
        if time is not None and (isinstance(time, bool) or not isinstance(time, (int, float))):
            raise CommandError(
                f"{where}: t must be a finite number of seconds; got {shortened(json.dumps(time), QUOTED)}"
            )
        items = item["targets"] if isinstance(item, dict) and set(item) == {"targets"} else item
        if not (isinstance(items, list) and items and all(isinstance(one, dict) for one in items)):
            items = [items]
        yield number, tuple(read_target(_with_frame(one, given, where), where) for one in items), time


def _with_frame(item: Any, given: _Given, where: str) -> Any:
    """A target's fields, from an object or from a bare position or placement."""
    if isinstance(item, list):
        item = {"placement" if item and isinstance(item[0], list) else "position": item}
    if not isinstance(item, dict):
        return item
    if "frame" in item:
        for name in given.common:
            raise CommandError(f"{where}: the target names its frame; put {option_of(name)} into it")
        return item
    if given.frame is None:
        raise CommandError(f"{where}: the target must name its frame, or --frame must be given")
    return {"frame": given.frame, **given.common, **item}
