"""Arcs of solutions as configurations: even in arc length, inside the limits, and certified."""

from __future__ import annotations

from dataclasses import asdict
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..origin import unwound_path
from .curve import Curve
from .settling import settle, settle_at_limits
from .stretches import End, Stretch, stretches

__all__ = ["Arc", "arcs_of"]

Array = NDArray[np.float64]


class Arc:
    """A curve of configurations that reach the targets inside the limits.

    Attributes:
        length: The arc length [rad].
        closed: Whether it comes back to its first configuration, up to whole turns.
        ends: Why it ends at its first and at its last configuration; empty if it is closed.
    """

    def __init__(self, curve: Curve, stretch: Stretch, start: Array, points: int) -> None:
        """Keep the stretch of a curve that it is; its configurations are computed when they are first read.

        Args:
            curve: The curve.
            stretch: The stretch.
            start: The configuration (nq,) whose whole turns the angles of continuous joints go on from.
            points: The number of configurations.
        """
        self.closed, self.ends = stretch.closed, stretch.ends
        self._curve, self._lift, self._start, self._points = curve, stretch.lift, start, points
        self._begin, self._last = stretch.begin, stretch.end
        self._edges: tuple[list[Array], list[Array]] = [], []
        if self.ends:
            self._begin, before = self._edge(stretch.begin, self.ends[0])
            self._last, after = self._edge(stretch.end, self.ends[1])
            self._edges = before, after
        self.length = self._last - self._begin

    def _near(self, s: Array) -> tuple[Array, Array]:
        """Configurations (N, nq) near the arc, and across what they are moved onto it (N, 1, n)."""
        near, directions = self._curve.points(s)
        return near + self._lift, directions[:, np.newaxis]

    def _edge(self, s: float, end: End) -> tuple[float, list[Array]]:
        """Where the arc ends, exactly, and its configuration there, if it can be certified."""
        solutions = self._curve.solutions
        near, across = self._near(np.array([s]))
        if end.limits:
            entries = [solutions.question.robot.joint(name).idx_q for name in end.limits]
            held = settle_at_limits(solutions, near[0], across[0], entries)
            if held is not None:
                return s + float(solutions.difference(near[0], held).dot(across[0, 0])), [held]
        return s, settle(solutions, near, across)

    @cached_property
    def q(self) -> Array:
        """The configurations (N, nq), at equal distances along the arc, from end to end.

        Those of a closed arc do not repeat the first one at the end. Each is certified by plain Pinocchio: beside a
        singular place there may be fewer, because those that cannot be are left out.
        """
        before, after = self._edges
        if self.length == 0.0:  # the curve only touches the limits
            return np.array(before).reshape(-1, self._curve.q.shape[1])
        s = np.linspace(self._begin, self._last, self._points, endpoint=not self.closed)
        inner = s if self.closed else s[1:-1]
        q = [*before, *settle(self._curve.solutions, *self._near(inner)), *after]
        return np.array(q).reshape(-1, self._curve.q.shape[1])

    @cached_property
    def angles(self) -> Array:
        """The angles (N, n_joints) [rad or m] in the order of `robot.joint_names`.

        Those of continuous joints go on beyond ±π.
        """
        return unwound_path(self._curve.solutions.question.robot, self.q, self._start)

    def __len__(self) -> int:
        return len(self.q)

    def to_dict(self) -> dict[str, Any]:
        """A dictionary for JSON."""
        return {
            "length": self.length,
            "closed": self.closed,
            "ends": [asdict(end) for end in self.ends],
            "angles": self.angles.tolist(),
        }

    def __repr__(self) -> str:
        return f"Arc({self})"

    def __str__(self) -> str:
        if self.closed:
            return f"a closed arc of {self.length:.3g} rad"
        return f"an arc of {self.length:.3g} rad from {self.ends[0]} to {self.ends[1]}"


def arcs_of(curve: Curve, q: Array, points: int) -> tuple[Arc, ...]:
    """The arcs of a curve inside the limits, the one where it was traced from first, the others by nearness to it.

    Args:
        curve: The curve.
        q: The configuration (nq,) to whose whole turns those of hinges are near.
        points: The number of configurations of each arc.
    """
    return tuple([Arc(curve, part, q, points) for part in stretches(curve, q)])
