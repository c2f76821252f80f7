"""One part of a survey by samples: random configurations, and where the frame is at them."""

from __future__ import annotations

import numpy as np

from ..scale.jobs.job import Pause, never_pause
from .counts import Counts
from .measures import manipulabilities, rooms
from .survey import Survey

__all__ = ["sample_part"]

_AT_ONCE = 2**14  # so that what is computed of them stays in the processor's cache


def sample_part(survey: Survey, part: int, pause: Pause = never_pause) -> Counts:
    """Draw the samples of a part, and count in which cells and orientations they are."""
    guard = survey.options.avoid.guard(survey.robot, survey.options.engine)
    asked = np.zeros(len(survey.grid) + 1, dtype=bool)  # the last is for places outside the grid
    asked[survey.asked] = True
    size = survey.part_size
    end = min((part + 1) * size, survey.samples)
    found = []
    for first in range(part * size, end, _AT_ONCE):
        pause()
        q = survey.sampler.configurations(first, min(_AT_ONCE, end - first))
        if guard is not None:
            q = q[~guard.checker.touches(q)]
        places = survey.sampler.placements(q)
        cells = survey.grid.cells_at(places[:, :3, 3])
        inside = asked[cells]
        q, places = q[inside], places[inside]
        turns = survey.orientations.regions_of(places[:, :3, :3])
        manipulability = manipulabilities(survey.sampler, q, survey.rows) / survey.unit
        found.append((cells[inside], turns, manipulability, rooms(survey.sampler, q)))
    cells, turns, manipulability, room = (np.concatenate(columns) for columns in zip(*found, strict=True))
    touched, rows = np.unique(cells, return_inverse=True)
    counts = Counts.empty(touched, len(survey.orientations))
    counts.add(rows, turns, manipulability, room)
    return counts
