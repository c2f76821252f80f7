"""Grouped bars as in the thesis's fig. 4.9: time, iterations and efficiency of each method in each comparison."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from .plots import METHOD_COLORS, save_plot

__all__ = ["draw_comparison"]

Figures = Mapping[str, Any]

_PANELS: tuple[tuple[str, str, Callable[[Figures], float]], ...] = (
    ("time", "time a step [ms]", lambda row: 1000.0 * row["time_s"]),
    ("iterations", "iterations a step", lambda row: row["counted_iterations"]),
    ("efficiency", "efficiency [%]", lambda row: 100.0 * row["efficiency"]),
)


def draw_comparison(answer: Mapping[str, Any], path: Path) -> None:
    """Write a picture of what `pinik compare --json` prints; the thesis's own figures are the outlined bars.

    Raises:
        CommandError: The file cannot be written.
    """
    from matplotlib.figure import Figure

    rows: Sequence[Figures] = answer["rows"]
    names = list(dict.fromkeys(row["comparison"] for row in rows))
    methods = list(dict.fromkeys(row["method"] for row in rows))
    width = 0.8 / len(methods)
    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    axes = figure.subplots(1, len(_PANELS))
    for panel, (key, title, of) in zip(axes, _PANELS, strict=True):
        for number, method in enumerate(methods):
            own = [row for row in rows if row["method"] == method]
            at = [names.index(row["comparison"]) + (number - (len(methods) - 1) / 2) * width for row in own]
            panel.bar(at, [of(row) for row in own], width, label=method, color=METHOD_COLORS[method])
            theirs = [_published(row, key) for row in own]
            panel.bar(at, theirs, width, fill=False, edgecolor="black", linewidth=0.7)
        panel.set_title(title)
        panel.set_xticks(range(len(names)), [_label(rows, name) for name in names], fontsize=8)
        if key != "efficiency":
            panel.set_yscale("symlog", linthresh=0.001 if key == "time" else 1.0)
            panel.set_ylim(bottom=0.0)
    bars, labels = axes[0].get_legend_handles_labels()
    figure.legend(bars, labels, loc="outside lower center", ncols=len(methods), fontsize=8, frameon=False)
    figure.suptitle(
        f"{answer['robot']}, {answer['frame']}: preset {answer['preset']}, reading {answer['reading']}, "
        f"{answer['steps']} steps; outlined: the thesis's Table 4.1"
    )
    save_plot(figure, path)


def _published(row: Figures, key: str) -> float:
    cell = row["thesis"]
    if cell is None:
        return 0.0
    if key == "time":
        return float(1000.0 * cell["time_s"])
    return float(cell["iterations"] if key == "iterations" else 100.0 * cell["efficiency"])


def _label(rows: Sequence[Figures], name: str) -> str:
    row = next(row for row in rows if row["comparison"] == name)
    return f"{name}\n{row['motion']}\n{'limits' if row['limits'] else 'free'}"
