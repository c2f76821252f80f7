"""Two hinges in a plane, with ranges, for any number of points: both elbows, and the nearest that the ranges leave."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .two_bone import ELBOWS, elbow_angles

__all__ = ["ROUNDING", "PlanarArm", "Turns", "turn"]

ROUNDING = 1e-12
"""Of the lengths that enter; and [rad] of an angle at the end of its range."""

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]


class Turns(NamedTuple):
    """Angles brought near to where joints stand, and into their ranges.

    Attributes:
        angle: The equal angle nearest to where the joint stands [rad].
        inside: One inside the range: an equal angle, the nearest to where the joint stands; or the end of the range
            that is nearest to one [rad].
        fits: Whether it is an equal one, but for rounding.
    """

    angle: Array
    inside: Array
    fits: Truths


@dataclass(frozen=True)
class PlanarArm:
    r"""The tip is at $l_1 (\cos\theta_1, \sin\theta_1) + l_2 (\cos(\theta_1 + \theta_2), \sin(\theta_1 + \theta_2))$,
    and the joints' values are $q_1 = \theta_1$ and $q_2 = \sigma(\theta_2 - \gamma)$.

    Attributes:
        l1, l2: The bones' lengths [m].
        bend: γ [rad].
        sense: σ, 1 or −1.
    """

    l1: float
    l2: float
    bend: float = 0.0
    sense: float = 1.0

    def joint_angles(self, angles: ArrayLike) -> Array:
        """(q₁, q₂) for (θ₁, θ₂) [rad]: (…, 2) from (…, 2)."""
        values = np.array(angles, dtype=np.float64)
        values[..., 1] = self.sense * (values[..., 1] - self.bend)
        return values

    def elbows(self, points: Array, now: Array, slack: Array) -> tuple[Array, Array]:
        """Both answers of `two_bone`, up first, ranges aside.

        A point within `slack` (N,) [m] of the base leaves the first joint free, and it stays where it is.

        Args:
            points: Where the tips should be (N, 2) [m].
            now: Where the joints stand (N, 2) [rad].
            slack: (N,) [m].

        Returns:
            The joints' values (N, 2 elbows, 2) [rad], and what both tips then miss their point by (N,) [m].
        """
        x, y = points.T
        distance = np.hypot(x, y)
        at_base = distance <= slack
        distance[at_base] = 0.0
        angles, outside = elbow_angles(self.l1, self.l2, np.arctan2(y, x), distance)
        values = self.joint_angles(angles)
        values[at_base, :, 0] = now[at_base, :1]
        return values, np.maximum(outside, 0.0)

    def nearest(self, points: Array, now: Array, ranges: Array, slack: Array, elbow: str) -> Array:
        """The joints' values (N, 2) inside their ranges [rad] that bring the tips nearest to their points.

        Where the minimum lies inside, it is one of the two elbows; else one joint is at an end of its range, and the
        other one turns as near to the point as it may. Of equally near ones `elbow` is taken, and of these the nearest
        to `now`.

        Args:
            points, now, slack: As for `elbows`.
            ranges: The joints' lowest and highest values (N, 2 joints, 2) [rad], infinite where there are none.
            elbow: "up", "down", or anything else for neither.
        """
        ways, _ = self.elbows(points, now, slack)
        turns = turn(ways, ranges[:, np.newaxis], now[:, np.newaxis])
        fit: Truths = np.all(turns.fits, axis=-1)
        nearest = self._chosen(turns.inside, fit, now, elbow)
        left = np.flatnonzero(~fit.any(axis=1))
        if len(left):
            ways, missed = self._at_ends(points[left], now[left], ranges[left], slack[left])
            least = missed.min(axis=1, keepdims=True) + ROUNDING * (self.l1 + self.l2)
            nearest[left] = self._chosen(ways, missed <= least, now[left], elbow)
        return nearest

    def _chosen(self, ways: Array, allowed: Truths, now: Array, elbow: str) -> Array:
        """Of the ways (N, k, 2) that are allowed (N, k): with that elbow, where one has it, the nearest to `now`."""
        if elbow in ELBOWS:
            down = np.sin(self.sense * ways[..., 1] + self.bend) >= 0.0
            wanted = allowed & (down == (elbow == "down"))
            allowed = np.where(wanted.any(axis=1, keepdims=True), wanted, allowed)
        off = ways - now[:, np.newaxis]
        best = np.where(allowed, np.hypot(off[..., 0], off[..., 1]), np.inf).argmin(axis=1)
        return np.asarray(ways[np.arange(len(ways)), best])

    def _at_ends(self, points: Array, now: Array, ranges: Array, slack: Array) -> tuple[Array, Array]:
        """With one joint at an end of its range, the other as near to the point as it may (N, 4, 2), and what that
        misses (N, 4) [m], infinite where there is no such end."""
        x, y = points[:, :1], points[:, 1:]
        finite = np.isfinite(ranges)
        first, second = np.moveaxis(np.where(finite, ranges, 0.0), 1, 0)  # (N, 2 ends) each
        ways = np.empty((len(points), 4, 2))
        direction = np.arctan2(y - self.l1 * np.sin(first), x - self.l1 * np.cos(first))
        wanted = self.sense * (direction - first - self.bend)
        ways[:, :2, 0], ways[:, :2, 1] = first, turn(wanted, ranges[:, 1:], now[:, 1:]).inside
        straight = self._tip(np.stack([np.zeros_like(second), second], axis=-1))
        wanted = np.arctan2(y, x) - np.arctan2(straight[..., 1], straight[..., 0])
        wanted = np.where(np.hypot(x, y) <= slack[:, np.newaxis], now[:, :1], wanted)
        ways[:, 2:, 0], ways[:, 2:, 1] = turn(wanted, ranges[:, :1], now[:, :1]).inside, second
        off = self._tip(ways) - points[:, np.newaxis]
        return ways, np.where(finite.reshape(-1, 4), np.hypot(off[..., 0], off[..., 1]), np.inf)

    def _tip(self, values: Array) -> Array:
        """Where the tip is (…, 2) [m] for the joints' values (…, 2) [rad]."""
        first = values[..., 0]
        both = first + self.sense * values[..., 1] + self.bend
        x = self.l1 * np.cos(first) + self.l2 * np.cos(both)
        return np.stack([x, self.l1 * np.sin(first) + self.l2 * np.sin(both)], axis=-1)


