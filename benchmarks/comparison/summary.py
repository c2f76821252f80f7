"""pinik against the references, over all robots: the figures that people quote."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .peer_list import REFERENCES
from .tables import Row, times_as_fast

__all__ = ["summary_of"]

SINGLE = ("poses", "path", "still")


def summary_of(rows: Sequence[Row]) -> list[list[str]]:
    """A grid with a heading: by how many times pinik's rows are faster by median, from the worst to the best robot."""
    grid = [["times as fast, by median", *(name for name, _ in REFERENCES)]]
    labels = {row.peer: row.label for row in rows if row.peer.startswith("pinik") and row.task in SINGLE and row.count}
    for task in SINGLE:
        for peer, label in labels.items():
            ratios = [
                [times_as_fast(row, key, rows)[0] for row in rows if (row.task, row.peer) == (task, peer)]
                for _, key in REFERENCES
            ]
            if any(ratios):
                grid.append([f"{task}: {label}", *map(_span, ratios)])
    grid += [[f"{what} ({robot})", value] for what, robot, value in _batches(rows)]
    width = len(grid[0])
    return [line + [""] * (width - len(line)) for line in grid]


def _batches(rows: Sequence[Row]) -> list[tuple[str, str, str]]:
    """What two threads of `solve_many` gain, and how many placements are computed in a second, on each robot."""
    found = []
    for row in rows:
        if row.peer == "pinik-many-2":
            _, ratio = times_as_fast(row, "pinik-many-1", rows)
            if not math.isnan(ratio):
                found.append(("solve_many, 2 threads over 1", row.robot, f"{ratio:.2f}"))
        if row.peer == "pinik-placements" and row.count:
            found.append(("placements per second", row.robot, f"{1e6 / row.mean:,.0f}"))
    return sorted(found, key=lambda each: each[0] != "solve_many, 2 threads over 1")


def _span(ratios: Sequence[float]) -> str:
    known = [ratio for ratio in ratios if not math.isnan(ratio)]
    if not known:
        return "–"
    low, high = (f"{value:.3g}" for value in (min(known), max(known)))
    return low if low == high else f"{low} to {high}"
