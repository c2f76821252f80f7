"""Two hinges in a plane, with ranges: both solutions, and the nearest point inside the ranges, for many targets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .two_bone import ELBOWS, elbow_angles

__all__ = ["ROUNDING", "PlanarArm", "Turns", "turn"]

ROUNDING = 1e-12
"""Allowance for rounding: relative to the lengths involved, and in rad for an angle at the end of its range."""

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]


class Turns(NamedTuple):
    """Angles turned by whole turns towards the joints' present values, and into their ranges.

    Attributes:
        angle: The angle, turned as near as possible to the joint's present value [rad].
        inside: The angle, turned into the range and there as near as possible to the present value [rad]; if none of
            its turns lies inside, the nearest end of the range.
        fits: Whether one of its turns lies inside the range, but for rounding.
    """

    angle: Array
    inside: Array
    fits: Truths


@dataclass(frozen=True)
class PlanarArm:
    r"""Two bones in a plane, hinged at the origin and at each other.

    The tip is at $l_1 (\cos\theta_1, \sin\theta_1) + l_2 (\cos(\theta_1 + \theta_2), \sin(\theta_1 + \theta_2))$,
    and the joint angles are $q_1 = \theta_1$ and $q_2 = \sigma(\theta_2 - \gamma)$.

    Attributes:
        l1, l2: Lengths of the bones [m].
        bend: γ [rad].
        sense: σ, 1 or −1.
    """

    l1: float
    l2: float
    bend: float = 0.0
    sense: float = 1.0

    def joint_angles(self, angles: ArrayLike) -> Array:
        """The joint angles (q₁, q₂) for (θ₁, θ₂) [rad]; both are (…, 2)."""
        values = np.array(angles, dtype=np.float64)
        values[..., 1] = self.sense * (values[..., 1] - self.bend)
        return values

    def elbows(self, points: Array, now: Array, slack: Array) -> tuple[Array, Array]:
        """Both answers of `two_bone`, elbow up first, without regard to ranges.

        Args:
            points: Target positions of the tip (N, 2) [m].
            now: Present joint angles (N, 2) [rad].
            slack: (N,) [m]; a point nearer to the base than this leaves the first joint free, and it stays as it is.

        Returns:
            The joint angles (N, 2 elbows, 2) [rad], and the distance by which both miss their point (N,) [m].
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
        """The joint angles (N, 2) inside their ranges that bring the tips nearest to their points [rad].

        If neither elbow is inside the ranges, one joint is at an end of its range, and the other turns as near to the
        point as its range allows. Of equally near answers, those with the given elbow are preferred, and of these the
        one nearest to `now`.

        Args:
            points, now, slack: As for `elbows`.
            ranges: Lower and upper ends (N, 2 joints, 2) [rad], infinite where there are none.
            elbow: "up", "down", or any other text for no preference.
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
        """The allowed answer nearest to `now` (N, 2), of N times k; with the given elbow, if an allowed one has it."""
        if elbow in ELBOWS:
            down = np.sin(self.sense * ways[..., 1] + self.bend) >= 0.0
            wanted = allowed & (down == (elbow == "down"))
            allowed = np.where(wanted.any(axis=1, keepdims=True), wanted, allowed)
        off = ways - now[:, np.newaxis]
        best = np.where(allowed, np.hypot(off[..., 0], off[..., 1]), np.inf).argmin(axis=1)
        return np.asarray(ways[np.arange(len(ways)), best])

    def _at_ends(self, points: Array, now: Array, ranges: Array, slack: Array) -> tuple[Array, Array]:
        """The best answers with one joint at an end of its range.

        Returns:
            Joint angles (N, 4 ends, 2) [rad], and their distances from the point (N, 4) [m], infinite for an end that
            does not exist.
        """
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
        """Tip positions (…, 2) [m] for joint angles (…, 2) [rad]."""
        first = values[..., 0]
        both = first + self.sense * values[..., 1] + self.bend
        x = self.l1 * np.cos(first) + self.l2 * np.cos(both)
        return np.stack([x, self.l1 * np.sin(first) + self.l2 * np.sin(both)], axis=-1)


def turn(wanted: Array, ranges: Array, now: Array) -> Turns:
    """Turn the angles of hinges by whole turns towards `now`, and into their ranges (…, 2); all in rad."""
    low, high = ranges[..., 0], ranges[..., 1]
    angle = now + _within_half_a_turn(wanted - now)
    is_inside: Truths = (low <= angle) & (angle <= high)
    if is_inside.all():
        return Turns(angle, angle, is_inside)
    with np.errstate(invalid="ignore"):  # the remainder of an infinite end is NaN, but nothing lies beyond it
        inside = np.where(angle > high, high - (high - angle) % math.tau, angle)
        inside = np.where(angle < low, low + (angle - low) % math.tau, inside)
        gaps = np.abs(_within_half_a_turn(angle[..., np.newaxis] - ranges))
    gaps = np.where(np.isfinite(ranges), gaps, np.inf)
    is_inside = (low <= inside) & (inside <= high)
    end = np.where(gaps[..., 0] <= gaps[..., 1], low, high)
    return Turns(angle, np.where(is_inside, inside, end), is_inside | (gaps.min(axis=-1) <= ROUNDING))


def _within_half_a_turn(angle: Array) -> Array:
    """The angle turned into [−π, π]; one that is inside already is not rounded."""
    rest = np.fmod(angle, math.tau)
    rest = np.where(rest > math.pi, rest - math.tau, rest)
    return np.where(rest < -math.pi, rest + math.tau, rest)
