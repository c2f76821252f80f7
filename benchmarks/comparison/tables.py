"""What was measured, as rows of figures, as text and as JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .peer import Peer
from .peer_list import REFERENCES
from .problems import TASKS
from .verdicts import Verdict

__all__ = ["Measured", "Row", "as_json", "as_text", "row_of", "times_as_fast"]


@dataclass
class Measured:
    """All that one peer did with one arm and task.

    Attributes:
        verdicts: One for each target that it got to.
        nanoseconds: The time of each; none where one call answered all and reports no times.
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
    """One peer's figures for one arm and task: shares [%], times [µs].

    `placed` counts answers outside the limits, too; `strict` those within the tolerance [m] that was asked for.
    """

    robot: str
    task: str
    peer: str
    label: str
    lacks: str
    tolerance: float
    count: int = 0
    placed: float = math.nan
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
    row = Row(robot, task, peer.key, peer.label, peer.lacks, peer.tolerance, note=measured.note, reason=measured.reason)
    if measured.verdicts:
        verdicts = np.array(measured.verdicts)
        row.count = len(verdicts)
        row.placed = 100 * float((verdicts > Verdict.MISSED).mean())
        row.solved = 100 * float((verdicts >= Verdict.SOLVED).mean())
        row.strict = 100 * float((verdicts >= Verdict.STRICTLY_SOLVED).mean())
        row.mean = row.median = measured.wall / 1e3 / row.count
    if measured.nanoseconds:
        times = np.array(measured.nanoseconds) / 1e3
        row.median, row.p90, row.p99 = (float(value) for value in np.percentile(times, [50, 90, 99]))
    return row


def as_text(rows: Sequence[Row], noise: tuple[float, float]) -> str:
    """A table of the rows of one arm and task."""
    lines = [
        f"## {rows[0].robot}, {rows[0].task}: {TASKS[rows[0].task]}",
        f"   the machine meanwhile: the same work took {noise[0]:+.0f} % to {noise[1]:+.0f} % of its median time",
        f"{'':33} {'count':>6} {'placed':>7} {'solved':>7} {'strict':>7} "
        f"{'median':>9} {'mean':>9} {'p90':>9} {'p99':>9} µs {'÷ first':>8}  does not, or needs",
    ]
    lines += [_line(row, _first_like(row, rows)) for row in rows]
    return "\n".join(lines)


def as_json(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The rows with their ratios; what is not known is null."""
    found = []
    for row in rows:
        ratios = {}
        for _, key in REFERENCES:
            median, mean = times_as_fast(row, key, rows)
            ratios[key] = {"median": median, "mean": mean}
        found.append(_without_nan({**asdict(row), "times_as_fast_as": ratios}))
    return found


def times_as_fast(row: Row, key: str, rows: Sequence[Row]) -> tuple[float, float]:
    """How many times as fast as another peer a row is on the same problems, by median and by mean."""
    for other in rows:
        if (other.robot, other.task, other.peer) == (row.robot, row.task, key):
            return other.median / row.median, other.mean / row.mean
    return math.nan, math.nan


def _first_like(row: Row, rows: Sequence[Row]) -> Row:
    """The first row that was asked for the same tolerance."""
    return next(other for other in rows if other.tolerance == row.tolerance)


def _line(row: Row, first: Row) -> str:
    if not row.count:
        return f"{row.label:33} skipped: {row.reason}"
    note = f"  ({row.note})" if row.note else ""
    p90, p99 = (f"{'–':>9}" if math.isnan(value) else f"{value:9.1f}" for value in (row.p90, row.p99))
    return (
        f"{row.label:33} {row.count:6} {row.placed:6.2f}% {row.solved:6.2f}% {row.strict:6.2f}% "
        f"{row.median:9.2f} {row.mean:9.2f} {p90} {p99}    {row.median / first.median:8.2f}  {row.lacks}{note}"
    )


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    return None if isinstance(value, float) and math.isnan(value) else value
