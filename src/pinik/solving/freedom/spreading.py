"""Configurations spread over a set of solutions of two or more dimensions, by a tree that grows over it.

The tree grows from one configuration towards points of a low-discrepancy sequence in the joints' ranges, each time from
its nearest configuration, by steps along the tangents and back onto the set (Jaillet and Porta 2013). Of its
configurations those are taken that are farthest from each other, one after the other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .settling import hold_at_limits
from .solution_set import EXACT, TURN, Place, SolutionSet

__all__ = ["Tree"]

Array = NDArray[np.float64]

_STEP = 0.3  # [rad]: the longest step of the tree
_STEPS = 6  # the largest number of steps towards one goal
_GOALS = 3  # goals at most for each configuration of the tree
_PATIENCE, _SHRINKING = 10, 0.7  # after so many goals without a new configuration the distance shrinks
_ARRIVED = 0.01  # [rad]: a way that comes this near to a place of the set has come there
_SHORTEST = 1e-3  # [rad]: a shorter step towards a goal is not worth taking


class Tree:
    """A tree of configurations that grows over a set of solutions, inside the limits.

    Attributes:
        places: Its configurations, the root first.
        tangents: Orthonormal bases (n − r, n) of the tangents at each of them.
    """

    def __init__(self, solutions: SolutionSet, root: Place, seed: int) -> None:
        """Plant the tree; `seed` shifts the sequence of its goals."""
        self._solutions, self._limits = solutions, solutions.question.limits
        robot = solutions.question.robot
        self._one_axis = [joint for joint in robot.joints if joint.has_one_axis and joint.nv]
        self._one_axis = [joint for joint in self._one_axis if joint.idx_v in solutions.free]
        of_one_axis = [joint.idx_v for joint in self._one_axis]
        self._others = [column for column, v in enumerate(solutions.free.tolist()) if v not in of_one_axis]
        self._goals = _Sequence(solutions.n, seed)
        self._slides = np.ones(len(root.q))
        for joint in self._one_axis:
            if joint.kind == "prismatic":
                self._slides[joint.idx_q] = solutions.scales[solutions.free.tolist().index(joint.idx_v)]
        self._apart = _STEP
        self.places, self.tangents = [root], [solutions.kernel(root)]
        self._points = self._embedded(root.q)[np.newaxis]

    def _embedded(self, q: Array) -> Array:
        """A configuration as a point, in which hinges are on circles, so that whole turns do not count."""
        turning = self._limits.turning
        angles = q[turning]
        return np.concatenate((np.cos(angles), np.sin(angles), (q * self._slides)[~turning]))

    def _goal(self, near: Array) -> Array:
        """The next point of the sequence, as a configuration (nq,)."""
        fractions, goal = self._goals.next(), near.copy()
        for joint, fraction in zip(self._one_axis, fractions, strict=False):
            low, high = joint.range_to_draw_from(
                float(self._limits.lower[joint.idx_q]), float(self._limits.upper[joint.idx_q]), float(near[joint.idx_q])
            )
            joint.set_angle(goal, low + float(fraction) * (high - low))
        if not self._others:
            return goal
        motion = np.zeros(self._solutions.n)
        motion[self._others] = TURN * (fractions[len(self._one_axis) :] - 0.5)
        return self._solutions.step(goal, motion)

    def grow(self, count: int) -> None:
        """Grow until there are `count` configurations, or three times as many goals have been tried.

        New configurations keep a distance from all others, which shrinks where no more of them are found.
        """
        failures = 0
        for _ in range(_GOALS * count):
            if len(self.places) >= count:
                return
            failures = 0 if self._grow_towards(self._goal(self.places[0].q)) else failures + 1
            if failures > _PATIENCE:
                self._apart, failures = _SHRINKING * self._apart, 0

    def _grow_towards(self, goal: Array) -> bool:
        """Grow by steps towards a goal, and return whether a new configuration was found."""
        k, grew = self._nearest(goal), False
        place, tangents = self.places[k], self.tangents[k]
        for _ in range(_STEPS):
            grown = self._towards(place.q, tangents, goal)
            if grown is None:
                break
            point = self._embedded(grown.q)
            if np.square(self._points - point).sum(axis=1).min() < self._apart**2:
                break
            place, tangents, grew = grown, self._solutions.kernel(grown), True
            self.places.append(place)
            self.tangents.append(tangents)
            self._points = np.vstack((self._points, point))
        return grew

    def _nearest(self, q: Array) -> int:
        """The index of the configuration nearest to another one (nq,)."""
        return int(np.square(self._points - self._embedded(q)).sum(axis=1).argmin())

    def _towards(self, q: Array, tangents: Array, goal: Array) -> Place | None:
        """A point of the set by one step from a configuration towards a goal; None if there is none."""
        solutions = self._solutions
        asked = solutions.difference(q, solutions.turned(goal, q))
        motion = tangents.T @ (tangents @ asked)
        length = float(np.linalg.norm(motion))
        if length < _SHORTEST:
            return None
        motion *= min(_STEP / length, 1.0)
        place = solutions.project(solutions.step(q, motion), tangents)
        if place is not None and not self._limits.contains(place.q):
            place = hold_at_limits(solutions, place.q, tangents)
        if place is None or place.miss > EXACT or not self._limits.contains(place.q):
            return None
        went = float(np.linalg.norm(solutions.difference(q, place.q)))
        return place if _SHORTEST < went < 1.5 * _STEP else None

    def farthest(self, count: int) -> tuple[list[int], float]:
        """The indices of `count` configurations far from each other, the root first, and the gap between them.

        The gap is the distance [rad] from the configuration of the tree that is farthest from all of them to the
        nearest of them.
        """
        chosen, away = [0], np.full(len(self.places), np.inf)
        while True:
            away = np.minimum(away, np.linalg.norm(self._points - self._points[chosen[-1]], axis=1))
            farthest = int(away.argmax())
            if len(chosen) == count or away[farthest] == 0.0:
                return chosen, self._gap(farthest, chosen)
            chosen.append(farthest)

    def _gap(self, k: int, chosen: list[int]) -> float:
        nearest = chosen[int(np.linalg.norm(self._points[chosen] - self._points[k], axis=1).argmin())]
        a, b, solutions = self.places[nearest].q, self.places[k].q, self._solutions
        return float(np.linalg.norm(solutions.difference(a, solutions.turned(b, a))))

    def reaches(self, q: Array, within: float) -> bool:
        """Whether a configuration (nq,) is near the set, and steps from the nearest known one lead there."""
        solutions, k = self._solutions, self._nearest(q)
        goal = solutions.slide(q)
        if goal is None or np.linalg.norm(solutions.difference(q, goal.q)) > within:
            return False
        place, tangents, last = self.places[k], self.tangents[k], np.inf
        while True:
            near = solutions.turned(goal.q, place.q)
            left = float(np.linalg.norm(solutions.difference(place.q, near)))
            if left <= _ARRIVED:
                return True
            onward = self._towards(place.q, tangents, near) if left < 0.99 * last else None
            if onward is None:
                return False
            place, tangents, last = onward, solutions.kernel(onward), left


class _Sequence:
    """A low-discrepancy sequence in the unit cube: the multiples of one vector, modulo 1 (Roberts 2018)."""

    def __init__(self, dimension: int, seed: int) -> None:
        ratio = 2.0
        for _ in range(40):  # the positive root of x^(d + 1) = x + 1
            ratio = (1.0 + ratio) ** (1.0 / (dimension + 1))
        self._steps = ratio ** -np.arange(1.0, dimension + 1.0)
        self._at = seed % 2**20

    def next(self) -> Array:
        """The next point."""
        self._at += 1
        return np.asarray((0.5 + self._at * self._steps) % 1.0)
