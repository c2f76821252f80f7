"""Three slices through a map, as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...workspace.colors import ANCHORS
from ...workspace.drawing import quantity_of
from ...workspace.reach_map import ReachMap
from ...workspace.voxel_map import Workspace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_slices"]

_WORDS = {
    "share": "share of the orientations that are reached",
    "manipulability": "mean manipulability",
    "room": "mean distance to the joint limits",
    "branches": "distinct answers for each orientation",
}
_NAMES = "xyz"


def draw_slices(reach: ReachMap, quantity: str = "share", workspace: Workspace = "any") -> Figure:
    """Draw three slices: across z where most is reached, and across y and x in the middle."""
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.figure import Figure

    values, largest = quantity_of(reach, quantity)
    values = np.where(reach.workspace(workspace), values, np.nan)
    axes = reach.grid.axes
    levels = np.nansum(reach.share, axis=(0, 1))
    at = [len(axes[0]) // 2, len(axes[1]) // 2, int(np.argmax(levels))]
    colors = LinearSegmentedColormap.from_list("pinik", ANCHORS)
    figure = Figure(figsize=(14.0, 4.8), layout="constrained")
    half = 0.5 * reach.grid.size
    panels = figure.subplots(1, 3)
    for panel, (across, right, up) in zip(panels, ((2, 0, 1), (1, 0, 2), (0, 1, 2)), strict=True):
        layer = np.take(values, at[across], axis=across).T
        box = [axes[right][0] - half, axes[right][-1] + half, axes[up][0] - half, axes[up][-1] + half]
        panel.imshow(layer, origin="lower", extent=box, vmin=0.0, vmax=largest, cmap=colors)
        panel.set_title(f"{_NAMES[across]} = {axes[across][at[across]]:.3g} m", fontsize=11)
        panel.set_xlabel(f"{_NAMES[right]} [m]")
        panel.set_ylabel(f"{_NAMES[up]} [m]")
        panel.plot(0.0, 0.0, "+", color="#d81f2f", markersize=9, markeredgewidth=1.6)
        for side in ("top", "right"):
            panel.spines[side].set_visible(False)
    figure.colorbar(panels[0].images[0], ax=panels, shrink=0.85, pad=0.01, label=_WORDS[quantity])
    way = f"{reach.samples:,} samples" if reach.samples else "solved cell by cell"
    figure.suptitle(f"Where {reach.frame} of {reach.robot} can be: {way}, cells of {reach.grid.size:g} m")
    return figure
