"""Welman's figures as pictures of what `pinik accuracy --json` prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .method_style import iteration_word, method_colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_accuracy", "draw_spread", "draw_straight_arm"]

Answer = Mapping[str, Any]

_INK, _FAINT, _BALL = "#1b2129", "#b4bdc8", "#d81f2f"
_TITLES = {"near": "well within reach", "edge": "at the edge of reach"}


def draw_accuracy(answer: Answer) -> Figure:
    """Figs. 4.4 and 4.5: the arms, iterations and time against digits of accuracy; a row for each target."""
    from matplotlib.figure import Figure

    colors = method_colors(dict.fromkeys(row["method"] for row in answer["rows"]))
    figure = Figure(figsize=(12.0, 7.6), layout="constrained")
    grid = figure.subplots(2, 3, width_ratios=(1.0, 1.0, 1.0))
    for (arms, iterations, times), example in zip(grid, answer["examples"], strict=True):
        case = example["case"]
        _draw_example(arms, example, colors)
        _draw_costs(iterations, answer["rows"], case, "iterations", 1.0, colors)
        _draw_costs(times, answer["rows"], case, "time_s", 1e6, colors)
        arms.set_title(f"{_TITLES[case]}: start and answers", fontsize=10)
        iterations.set_title(f"{_TITLES[case]}: iterations (sweeps of ccd)", fontsize=10)
        times.set_title(f"{_TITLES[case]}: time [µs]", fontsize=10)
    lines, labels = grid[0][1].get_legend_handles_labels()
    figure.legend(lines, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    figure.suptitle(
        f"{answer['robot']}: what a digit costs; medians of {answer['problems']} problems, "
        f"{answer['rows'][0]['engine']} engine (Welman, figs. 4.4 and 4.5)"
    )
    return figure


def _draw_example(panel: Axes, example: Answer, colors: Mapping[str, str]) -> None:
    """The start and every method's answer, in ever thinner lines so that equal answers stay visible."""
    answers = example["answers"]
    _draw_arm(panel, example["start"], _FAINT, width=8.0)
    for width, (method, outline) in zip(np.linspace(6.5, 2.0, len(answers)), answers.items(), strict=True):
        _draw_arm(panel, outline, colors[method], float(width))
    _draw_ball(panel, example["position"])
    _frame_arms(panel, [example["start"], *answers.values()])


def _draw_costs(
    panel: Axes, rows: Sequence[Answer], case: str, key: str, factor: float, colors: Mapping[str, str]
) -> None:
    """One line for each method: `factor` times a field of its rows, against the digits."""
    for method, color in colors.items():
        own = [
            (cost["digits"], factor * cost[key])
            for cost in rows
            if (cost["case"], cost["method"]) == (case, method) and cost[key] is not None
        ]
        panel.plot(*np.array(own).reshape(-1, 2).T, "o-", color=color, label=method, markersize=4)
    _scale_by_powers(panel)
    panel.set_xlabel("digits of accuracy")
    panel.set_xticks(sorted({cost["digits"] for cost in rows}))
    panel.grid(axis="y", color="#e3e7ec")
    _without_box(panel)


def draw_straight_arm(answer: Answer) -> Figure:
    """Fig. 4.2: what each method alone, and `pinik.solve`, do with a straight arm that is pulled inwards."""
    from matplotlib.figure import Figure

    places = list(dict.fromkeys(pull["place"] for pull in answer["straight"]))
    colors = method_colors(dict.fromkeys(pull["method"] for pull in answer["straight"]))
    figure = Figure(figsize=(3.0 * len(colors), 3.4), layout="constrained")
    grid = figure.subplots(len(places), len(colors), squeeze=False)
    length = answer["length_m"]
    bones = np.linspace(0.0, length, answer["joints"] + 1)
    straight = np.column_stack([bones, np.zeros_like(bones)]).tolist()
    for row, place in zip(grid, places, strict=True):
        own = [pull for pull in answer["straight"] if pull["place"] == place]
        shown = [straight, *(pull[way]["outline"] for pull in own for way in ("alone", "restarted"))]
        for panel, pull in zip(row, own, strict=True):
            alone, restarted = pull["alone"], pull["restarted"]
            _draw_arm(panel, straight, _FAINT, width=5.0)
            _draw_arm(panel, restarted["outline"], colors[pull["method"]], dashed=True)
            _draw_arm(panel, alone["outline"], colors[pull["method"]])
            _draw_ball(panel, (place * length, 0.0))
            _frame_arms(panel, shown)
            panel.set_title(f"{pull['method']}: {_outcome(pull['method'], alone)}", fontsize=10)
    figure.suptitle(
        "A straight arm (grey) pulled inwards along its own line (Welman, fig. 4.2): each method alone (solid), "
        "pinik.solve (dashed)"
    )
    return figure


