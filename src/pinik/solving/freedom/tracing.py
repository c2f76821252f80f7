"""The tracing of a curve of solutions: a step along the tangent, and back onto the curve.

The predictor is of second order, from the last two tangents; the corrector makes Newton steps across the tangent. The
step is as long as the curve's bending allows (Allgower and Georg 1990, chapters 2 to 6). The determinant of the
Jacobian with the tangent below it changes its sign where the curve is crossed by another one. A change that remains
however short the step is shows such a singular place; one that does not shows a step onto another branch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .curve import Curve, Knots
from .solution_set import Place, SolutionSet

__all__ = ["LONGEST", "trace"]

Array = NDArray[np.float64]

LONGEST = 200.0
"""The arc length after which a curve that does not close is given up, in each direction [rad]."""

_FIRST, _WIDEST, _SHORTEST = 0.05, 0.3, 2e-4  # steps [rad]
_CROSSING = 5e-3  # the step across a singular place [rad]
_BEND, _SHARPEST = 0.15, 0.3  # [rad]: how far the tangent turns in a step, as intended and at most

_MOST = 10_000  # knots in one direction
_SAME = 1e-6  # [rad]: how far the first point may be beside the curve that has come back to it


class _Knot(NamedTuple):
    """A point of the curve, its unit tangent (n,), and the determinant of the Jacobian with the tangent below it."""

    place: Place
    tangent: Array
    volume: float


def trace(solutions: SolutionSet, start: Place) -> Curve:
    """Trace the whole curve through a point, limits or not.

    Args:
        solutions: A set of dimension one at that point.
        start: The point; not a singular place.
    """
    tangent = solutions.kernel(start)[0]
    ahead = _Tracer(solutions, start, tangent).run()
    if ahead.why == "closed":
        return Curve(solutions, ahead, 0, ("closed", "closed"))
    behind = _Tracer(solutions, start, -tangent).run()
    return Curve(solutions, ahead.after(behind), len(behind.q) - 1, (behind.why, ahead.why))


class _Tracer:
    """Goes along the curve in one direction."""

    def __init__(self, solutions: SolutionSet, start: Place, tangent: Array) -> None:
        self._solutions = solutions
        self._first = _Knot(start, tangent, self._volume(start, tangent))
        self._knots = Knots([start.q], [tangent], [], "long")

    def run(self) -> Knots:
        """Go on until the curve closes, ends or is too long."""
        knot, before, last = self._first, None, 0.0
        gone, step = 0.0, _FIRST
        while gone < LONGEST and len(self._knots.q) < _MOST:
            found = self._advance(knot, before, step, last)
            if found is not None and self._flips(knot, found):
                found = None
            if found is None and step > _SHORTEST:
                step *= 0.25
                continue
            if found is None:
                step = _CROSSING
                found = self._advance(knot, before, step, last)
                if found is None:
                    return self._ended("singular")
                if self._flips(knot, found):
                    self._note_crossing(knot, found)
            if self._closes(knot, found, step):
                self._add(self._solutions.turned(self._first.place.q, found.place.q), self._first.tangent)
                return self._ended("closed")
            self._add(found.place.q, found.tangent)
            bend = math.acos(min(float(knot.tangent.dot(found.tangent)), 1.0))
            knot, before, last = found, knot.tangent, step
            gone += step
            step = min(step * min(max(_BEND / max(bend, 1e-9), 0.5), 2.0), _WIDEST)
        return self._knots

    def _add(self, q: Array, tangent: Array) -> None:
        self._knots.q.append(q)
        self._knots.tangents.append(tangent)

    def _ended(self, why: str) -> Knots:
        return Knots(self._knots.q, self._knots.tangents, self._knots.crossings, why)

    def _advance(self, knot: _Knot, before: Array | None, step: float, last: float) -> _Knot | None:
        """The point a step further; None if there is none, or it is not certainly on the same branch."""
        solutions, tangent = self._solutions, knot.tangent
        ahead = step * tangent
        if before is not None:
            ahead = ahead + (step * step / (2.0 * last)) * (tangent - before)
        across = tangent[np.newaxis]
        place = solutions.project(solutions.step(knot.place.q, ahead), across)
        if place is None:
            return None
        gone = solutions.difference(knot.place.q, place.q)
        if not 0.5 * step < gone.dot(tangent) or not math.sqrt(gone.dot(gone)) < 1.5 * step:
            return None
        try:
            onward = solutions.tangent(place, tangent)
        except np.linalg.LinAlgError:
            return None
        if onward.dot(tangent) < math.cos(_SHARPEST):
            return None
        return _Knot(place, onward, self._volume(place, onward))

    @staticmethod
    def _volume(place: Place, tangent: Array) -> float:
        return float(np.linalg.det(np.vstack((place.J, tangent))))

    def _flips(self, a: _Knot, b: _Knot) -> bool:
        """Whether the determinant changes its sign, for the same orientation of the rows."""
        if not self._solutions.shows_crossings:
            return False
        sign = a.volume * b.volume
        if a.place.rows is not None and b.place.rows is not None:
            sign *= float(np.linalg.det(a.place.rows @ b.place.rows.T))
        return sign < 0.0

    def _note_crossing(self, a: _Knot, b: _Knot) -> None:
        part = abs(a.volume) / (abs(a.volume) + abs(b.volume))
        sigma = self._solutions.singular_values(a.place.q)
        conditioning = float(sigma[self._solutions.rank - 1] / sigma[0])
        self._knots.crossings.append((len(self._knots.q) - 1, part, conditioning))

    def _closes(self, knot: _Knot, found: _Knot, step: float) -> bool:
        """Whether the first point of all lies on the way from one knot to the next."""
        if len(self._knots.q) < 2:
            return False
        solutions, first = self._solutions, self._first
        near = solutions.turned(first.place.q, found.place.q)
        left, right = solutions.difference(knot.place.q, near), solutions.difference(found.place.q, near)
        if not left.dot(first.tangent) > 0.0 >= right.dot(first.tangent):
            return False
        if max(left.dot(left), right.dot(right)) > (1.5 * step) ** 2 or found.tangent.dot(first.tangent) < 0.5:
            return False
        way = Curve(solutions, Knots([knot.place.q, found.place.q], [knot.tangent, found.tangent], [], ""), 0, ("", ""))
        q, tangents = way.points(np.array([way.nearest(near)[1]]))
        passed = solutions.project(q[0], tangents)
        if passed is None:
            return False
        beside = solutions.difference(passed.q, near)
        beside -= beside.dot(tangents[0]) * tangents[0]
        return math.sqrt(beside.dot(beside)) <= _SAME
