"""Arcs of solutions as configurations: even in arc length, inside the limits, and certified."""

from __future__ import annotations

from functools import cached_property

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
        self.length, self.closed, self.ends = stretch.end - stretch.begin, stretch.closed, stretch.ends
        self._curve, self._stretch, self._start, self._points = curve, stretch, start, points

    @cached_property
    def q(self) -> Array:
        """The configurations (N, nq), at equal distances along the arc, from end to end.

        Those of a closed arc do not repeat the first one at the end. Each is certified by plain Pinocchio: beside a
        singular place there may be fewer, because those that cannot be are left out.
        """
        curve, part = self._curve, self._stretch
        s = np.linspace(part.begin, part.end, self._points, endpoint=not part.closed)
        near, directions = curve.points(s)
        near, across, solutions = near + part.lift, directions[:, np.newaxis], curve.solutions
        if part.closed:
            return np.array(settle(solutions, near, across)).reshape(-1, near.shape[1])
        first = _end(curve, part.ends[0], near[:1], across[:1])
        last = _end(curve, part.ends[1], near[-1:], across[-1:])
        return np.array([*first, *settle(solutions, near[1:-1], across[1:-1]), *last]).reshape(-1, near.shape[1])

    @cached_property
    def angles(self) -> Array:
        """The angles (N, n_joints) [rad or m] in the order of `robot.joint_names`.

        Those of continuous joints go on beyond ±π.
        """
        return unwound_path(self._curve.solutions.question.robot, self.q, self._start)

    def __len__(self) -> int:
        return len(self.q)

    def __repr__(self) -> str:
        return f"Arc({self})"

    def __str__(self) -> str:
        if self.closed:
            return f"a closed arc of {self.length:.3g} rad"
        return f"an arc of {self.length:.3g} rad from {self.ends[0]} to {self.ends[1]}"


def arcs_of(curve: Curve, q: Array, points: int) -> tuple[Arc, ...]:
    """The arcs of a curve inside the limits, the one through `q` first, the others by nearness to it.

    Args:
        curve: The curve.
        q: The configuration (nq,) from which the curve was traced.
        points: The number of configurations of each arc.
    """
    return tuple([Arc(curve, part, q, points) for part in stretches(curve, q)])


def _end(curve: Curve, end: End, q: Array, across: Array) -> list[Array]:
    """The configuration at the end of an arc: exactly at a limit, if one is the reason."""
    solutions = curve.solutions
    if end.limits:
        entries = [solutions.question.robot.joint(name).idx_q for name in end.limits]
        held = settle_at_limits(solutions, q[0], entries)
        if held is not None:
            return [held]
    return settle(solutions, q, across)
