"""What people quote: pinik against the references over all robots, threads against one, placements in a second."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .peer_list import REFERENCES
from .tables import Row, times_as_fast

__all__ = ["Grid", "batches_of", "ratios_of"]

Grid = list[list[str]]  # lines of cells, the first of them the heading

SINGLE = ("poses", "path", "still")


def ratios_of(rows: Sequence[Row]) -> Grid:
    """By how many times pinik's rows are faster than each reference by median: the worst and the best robot."""
    grid = [["speed-up (ratio of medians)", *(name for name, _ in REFERENCES)]]
    labels = {row.peer: row.label for row in rows if row.peer.startswith("pinik") and row.task in SINGLE and row.count}
    for task in SINGLE:
        for peer, label in labels.items():
            mine = [row for row in rows if (row.task, row.peer) == (task, peer)]
            spans = [_span([times_as_fast(row, key, rows)[0] for row in mine]) for _, key in REFERENCES]
            if any(spans):
                grid.append([f"{task}: {label}", *(span or "–" for span in spans)])
    return grid


def batches_of(rows: Sequence[Row]) -> Grid:
    """What two threads of `solve_many` gain, and how many placements are computed in a second, on each robot."""
    robots = list(dict.fromkeys(row.robot for row in rows))
    gains, speeds = dict.fromkeys(robots, "–"), dict.fromkeys(robots, "–")
    for row in rows:
        if row.peer == "pinik-many-2" and row.count:
            gains[row.robot] = f"{times_as_fast(row, 'pinik-many-1', rows)[1]:.2f}"
        if row.peer == "pinik-placements" and row.count:
            speeds[row.robot] = f"{1e6 / row.mean:,.0f}"
    return [
        ["all in one call", *robots],
        ["solve_many: speed of 2 threads over 1", *gains.values()],
        ["robot.placements in a second", *speeds.values()],
    ]


def _span(ratios: Sequence[float]) -> str:
    known = [ratio for ratio in ratios if not math.isnan(ratio)]
    if not known:
        return ""
    low, high = (f"{value:.3g}" for value in (min(known), max(known)))
    return low if low == high else f"{low} to {high}"
