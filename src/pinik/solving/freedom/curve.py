"""A curve of configurations: knots, with cubics between them that have the curve's own tangents at both ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .solution_set import SolutionSet

__all__ = ["Crossing", "Curve", "Knots"]

Array = NDArray[np.float64]

# Gauss and Legendre's rule of four points on 0..1, in closed form: numpy.polynomial would be slow to import.
_INNER, _OUTER = np.sqrt(3.0 / 7.0 + np.array([-2.0, 2.0]) / 7.0 * np.sqrt(1.2))
_NODES = 0.5 + 0.5 * np.array([-_OUTER, -_INNER, _INNER, _OUTER])
_WEIGHTS = 0.25 + np.sqrt(30.0) / 72.0 * np.array([-1.0, 1.0, 1.0, -1.0])
_FINE = np.linspace(0.0, 1.0, 17)


@dataclass(frozen=True)
class Crossing:
    """A singular place on a curve, where the kernel of the Jacobian grows.

    Attributes:
        at: Where it is, in arc length from the first knot.
        conditioning: The smallest singular value that is not 0 beside it, divided by the largest.
    """

    at: float
    conditioning: float


@dataclass(frozen=True, eq=False)
class Knots:
    """Points of a curve in order, before their distances are known.

    Attributes:
        q: The configurations (K, nq).
        tangents: The unit tangents (K, n), all pointing forward.
        crossings: (knot, part, conditioning) of each singular place: it lies that part of the way from this knot to the
            next one.
        why: Why they end: "closed", "singular" or "long".
    """

    q: list[Array]
    tangents: list[Array]
    crossings: list[tuple[int, float, float]]
    why: str

    def after(self, other: Knots) -> Knots:
        """The knots of the curve that goes from the end of the other one, backwards, to the end of this one."""
        count = len(other.q) - 1
        crossings = [(count - 1 - k, 1.0 - part, sigma) for k, part, sigma in reversed(other.crossings)]
        return Knots(
            [*other.q[:0:-1], *self.q],
            [*(-tangent for tangent in other.tangents[:0:-1]), *self.tangents],
            crossings + [(k + count, part, sigma) for k, part, sigma in self.crossings],
            self.why,
        )


class Curve:
    """A curve through knots, measured by its arc length from the first of them.

    Attributes:
        solutions: The set that it belongs to.
        q: The knots (K + 1, nq).
        begins: The arc length at each knot (K + 1,).
        length: The arc length of the whole curve.
        closed: Whether it comes back to its first knot, up to whole turns.
        turns: What a closed curve adds to the entries of q (nq,) when it comes back: multiples of 2π for hinges.
        crossings: The singular places on it.
        start: The arc length of the point that it was traced from.
        ends: Why an open curve ends at each end: "singular" or "long".
    """

    def __init__(self, solutions: SolutionSet, knots: Knots, start: int, ends: tuple[str, str]) -> None:
        """Lay cubics through the knots.

        Args:
            solutions: The set that it belongs to.
            knots: The knots; those of a closed curve end where they begin, up to whole turns.
            start: The index of the knot that it was traced from.
            ends: Why it ends at each end, "closed" twice for a closed curve.
        """
        self.solutions, self.ends = solutions, ends
        self.q, self._tangents = np.array(knots.q), np.array(knots.tangents)
        self._chords = np.array([solutions.difference(a, b) for a, b in zip(self.q[:-1], self.q[1:], strict=True)])
        self._lengths = np.linalg.norm(self._chords, axis=1)
        for _ in range(2):  # a cubic of unit speed has its own length as the length of its end tangents
            self._lengths = self._gone(np.arange(len(self._chords)), np.ones(len(self._chords)))
        self.begins = np.concatenate(([0.0], np.cumsum(self._lengths)))
        self.length, self.start = float(self.begins[-1]), float(self.begins[start])
        self.closed = ends == ("closed", "closed")
        self.turns = np.zeros(self.q.shape[1])
        if self.closed:
            entries = solutions.question.limits.turning
            self.turns[entries] = (self.q[-1] - self.q[0])[entries]
        self.crossings = [Crossing(self._at(k, part), sigma) for k, part, sigma in knots.crossings]

    def _gone(self, k: NDArray[np.intp], u: Array) -> Array:
        """The arc lengths (N,) from knots k to parts u of the way to the next ones."""
        lengths = np.zeros(len(k))
        for node, weight in zip(_NODES, _WEIGHTS, strict=True):
            lengths += weight * u * np.linalg.norm(self._motions(k, node * u)[1], axis=1)
        return lengths

    def _motions(self, k: NDArray[np.intp], u: Array) -> tuple[Array, Array]:
        """The motions (N, n) from knots k to parts u of the way to the next ones, and their derivatives by u."""
        u = u[:, np.newaxis]
        first, last = (self._lengths[k, np.newaxis] * self._tangents[k + j] for j in (0, 1))
        chords = self._chords[k]
        motions = u * (1 - u) ** 2 * first + u * u * (3 - 2 * u) * chords + u * u * (u - 1) * last
        slopes = (1 - u) * (1 - 3 * u) * first + 6 * u * (1 - u) * chords + u * (3 * u - 2) * last
        return motions, slopes

    def _found(self, s: Array) -> tuple[NDArray[np.intp], Array, Array]:
        """For arc lengths (N,): the knots before them, the parts of the way to the next ones, and the periods."""
        periods = np.floor(s / self.length) if self.closed else np.zeros(len(s))
        s = s - periods * self.length
        k = np.clip(np.searchsorted(self.begins, s, side="right") - 1, 0, len(self._chords) - 1)
        gone = s - self.begins[k]
        u = gone / self._lengths[k]
        u -= (self._gone(k, u) - gone) / self._lengths[k]  # the speed along a cubic varies a little
        return k, u, periods

    def points(self, s: Array) -> tuple[Array, Array]:
        """Configurations (N, nq) near the curve at arc lengths (N,), and the directions of the curve there (N, n).

        A closed curve goes on beyond its ends, with the hinges that have made a whole turn turned on.
        """
        k, u, periods = self._found(s)
        motions, slopes = self._motions(k, u)
        q = np.array([self.solutions.step(self.q[i], motion) for i, motion in zip(k, motions, strict=True)])
        q = q.reshape(len(s), self.q.shape[1])
        return q + periods[:, np.newaxis] * self.turns, slopes / np.linalg.norm(slopes, axis=1)[:, np.newaxis]

    def levels(self, entry: int, column: int, level: float) -> list[float]:
        """The arc lengths within one period at which an entry of q passes or touches a value."""
        scale, values = self.solutions.scales[column], self.q[:, entry] - level
        first, last = (self._lengths * self._tangents[j : j + len(self._chords), column] / scale for j in (0, 1))
        control = np.array([values[:-1], values[:-1] + first / 3, values[1:] - last / 3, values[1:]])
        chords = values[1:] - values[:-1]
        found = []
        for k in np.flatnonzero((control.min(axis=0) <= 0.0) & (control.max(axis=0) >= 0.0)):
            cubic = [first[k] + last[k] - 2 * chords[k], 3 * chords[k] - 2 * first[k] - last[k], first[k], values[k]]
            roots = np.roots(cubic)
            real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0.0) & (roots.real <= 1.0)]
            found += [self._at(int(k), float(u)) for u in real]
        return found

    def _at(self, k: int, u: float) -> float:
        """The arc length at a part u of the way from knot k to the next one."""
        return float(self.begins[k] + self._gone(np.array([k]), np.array([u]))[0])

    def nearest(self, q: Array) -> tuple[float, float]:
        """The distance of a configuration (nq,) from the curve, up to whole turns, and the arc length nearest to it."""
        solutions = self.solutions
        near = solutions.turned(np.broadcast_to(q, self.q.shape), self.q)
        away = np.array([solutions.difference(knot, other) for knot, other in zip(self.q, near, strict=True)])
        distances = np.linalg.norm(away, axis=1)
        k = np.flatnonzero(np.minimum(distances[:-1], distances[1:]) - self._lengths <= distances.min())
        low, high = np.zeros(len(k)), np.ones(len(k))
        for _ in range(3):  # each grid is within one step of the nearest point of the last
            parts = low + (high - low) * _FINE[:, np.newaxis]
            motions, _ = self._motions(np.tile(k, len(parts)), parts.ravel())
            gaps = np.linalg.norm(motions.reshape(*parts.shape, -1) - away[k], axis=2)
            best = gaps.argmin(axis=0)
            column = np.arange(len(k))
            low, high = parts[np.maximum(best - 1, 0), column], parts[np.minimum(best + 1, len(parts) - 1), column]
        chosen = int(gaps.min(axis=0).argmin())
        return float(gaps[best[chosen], chosen]), self._at(int(k[chosen]), float(parts[best[chosen], chosen]))

    @property
    def motion(self) -> Array:
        """The motion (n,) from its first configuration to its last one, in the joint metric: whole turns if closed."""
        return np.asarray(self._chords.sum(axis=0))