def turn(wanted: Array, ranges: Array, now: Array) -> Turns:
    """Hinges' angles turned by whole turns into their ranges (…, 2), near to where they stand `now`; all in rad."""
    low, high = ranges[..., 0], ranges[..., 1]
    angle = now + _within_half_a_turn(wanted - now)
    is_inside: Truths = (low <= angle) & (angle <= high)
    if is_inside.all():
        return Turns(angle, angle, is_inside)
    with np.errstate(invalid="ignore"):  # infinite ends have no multiples, and nothing lies beyond them
        inside = np.where(angle > high, high - (high - angle) % math.tau, angle)
        inside = np.where(angle < low, low + (angle - low) % math.tau, inside)
        gaps = np.abs(_within_half_a_turn(angle[..., np.newaxis] - ranges))
    gaps = np.where(np.isfinite(ranges), gaps, np.inf)
    is_inside = (low <= inside) & (inside <= high)
    end = np.where(gaps[..., 0] <= gaps[..., 1], low, high)
    return Turns(angle, np.where(is_inside, inside, end), is_inside | (gaps.min(axis=-1) <= ROUNDING))


def _within_half_a_turn(angle: Array) -> Array:
    """The equal angle in [−π, π]; nothing is rounded that is there already."""
    rest = np.fmod(angle, math.tau)
    rest = np.where(rest > math.pi, rest - math.tau, rest)
    return np.where(rest < -math.pi, rest + math.tau, rest)