def _outcome(method: str, alone: Answer) -> str:
    if alone["status"] == "CONVERGED":
        return f"there in {alone['iterations']} {iteration_word(method)}"
    return f"stuck {alone['position_error_m']:.2g} m off"


def draw_spread(answer: Answer) -> Figure:
    """Each joint's share of the motion, without and with stiffness weights."""
    from matplotlib.figure import Figure

    colors = method_colors(dict.fromkeys(own["method"] for own in answer["spread"]))
    figure = Figure(figsize=(3.0 * len(colors), 3.6), layout="constrained")
    panels = figure.subplots(1, len(colors), sharey=True, squeeze=False)[0]
    numbers = np.arange(1, answer["joints"] + 1)
    for panel, (method, color) in zip(panels, colors.items(), strict=True):
        own = {bool(one["stiffness"]): one for one in answer["spread"] if one["method"] == method}
        panel.bar(numbers - 0.2, _shares(own[False]), 0.4, color=color, label="without weights")
        if True in own:
            label = "stiffer towards the tip"
            panel.bar(numbers + 0.2, _shares(own[True]), 0.4, edgecolor=color, fill=False, hatch="////", label=label)
        panel.axhline(100.0 / len(numbers), color=_INK, linewidth=0.7, linestyle=":")
        panel.set_title(f"{method}: {' → '.join(_worth(own[key]) for key in sorted(own))} joints' worth", fontsize=10)
        panel.set_xlabel("joint, base first")
        panel.set_xticks(numbers)
        _without_box(panel)
    panels[0].set_ylabel("share of the motion [%]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    figure.suptitle(
        f"{answer['robot']}: which joints move when the tip is dragged aside by a fifth of the length (Welman, §4.3)"
    )
    return figure


def _shares(own: Answer) -> Any:
    """Each joint's share in percent; 0 if no problem was solved."""
    return 100.0 * np.array(own["shares"] or 0.0)


def _worth(own: Answer) -> str:
    return "none solved" if own["moving_joints"] is None else f"{own['moving_joints']:.1f}"


def _draw_arm(
    panel: Axes, outline: Sequence[Sequence[float]], color: str, width: float = 2.0, dashed: bool = False
) -> None:
    points = np.array(outline)
    panel.plot(
        *points.T, color=color, linewidth=width, linestyle="--" if dashed else "-", marker="o", markersize=1.8 * width,
        alpha=0.6 if dashed else 1.0, solid_capstyle="round",
    )  # fmt: skip


def _draw_ball(panel: Axes, position: Sequence[float]) -> None:
    panel.plot(*position[:2], "o", color=_BALL, markersize=9, markeredgecolor="white", zorder=5)


def _frame_arms(panel: Axes, outlines: Sequence[Sequence[Sequence[float]]]) -> None:
    """Give the panel equal scales, room for all arms, and no axes."""
    points = np.vstack([np.array(outline) for outline in outlines])
    margin = 0.08 * float(np.ptp(points, axis=0).max())
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    panel.set_xlim(low[0], high[0])
    panel.set_ylim(low[1], high[1])
    panel.set_aspect("equal")
    panel.axis("off")


def _scale_by_powers(panel: Axes) -> None:
    """Give the panel a logarithmic scale from one power of ten to another, labelled with plain numbers."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    panel.set_yscale("log")
    low, high = panel.get_ylim()
    panel.set_ylim(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(high)))
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))
    panel.yaxis.set_minor_formatter(NullFormatter())


def _without_box(panel: Axes) -> None:
    panel.spines[["top", "right"]].set_visible(False)
