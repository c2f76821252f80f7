"""How the balls move when nobody drags them: along a curve or at random."""

from __future__ import annotations

import copy
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import UnknownNameError
from ...model.home import home_configuration
from ...motion.curves import CURVES
from ...motion.tracks import Track, lay_track, random_configuration
from ...robot import Robot
from .ball import Ball

__all__ = ["MOTIONS", "Motion"]

Array = NDArray[np.float64]

MOTIONS = {"hand": "By hand", "curve": "Along a curve", "random": "At random"}
"""Name → title."""

_PERIOD = 8.0  # [s] for one lap of a curve at speed 1
_PAUSE = 1.5  # [s] between two random positions at speed 1


class Motion:
    """Moves the balls whose mode is "on", step after step. The same seed gives the same random positions.

    Attributes:
        kind: "hand", "curve" or "random".
        curve: A name in `CURVES`.
        speed: Factor by which the motion is faster.
    """

    def __init__(self, robot: Robot, seed: int = 0) -> None:
        self.kind = "hand"
        self.curve = "eight"
        self.speed = 1.0
        self._robot = robot
        self._seed = seed
        self._home = home_configuration(robot)
        self._laid: dict[tuple[str, str], Track] = {}
        self.restart()

    def restart(self) -> None:
        """Start the curve and the random positions from the beginning."""
        self._phase = 0.0
        self._since = np.inf
        self._rng = np.random.default_rng(self._seed)

    def choose_curve(self, name: str) -> None:
        """Set the curve.

        Raises:
            UnknownNameError: There is no such curve.
        """
        if name not in CURVES:
            raise UnknownNameError("curve", name, CURVES)
        self.curve = name

    def start_at(self, phase: float) -> None:
        """Go on along the curve after this part of its lap, from 0 to 1."""
        self._phase = phase % 1.0

    def go_on_from(self, other: Motion) -> None:
        """Go on where another motion is: at its place on the lap, and with the random positions it would choose."""
        self._phase, self._since = other._phase, other._since
        self._rng = copy.deepcopy(other._rng)

    def advance(self, balls: Sequence[Ball], seconds: float) -> None:
        """Move the balls by one step of `seconds`."""
        if not self.moves(balls):
            return
        moving = [ball for ball in balls if ball.mode == "on"]
        if self.kind == "curve":
            self._phase = (self._phase + self.speed * seconds / _PERIOD) % 1.0
            for ball in moving:
                ball.put(self._track(ball).at(self._phase))
            return
        self._since += self.speed * seconds
        if self._since >= _PAUSE:
            self._since = 0.0
            q = random_configuration(self._robot, self._home, self._rng)
            for ball in moving:
                ball.put(self._robot.placement(ball.frame, q).translation)

    def moves(self, balls: Sequence[Ball]) -> bool:
        """Whether it moves any of the balls."""
        return self.kind != "hand" and any([ball.mode == "on" for ball in balls])

    def path(self, ball: Ball) -> Array:
        """Return the points (n, 3) [m] of the closed curve that a ball follows; no points if it follows none."""
        if self.kind != "curve" or ball.mode != "on":
            return np.zeros((0, 3))
        return self._track(ball).path

    def _track(self, ball: Ball) -> Track:
        """Return a ball's curve around its home."""
        key = (ball.frame, self.curve)
        if key not in self._laid:
            self._laid[key] = lay_track(self._robot, ball.frame, self.curve, ball.home)
        return self._laid[key]
