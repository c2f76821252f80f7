"""A path in joint space as CSV or JSON Lines."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...solving.track import Track
from ..inputs.files import check_file, write_file
from ..terminal.exits import CommandError
from ..terminal.output import emit
from ..terminal.units import Units

__all__ = ["FORMATS", "check_output", "emit_track"]

FORMATS = ("csv", "jsonl")
_FORMAT_OF = {"": "csv", ".csv": "csv", ".jsonl": "jsonl", ".ndjson": "jsonl"}


def check_output(path: Path | None, form: str | None) -> str:
    """Return the format of the output, "csv" or "jsonl", and check that its file can be written.

    Raises:
        CommandError: There is no such format, the ending of the file says none, or the file cannot be written.
    """
    ending = "" if path is None else path.suffix.lower()
    if form is None and ending not in _FORMAT_OF:
        raise CommandError(f"--output {path} must end in .csv, .jsonl or .ndjson; or give --format csv or jsonl")
    form = _FORMAT_OF[ending] if form is None else form
    if form not in FORMATS:
        raise CommandError(f"--format must be csv or jsonl; got {form!r}")
    if path is not None:
        check_file(path, "--output")
    return form


def emit_track(track: Track, form: str, path: Path | None, units: Units) -> None:
    """Write the angles of every point to a file, or to stdout when there is none.

    Raises:
        CommandError: The file cannot be written, or CSV cannot hold a floating or planar joint.
    """
    if form == "csv" and any(not joint.has_one_axis for joint in track.robot.joints):
        raise CommandError("CSV has no place for floating and planar joints; use --format jsonl")
    lines = _csv_lines(track, units) if form == "csv" else _json_lines(track)
    text = "\n".join(lines)
    if path is None:
        emit(text)
        return
    write_file(path, (text + "\n").encode(), "--output")


def _csv_lines(track: Track, units: Units) -> Iterator[str]:
    joints = [track.robot.joint(name) for name in track.joint_names]
    turns = [units.degrees and joint.kind != "prismatic" for joint in joints]
    yield _csv_line((["t"] if track.times is not None else []) + list(track.joint_names))
    for index, angles in enumerate(track.angles.tolist()):
        row = [math.degrees(angle) if turn else angle for angle, turn in zip(angles, turns, strict=True)]
        yield _csv_line([*([] if track.times is None else [float(track.times[index])]), *row])


def _csv_line(cells: list[Any]) -> str:
    line = io.StringIO()
    csv.writer(line, lineterminator="").writerow(cells)
    return line.getvalue()


def _json_lines(track: Track) -> Iterator[str]:
    robot = track.robot
    for index in range(len(track)):
        fields: dict[str, Any] = {} if track.times is None else {"t": float(track.times[index])}
        fields["angles"] = dict(zip(track.joint_names, track.angles[index].tolist(), strict=True))
        placements = robot.joint_placements(track.q[index])
        if placements:
            fields["joint_placements"] = {name: M.homogeneous.tolist() for name, M in placements.items()}
        fields["status"] = track.status[index].name
        yield json.dumps(fields)
