"""The tables as Markdown, and a document's part that they replace."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from .problems import TASKS
from .summary import Grid
from .tables import Row

__all__ = ["BEGIN", "END", "as_markdown", "replace_part"]

BEGIN = "<!-- From here to the end mark, `python benchmarks/peers.py --write` writes. -->"
END = "<!-- The end of what it writes. -->"


def as_markdown(points: Sequence[str], grids: Sequence[Grid], rows: Sequence[Row], command: str) -> str:
    """The paragraph above the tables, the grids that sum up, and one table for each task."""
    parts = [
        f"Written by `{command}`.",
        "**Read before quoting**",
        "\n".join(f"* {point}" for point in points),
        *map(_grid, grids),
    ]
    for task, words in TASKS.items():
        of_task = [row for row in rows if row.task == task]
        if of_task:
            parts += [f"**{task}**: {words}. Each cell: strict, median / mean / 99th percentile [µs].", _table(of_task)]
            parts += _reasons(of_task)
    return "\n\n".join(parts)


def replace_part(document: Path, text: str) -> None:
    """Write the text between the two marks of a document.

    Raises:
        ValueError: The document does not have both marks.
    """
    before, begin, rest = document.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"{document} must have the lines {BEGIN!r} and {END!r}")
    document.write_text(f"{before}{BEGIN}\n\n{text}\n\n{END}{after}", encoding="utf-8")


def _grid(grid: Grid) -> str:
    heading, *lines = grid
    rule = ["---"] * len(heading)
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (heading, rule, *lines))


def _table(rows: Sequence[Row]) -> str:
    robots = list(dict.fromkeys(row.robot for row in rows))
    by_place = {(row.peer, row.robot): row for row in rows}
    lines = [["", *robots, "does not, or needs"]]
    for peer in dict.fromkeys(row.peer for row in rows):
        here = [by_place[peer, robot] for robot in robots]
        if any(row.count for row in here):
            lines.append([here[0].label, *map(_cell, here), here[0].lacks])
    return _grid(lines)


def _cell(row: Row) -> str:
    if not row.count:
        return "–"
    share = f"{row.strict:.4g} %" + (f" (placed {row.placed:.4g} %)" if row.placed > row.solved else "")
    times = [f"{value:,.3g}" if value < 1000 else f"{value:,.0f}" for value in (row.median, row.mean, row.p99)]
    return f"{share}, " + " / ".join(times[:2] if math.isnan(row.p99) else times)


def _reasons(rows: Sequence[Row]) -> list[str]:
    """Why rows are missing, each reason once."""
    reasons: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        if not row.count:
            reasons.setdefault((row.label, row.reason), []).append(row.robot)
    lines = [f"{label} ({', '.join(robots)}): {reason}" for (label, reason), robots in reasons.items()]
    return [f"Skipped: {'; '.join(lines)}."] if lines else []
