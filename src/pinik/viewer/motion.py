"""How the balls move by themselves: along a curve or at random; by hand they stay where they were put."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..robot import Robot
from .balls import Ball
from .curves import CURVES, polyline
from .effectors import curve_axes, home_configuration, lowest_point

__all__ = ["MOTIONS", "Motion"]

Array = NDArray[np.float64]

MOTIONS = {"hand": "By hand", "curve": "Along a curve", "random": "At random"}
"""Name → title."""

_PERIOD = 8.0  # [s] once round a curve at speed 1
_PAUSE = 1.5  # [s] between two random places at speed 1


class _Track(NamedTuple):
    """One ball's curve: its center (3,), the rows u, v, w of its axes (3, 3) and its points (n, 3), all in [m]."""

    center: Array
    axes: Array
    path: Array


class Motion:
    """Moves the balls whose mode is "on", step after step; the same seed gives the same places.

    Attributes:
        kind: "hand", "curve" or "random".
        curve: A name in `CURVES`.
        speed: Factor on time.
    """

    def __init__(self, robot: Robot, seed: int = 0) -> None:
        self.kind = "hand"
        self.curve = "eight"
        self.speed = 1.0
        self._robot = robot
        self._seed = seed
        self._home = home_configuration(robot)
        self._ground = lowest_point(robot, self._home)
        self._laid: dict[tuple[str, str], _Track] = {}
        self.restart()

    def restart(self) -> None:
        """Back to the beginning of the curve and of the random places."""
        self._phase = 0.0
        self._since = np.inf
        self._rng = np.random.default_rng(self._seed)

    def advance(self, balls: Sequence[Ball], seconds: float) -> None:
        """Move the balls on by a step of `seconds`."""
        moving = [ball for ball in balls if ball.mode == "on"]
        if self.kind == "hand" or not moving:
            return
        if self.kind == "curve":
            self._phase = (self._phase + self.speed * seconds / _PERIOD) % 1.0
            for ball in moving:
                track = self._track(ball)
                ball.put(track.center + np.array(CURVES[self.curve].point(self._phase)) @ track.axes)
            return
        self._since += self.speed * seconds
        if self._since >= _PAUSE:
            self._since = 0.0
            q = self._random_configuration()
            for ball in moving:
                ball.put(self._robot.placement(ball.frame, q).translation)

    def path(self, ball: Ball) -> Array:
        """The points (n, 3) [m] of the curve that a ball follows, closed; none where it follows none."""
        if self.kind != "curve" or ball.mode != "on":
            return np.zeros((0, 3))
        return self._track(ball).path

    def _track(self, ball: Ball) -> _Track:
        """A ball's curve: about its home, raised until nothing dips into the ground."""
        key = (ball.frame, self.curve)
        if key not in self._laid:
            curve = CURVES[self.curve]
            axes = curve_axes(self._robot, ball.frame, self._home, ball.home, curve)
            lowest = float(polyline(curve, ball.home, axes)[:, 2].min())
            center = ball.home + np.array([0.0, 0.0, max(0.0, self._ground - lowest)])
            self._laid[key] = _Track(center, axes, polyline(curve, center, axes))
        return self._laid[key]

    def _random_configuration(self) -> Array:
        """All one-axis joints drawn anew, the root where it is at home: what is drawn can be reached."""
        q = self._home.copy()
        drawn = self._robot.random(self._rng)
        for name in self._robot.joint_names:
            joint = self._robot.joint(name)
            if joint.has_one_axis:
                joint.set_angle(q, joint.angle(drawn))
        return q
