"""The stretches of a curve of solutions that lie inside the joint limits, and why each of them ends.

The curve is cut where a joint passes a limit, and at singular places. Hinges count up to whole turns: a stretch is
inside the limits if all of it is so at the same whole turns. A closed curve may turn a hinge whenever it comes round,
so that the hinge's limit ends the stretch after all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...model.joint import WIDEST_RANGE
from .curve import Curve
from .solution_set import TURN

__all__ = ["End", "Stretch", "stretches"]

Array = NDArray[np.float64]

_NARROW = 1e-6  # [rad]
_TOUCH = 1e-4  # [rad]: a stretch at most this far from a point leads through it


@dataclass(frozen=True)
class End:
    """Why an arc of solutions ends.

    Attributes:
        why: "limit" if joints are at their limits; "singular" at a place where the kernel of the Jacobian grows, so
            that curves may meet there; "long" if the curve was given up, after 200 rad in each direction.
        limits: Joint → "lower" or "upper", for the joints at their limits.
        conditioning: Beside a singular place, the smallest singular value that is not 0 divided by the largest.
    """

    why: str
    limits: dict[str, str] = field(default_factory=dict)
    conditioning: float | None = None

    def __str__(self) -> str:
        if self.why == "limit":
            return " and ".join(f"{name} at its {side} limit" for name, side in self.limits.items())
        return "a singular place" if self.why == "singular" else "a point where the curve was given up as too long"


class Stretch(NamedTuple):
    """A part of a curve inside the limits.

    Attributes:
        begin, end: Its ends, in the curve's arc length, which goes on beyond the curve's own ends if it is closed.
        lift: What is added to the entries of q (nq,): multiples of 2π for hinges.
        closed: Whether it is the whole of a closed curve.
        ends: Why it ends at each end; none if it is closed.
    """

    begin: float
    end: float
    lift: Array
    closed: bool
    ends: tuple[End, ...]


def stretches(curve: Curve, q: Array) -> list[Stretch]:
    """The parts of a curve inside the limits of its question, the one where it was traced from first.

    Together they contain each configuration of the curve that is inside the limits, up to whole turns. Where limits
    leave a hinge a choice of whole turns, those nearest to `q` are taken.

    Args:
        curve: The curve.
        q: A configuration (nq,).
    """
    found, start, question = list(_Cutter(curve, q).cut()), curve.start, curve.solutions.question
    away = min((max(part.begin - start, start - part.end) for part in found[:1]), default=math.inf)
    origin = curve.points(np.array([start]))[0][0]
    if away <= _TOUCH or not question.limits.contains(origin):
        return found
    end = End("limit", question.active_limits(origin))  # the curve touches the limits from outside
    return [Stretch(start, start, np.zeros(len(q)), False, (end, end)), *found]


class _Event(NamedTuple):
    """A place at which a stretch may end: where a hinge or slide passes a limit, or a singular place."""

    at: float
    conditioning: float | None


class _Cutter:
    """The curve, cut into cells at all events. Those of a closed curve are numbered on, round after round."""

    def __init__(self, curve: Curve, q: Array) -> None:
        solutions = curve.solutions
        limits = solutions.question.limits
        self._curve, self._limits = curve, limits
        self._entries, self._columns = [], []
        for column, entry in enumerate(limits.entry[solutions.free].tolist()):
            width = limits.upper[entry] - limits.lower[entry]
            if entry >= 0 and width <= (WIDEST_RANGE if limits.turning[entry] else math.inf):
                self._entries.append(entry)
                self._columns.append(column)
        self._lower, self._upper = limits.lower[self._entries], limits.upper[self._entries]
        self._turning = limits.turning[self._entries]
        self._near = q[self._entries]
        crossings = [_Event(crossing.at, crossing.conditioning) for crossing in curve.crossings]
        events = [*self._passings(), *crossings]
        if curve.closed:  # an event at the seam may lie a rounding beyond the round
            events = [event._replace(at=event.at % curve.length) for event in events]
        self._events = sorted(events, key=lambda event: event.at)
        self._values = self._middles()

    def _passings(self) -> Iterator[_Event]:
        """Where the limited entries of q pass their limits, at any whole turns."""
        for entry, column in zip(self._entries, self._columns, strict=True):
            values = self._curve.q[:, entry]
            least, most = values.min() - 1.0, values.max() + 1.0
            for limit in (self._limits.lower[entry], self._limits.upper[entry]):
                if not math.isfinite(limit):
                    continue
                levels = [limit]
                if self._limits.turning[entry]:
                    first, last = math.ceil((least - limit) / TURN), math.floor((most - limit) / TURN)
                    levels = [limit + TURN * turn for turn in range(first, last + 1)]
                for level in levels:
                    for at in self._curve.levels(entry, column, level):
                        yield _Event(at, None)

    def cut(self) -> Iterator[Stretch]:
        """All parts inside the limits."""
        start, covered = self._curve.start, set[int]()
        for cell in self._cells_by_nearness(start):
            lift = self._lift(cell)
            if self._number(cell) in covered or lift is None:
                continue
            first, before = self._end(cell, lift, -1)
            last, after = self._end(cell, lift, +1)
            shift = np.zeros(self._curve.q.shape[1])
            shift[self._entries] = lift
            if before is None or after is None:
                yield Stretch(start, start + self._curve.length, shift, True, ())
                return
            covered |= {self._number(k) for k in range(first, last + 1)}
            yield Stretch(self._border(first), self._border(last + 1), shift, False, (before, after))

    @property
    def _count(self) -> int:
        """The number of cells in one round."""
        return max(len(self._events), 1) if self._curve.closed else len(self._events) + 1

    def _number(self, cell: int) -> int:
        return cell % self._count

    def _border(self, k: int) -> float:
        """The arc length at which cell k begins."""
        curve, events = self._curve, self._events
        if curve.closed:
            at = events[k % self._count].at if events else 0.0
            return at + curve.length * (k // self._count)
        return 0.0 if k == 0 else curve.length if k == self._count else events[k - 1].at

    def _event(self, k: int) -> _Event:
        """The event at which cell k begins, which is not an end of the curve."""
        return self._events[k % self._count if self._curve.closed else k - 1]

    def _cells_by_nearness(self, start: float) -> list[int]:
        """All cells of one round, the nearest to a place on the curve first."""
        if not self._curve.closed:
            cells = range(self._count)
        else:
            own = next(k for k in range(-1, self._count) if self._border(k) <= start <= self._border(k + 1))
            cells = range(own - self._count // 2, own - self._count // 2 + self._count)
        return sorted(cells, key=lambda k: (max(self._border(k) - start, start - self._border(k + 1), 0.0), k))

    def _middles(self) -> Array:
        """The limited entries of q in the middle of each cell of the first round."""
        borders = np.array([self._border(k) for k in range(self._count + 1)])
        return np.asarray(self._curve.points(0.5 * (borders[:-1] + borders[1:]))[0][:, self._entries])

    def _middle(self, cell: int) -> Array:
        """The limited entries of q in the middle of a cell."""
        rounds = cell // self._count
        return np.asarray(self._values[self._number(cell)] + rounds * self._curve.turns[self._entries])

    def _lift(self, cell: int) -> Array | None:
        """The whole turns, in radians, that bring a cell inside the limits nearest to the start; None if none do.

        What is near to the start is the part of the cell next to it: its middle may be half a turn away.
        """
        if self._is_narrow(cell):
            return None
        values, curve = self._middle(cell), self._curve
        next_to = np.clip(curve.start, self._border(cell), self._border(cell + 1))
        away = self._near - curve.points(np.array([next_to]))[0][0, self._entries]
        turns = np.where(self._turning, np.round(away / TURN), 0.0)
        below, above = self._lower - values - TURN * turns, values + TURN * turns - self._upper
        turns += np.where(self._turning, np.ceil(np.maximum(below, 0.0) / TURN), 0.0)
        turns -= np.where(self._turning, np.ceil(np.maximum(above, 0.0) / TURN), 0.0)
        lift = TURN * turns
        return lift if self._is_inside(cell, lift) else None

    def _is_inside(self, cell: int, lift: Array) -> bool:
        values = self._middle(cell) + lift
        return self._is_narrow(cell) or bool(((values >= self._lower) & (values <= self._upper)).all())

    def _is_narrow(self, cell: int) -> bool:
        """Whether a cell is as narrow as rounding: the curve only touches a limit there."""
        return self._border(cell + 1) - self._border(cell) < _NARROW

    def _end(self, cell: int, lift: Array, way: int) -> tuple[int, End | None]:
        """The last cell that a stretch reaches in one direction, and why it ends; no reason if it comes round."""
        curve, k = self._curve, cell
        comes_round = curve.closed and not curve.turns[self._entries].any()
        while True:
            border = k + 1 if way > 0 else k
            if not curve.closed and border in (0, self._count):
                return k, End(curve.ends[0 if border == 0 else 1])
            if self._events and self._event(border).conditioning is not None:
                return k, End("singular", {}, self._event(border).conditioning)
            if not self._is_inside(k + way, lift):
                return k, End("limit", self._sides(k + way, lift))
            k += way
            if comes_round and abs(k - cell) >= self._count:
                return cell, None

    def _sides(self, cell: int, lift: Array) -> dict[str, str]:
        """The joints that are outside their limits in a cell."""
        values, robot = self._middle(cell) + lift, self._limits.robot
        names = {joint.idx_q: joint.name for joint in robot.joints if joint.leader is None}
        outside = {}
        for entry, value, lower, upper in zip(self._entries, values, self._lower, self._upper, strict=True):
            if not lower <= value <= upper:
                outside[names[entry]] = "lower" if value < lower else "upper"
        return outside
