"""Two hinges in a plane, with ranges: both elbows, and the nearest that the ranges leave."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .closed_form import ELBOWS, two_bone

__all__ = ["ROUNDING", "Elbow", "PlanarArm", "Range", "Turn", "turn"]

ROUNDING = 1e-12
"""Of the lengths that enter; and [rad] of an angle at the end of its range."""

Range = tuple[float, float]
Angles = tuple[float, float]


class Turn(NamedTuple):
    """An angle brought near to where a joint stands, and into its range.

    Attributes:
        angle: The equal angle nearest to where the joint stands [rad].
        inside: One inside the range: an equal angle, the nearest to where the joint stands; or the end of the range
            that is nearest to one [rad].
        fits: Whether it is an equal one, but for rounding.
    """

    angle: float
    inside: float
    fits: bool


class Elbow(NamedTuple):
    """One way to hold the arm.

    Attributes:
        name: "up" or "down".
        values: The two joints' values [rad].
        missed: How far the tip then is from the target [m].
    """

    name: str
    values: Angles
    missed: float


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

    def joint_angles(self, angles: ArrayLike) -> NDArray[np.float64]:
        """(q₁, q₂) for (θ₁, θ₂) [rad]: (…, 2) from (…, 2)."""
        first, second = np.moveaxis(np.asarray(angles, dtype=np.float64), -1, 0)
        return np.stack([first, self.sense * (second - self.bend)], axis=-1)

    def elbows(self, point: Angles, now: Angles, slack: float) -> list[Elbow]:
        """Both answers of `two_bone` for a point [m], up first, ranges aside.

        A point within `slack` [m] of the base leaves the first joint free, and it stays where it is `now` [rad].
        """
        at_base = math.hypot(*point) <= slack
        found = two_bone(self.l1, self.l2, [(0.0, 0.0) if at_base else point])
        return [
            Elbow(name, (now[0] if at_base else first, second), float(found.shortfall[0]))
            for name, (first, second) in zip(ELBOWS, self.joint_angles(found.angles[0]).tolist(), strict=True)
        ]

    def nearest(self, point: Angles, now: Angles, ranges: Sequence[Range], slack: float, elbow: str = "") -> Angles:
        """The joints' values inside their ranges [rad] that bring the tip nearest to a point [m].

        Where the minimum lies inside, it is one of the two elbows; else one joint is at an end of its range, and the
        other one turns as near to the point as it may. Of equally near ones `elbow` is taken, and of these the nearest
        to `now`.
        """
        inside = []
        for way in self.elbows(point, now, slack):
            turns = [turn(*each) for each in zip(way.values, ranges, now, strict=True)]
            if all(each.fits for each in turns):
                inside.append(way._replace(values=(turns[0].inside, turns[1].inside)))
        if not inside:
            at_ends = self._at_ends(point, now, ranges, slack)
            least = min(way.missed for way in at_ends) + ROUNDING * (self.l1 + self.l2)
            inside = [way for way in at_ends if way.missed <= least]
        return min(inside, key=lambda way: (way.name != elbow, math.dist(way.values, now))).values

    def _at_ends(self, point: Angles, now: Angles, ranges: Sequence[Range], slack: float) -> list[Elbow]:
        x, y = point
        found = []
        for first in filter(math.isfinite, ranges[0]):
            along, across = x - self.l1 * math.cos(first), y - self.l1 * math.sin(first)
            wanted = self.sense * (math.atan2(across, along) - first - self.bend)
            found.append((first, turn(wanted, ranges[1], now[1]).inside))
        for second in filter(math.isfinite, ranges[1]):
            tip_x, tip_y = self._tip(0.0, second)
            wanted = now[0] if math.hypot(x, y) <= slack else math.atan2(y, x) - math.atan2(tip_y, tip_x)
            found.append((turn(wanted, ranges[0], now[0]).inside, second))
        return [
            Elbow(
                ELBOWS[math.sin(self.sense * values[1] + self.bend) >= 0.0],
                values,
                math.dist(point, self._tip(*values)),
            )
            for values in found
        ]

    def _tip(self, first: float, second: float) -> Angles:
        both = first + self.sense * second + self.bend
        return (
            self.l1 * math.cos(first) + self.l2 * math.cos(both),
            self.l1 * math.sin(first) + self.l2 * math.sin(both),
        )


def turn(wanted: float, room: Range, now: float) -> Turn:
    """A hinge's angle turned by whole turns into its range, near to where it stands `now`; all in rad."""
    low, high = room
    angle = now + math.remainder(wanted - now, math.tau)
    inside = angle
    if angle > high:
        inside = high - (high - angle) % math.tau
    elif angle < low:
        inside = low + (angle - low) % math.tau
    if low <= inside <= high:
        return Turn(angle, inside, True)
    gap, end = min((abs(math.remainder(angle - end, math.tau)), end) for end in room if math.isfinite(end))
    return Turn(angle, end, gap <= ROUNDING)
