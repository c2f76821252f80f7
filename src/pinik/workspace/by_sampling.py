"""One part of a plan by samples: random configurations, and where the frame is at them."""

from __future__ import annotations

import numpy as np

from ..scale.jobs.job import Pause, never_pause
from .counts import Counts
from .measures import manipulabilities, rooms
from .plan import Plan

__all__ = ["sample_part"]

_AT_ONCE = 2**14  # so that what is computed of them stays in the processor's cache


def sample_part(plan: Plan, part: int, pause: Pause = never_pause) -> Counts:
    """Draw the samples of a part, and count in which cells and orientations they are."""
    guard = plan.options.avoid.guard(plan.robot, plan.options.engine)
    asked = np.zeros(len(plan.grid) + 1, dtype=bool)  # the last is for places outside the grid
    asked[plan.asked] = True
    size = plan.part_size
    end = min((part + 1) * size, plan.samples)
    found = []
    for first in range(part * size, end, _AT_ONCE):
        pause()
        q = plan.sampler.configurations(first, min(_AT_ONCE, end - first))
        if guard is not None:
            q = q[~guard.checker.touches(q)]
        places = plan.sampler.placements(q)
        cells = plan.grid.cells_at(places[:, :3, 3])
        inside = asked[cells]
        q, places = q[inside], places[inside]
        turns = plan.orientations.regions_of(places[:, :3, :3])
        manipulability = manipulabilities(plan.sampler, q, plan.rows) / plan.unit
        found.append((cells[inside], turns, manipulability, rooms(plan.sampler, q)))
    cells, turns, manipulability, room = (np.concatenate(columns) for columns in zip(*found, strict=True))
    touched, rows = np.unique(cells, return_inverse=True)
    counts = Counts.empty(touched, len(plan.orientations))
    counts.add(rows, turns, manipulability, room)
    return counts
