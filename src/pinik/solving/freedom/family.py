"""A family of curves of solutions: those that cross at singular places, where motion can go over to another one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .dimension import places_beside
from .solution_set import TURN, Place, SolutionSet
from .tracing import trace

__all__ = ["Family"]

Array = NDArray[np.float64]

_MOST = 16
"""The largest number of curves of a family that are traced."""

_SAME = 1e-3  # [rad]: a place nearer to a curve than this is on it


class Family:
    """The curve of solutions through a place, and all that cross it or each other at singular places.

    Attributes:
        solutions: The set that they belong to.
        curves: The curves, that through the place first.
        complete: Whether all of them are known, each as a whole.
    """

    def __init__(self, solutions: SolutionSet, place: Place) -> None:
        """Trace the curve through a place that is not singular, and from its crossings the others."""
        self.solutions, self.curves = solutions, [trace(solutions, place)]
        for curve in self.curves:
            for crossing in curve.crossings:
                self._trace_from(curve.points(np.array([crossing.at]))[0][0])
        self.complete = (
            solutions.shows_crossings
            and len(self.curves) < _MOST
            and not any("long" in curve.ends for curve in self.curves)
        )

    def _trace_from(self, crossing: Array) -> None:
        """Trace the curves through a singular place (nq,) that are not known yet."""
        for place in places_beside(self.solutions, crossing, self.solutions.rank - 1):
            if len(self.curves) < _MOST and not self.reaches(place.q, _SAME):
                self.curves.append(trace(self.solutions, place))

    def reaches(self, q: Array, within: float) -> bool:
        """Whether a configuration (nq,) is on one of the curves, up to whole turns and a distance."""
        return any(curve.nearest(q)[0] <= within for curve in self.curves)

    @property
    def length(self) -> float:
        """The arc length of all curves [rad]."""
        return sum(curve.length for curve in self.curves)

    @property
    def whole_turns(self) -> dict[str, int]:
        """Joint → how many whole turns it makes while the first curve comes round once, for those that do."""
        curve, solutions = self.curves[0], self.solutions
        if not curve.closed:
            return {}
        columns = {int(v): column for column, v in enumerate(solutions.free)}
        turns = {
            joint.name: round(float(curve.motion[columns[joint.idx_v]]) / TURN)
            for joint in solutions.question.robot.joints
            if joint.has_one_axis and joint.kind != "prismatic" and joint.nv and joint.idx_v in columns
        }
        return {name: count for name, count in turns.items() if count}
