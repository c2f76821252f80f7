"""The result of a race as text in columns, to copy."""

from __future__ import annotations

import statistics
import textwrap
from collections.abc import Sequence

from ...problem.tolerance import Tolerance
from .race import Race, Runner

__all__ = ["card"]

_WIDTH = 54  # characters that the page has room for


def card(race: Race) -> str:
    """The result as text in columns, with the rules that all methods had."""
    entry, settings = race.entry, race.entry.settings
    count = len(entry.places)
    what = f"{count} random places within reach" if entry.random else "the balls as they are"
    rules = [
        f"tolerance {_tolerance(settings.tolerance)}",
        f"limits {'on' if settings.limits else 'off'}",
        f"at most {race.most} iteration{'s' * (race.most != 1)}",
        "no restarts",
    ]
    head = ("method", "first", "reached", "iterations", "time", "error")
    rows = [_row(runner, count) for runner in sorted(race.runners, key=lambda one: -one.wins)]
    widths = [max(len(row[k]) for row in (head, *rows)) for k in range(len(head))]

    def line(row: Sequence[str]) -> str:
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        return "  ".join(cells).rstrip()

    refused = [f"{runner.called}: {runner.refusal}" for runner in race.runners if runner.refusal]
    words = [f"pinik race: {entry.robot.name}, {entry.frame}, {what}", ", ".join(rules)]
    meaning = "first: how often it arrived first; iterations and time: medians over what it reached"
    paragraphs = [textwrap.fill(one, _WIDTH) for one in (*words, meaning, *refused)]
    return "\n".join([*paragraphs[:2], *map(line, (head, *rows)), *paragraphs[2:]])


def _row(runner: Runner, count: int) -> tuple[str, ...]:
    arrived = runner.arrived
    errors = [finish.error for finish in runner.finishes if finish.error is not None and not finish.reached]
    return (
        runner.called,
        str(runner.wins),
        f"{len(arrived)}/{count}",
        f"{statistics.median(finish.iterations for finish in arrived):g}" if arrived else "-",
        _time(statistics.median(finish.time for finish in arrived)) if arrived else "-",
        f"{1000.0 * max(errors):.1f} mm" if errors else "-",
    )


def _time(seconds: float) -> str:
    return f"{1e6 * seconds:.1f} µs" if seconds < 1e-3 else f"{1e3 * seconds:.2f} ms"


def _tolerance(tolerance: Tolerance) -> str:
    return f"{1000.0 * tolerance.farthest:g} mm"
