"""Grouped bars as in the thesis's figure 4.9: time, iterations and efficiency of each method in each comparison."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .method_style import method_colors

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_comparison"]

Row = Mapping[str, Any]

_PANELS: tuple[tuple[str, str, Callable[[Row], float]], ...] = (
    ("time", "time a step [ms]", lambda row: 1000.0 * row["time_s"]),
    ("iterations", "iterations a step", lambda row: row["counted_iterations"]),
    ("efficiency", "efficiency [%]", lambda row: 100.0 * row["efficiency"]),
)


def draw_comparison(answer: Mapping[str, Any]) -> Figure:
    """Draw what `pinik compare --json` prints; outlined bars show the figures of the thesis."""
    from matplotlib.figure import Figure

    rows: Sequence[Row] = answer["rows"]
    names = list(dict.fromkeys(row["comparison"] for row in rows))
    colors = method_colors(dict.fromkeys(row["method"] for row in rows))
    width = 0.8 / len(colors)
    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    axes = figure.subplots(1, len(_PANELS))
    for panel, (key, title, of) in zip(axes, _PANELS, strict=True):
        for number, (method, color) in enumerate(colors.items()):
            own = [row for row in rows if row["method"] == method]
            at = [names.index(row["comparison"]) + (number - (len(colors) - 1) / 2) * width for row in own]
            panel.bar(at, [of(row) for row in own], width, label=method, color=color)
            theirs = [_published(row, key) for row in own]
            panel.bar(at, theirs, width, fill=False, edgecolor="black", linewidth=0.7)
        panel.set_title(title)
        panel.set_xticks(range(len(names)), [_label(rows, name) for name in names], fontsize=8)
        if key != "efficiency":
            panel.set_yscale("symlog", linthresh=0.001 if key == "time" else 1.0, linscale=0.2)
            panel.set_ylim(0.0, 1.4 * panel.get_ylim()[1])
    bars, labels = axes[0].get_legend_handles_labels()
    figure.legend(bars, labels, loc="outside lower center", ncols=len(colors), fontsize=8, frameon=False)
    figure.suptitle(
        f"{answer['robot']}, {answer['frame']}: preset {answer['preset']}, reading {answer['reading']}, "
        f"{answer['steps']} steps; outlined: Table 4.1 of the thesis"
    )
    return figure


def _published(row: Row, key: str) -> float:
    cell = row["thesis"]
    if cell is None:
        return 0.0
    if key == "time":
        return float(1000.0 * cell["time_s"])
    return float(cell["iterations"] if key == "iterations" else 100.0 * cell["efficiency"])


def _label(rows: Sequence[Row], name: str) -> str:
    row = next(row for row in rows if row["comparison"] == name)
    return f"{name}\n{row['motion']}\n{'limits' if row['limits'] else 'free'}"
