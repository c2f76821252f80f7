"""The joint metric: how far joint motions count, with radians and metres in one measure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..problem.problem import Problem

__all__ = ["joint_scales"]


def joint_scales(problem: Problem) -> NDArray[np.float64]:
    """The factors (nv,) on tangent coordinates: 1 for radians, and 1 per length of the chain for metres."""
    scales = np.ones(problem.model.nv)
    for coordinate in problem.coordinates:
        if coordinate.slides:
            scales[coordinate.joint.idx_v + coordinate.index] = 1.0 / problem.size_of_chain
    return scales
