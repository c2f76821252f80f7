"""What was measured, as rows of figures, as text and as JSON."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .peer_list import REFERENCES, Peer
from .verdicts import Verdict

__all__ = ["Measured", "Row", "as_json", "as_text", "row_of"]


@dataclass
class Measured:
    """All that one peer did with one arm and task.

    Attributes:
        verdicts: One for each target that it got to.
        nanoseconds: The time of each.
        wall: The time of all together [ns]; what counts for the mean of a batch on several threads.
        note: What went wrong with some of its targets.
        reason: Why there is nothing to report; empty when there is.
    """

    verdicts: list[Verdict]
    nanoseconds: list[int]
    wall: int = 0
    note: str = ""
    reason: str = ""


@dataclass
class Row:
    """One peer's figures for one arm and task: shares [%], times [µs]."""

    robot: str
    task: str
    peer: str
    label: str
    count: int = 0
    solved: float = math.nan
    strict: float = math.nan
    median: float = math.nan
    mean: float = math.nan
    p90: float = math.nan
    p99: float = math.nan
    note: str = ""
    reason: str = ""


def row_of(robot: str, task: str, peer: Peer, measured: Measured) -> Row:
    """Figures out of what was measured."""
    row = Row(robot, task, peer.key, peer.label, note=measured.note, reason=measured.reason)
    if measured.nanoseconds:
        verdicts, times = np.array(measured.verdicts), np.array(measured.nanoseconds) / 1e3
        row.count = len(times)
        row.solved = 100 * float((verdicts >= Verdict.SOLVED).mean())
        row.strict = 100 * float((verdicts >= Verdict.STRICTLY_SOLVED).mean())
        row.mean = measured.wall / 1e3 / len(times)
        row.median, row.p90, row.p99 = (float(value) for value in np.percentile(times, [50, 90, 99]))
    return row


def as_text(rows: list[Row]) -> str:
    """A table of the rows of one arm and task."""
    ratios = "".join(f"{name + ' med':>11}{name + ' mean':>11}" for name, _ in REFERENCES)
    lines = [
        f"## {rows[0].robot}, {rows[0].task}; at the right: how many times as fast as …, by median and by mean",
        f"{'':27} {'count':>6} {'solved':>7} {'strict':>7} {'median':>9} {'mean':>9} {'p90':>9} {'p99':>9} µs {ratios}",
    ]
    lines += [_line(row, rows) for row in rows]
    return "\n".join(lines)


def as_json(rows: list[Row]) -> list[dict[str, Any]]:
    """The rows with their ratios; what is not known is null."""
    found = []
    for row in rows:
        ratios = {
            name: {"median": median, "mean": mean}
            for name, (median, mean) in _ratios(row, [other for other in rows if _same_problems(row, other)]).items()
        }
        found.append(_without_nan({**asdict(row), "times_as_fast_as": ratios}))
    return found


def _line(row: Row, rows: list[Row]) -> str:
    if not row.count:
        return f"{row.label:27} {row.reason}"
    ratios = "".join(f"{_short(median):>11}{_short(mean):>11}" for median, mean in _ratios(row, rows).values())
    note = f"  ({row.note})" if row.note else ""
    return (
        f"{row.label:27} {row.count:6} {row.solved:6.2f}% {row.strict:6.2f}% "
        f"{row.median:9.1f} {row.mean:9.1f} {row.p90:9.1f} {row.p99:9.1f}    {ratios}{note}"
    )


def _ratios(row: Row, rows: list[Row]) -> dict[str, tuple[float, float]]:
    """How many times as fast as each reference a row is, by median and by mean."""
    by_key = {other.peer: other for other in rows}
    ratios = {}
    for _, key in REFERENCES:
        reference = by_key.get(key, Row("", "", "", ""))
        ratios[key] = (reference.median / row.median, reference.mean / row.mean)
    return ratios


def _same_problems(row: Row, other: Row) -> bool:
    return (row.robot, row.task) == (other.robot, other.task)


def _short(ratio: float) -> str:
    return "–" if math.isnan(ratio) else f"{ratio:.3g}"


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    return None if isinstance(value, float) and math.isnan(value) else value
