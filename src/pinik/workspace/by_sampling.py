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
    counts = survey.empty()
    row_of = np.full(len(survey.grid) + 1, -1, dtype=np.int64)  # the last is for places outside the grid
    row_of[counts.cells] = np.arange(len(counts.cells))
    guard = survey.options.avoid.guard(survey.robot, survey.options.engine)
    size = survey.samples_of_a_part
    end = min((part + 1) * size, survey.samples)
    for first in range(part * size, end, _AT_ONCE):
        pause()
        q = survey.sampler.configurations(first, min(_AT_ONCE, end - first))
        if guard is not None:
            q = q[~guard.checker.touches(q)]
        places = survey.sampler.placements(q)
        rows = row_of[survey.grid.cells_at(places[:, :3, 3])]
        inside = rows >= 0
        q, places, rows = q[inside], places[inside], rows[inside]
        counts.add(
            rows,
            survey.orientations.regions_of(places[:, :3, :3]),
            manipulabilities(survey.sampler, q, survey.rows) / survey.unit,
            rooms(survey.sampler, q),
        )
    return counts.touched()
