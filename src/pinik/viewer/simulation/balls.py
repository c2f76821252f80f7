"""The balls of a session, at least one, each for another frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import overload

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...model.home import home_configuration, lowest_point
from ...motion.effectors import principal_frames
from ...problem.targets import Target
from ...robot import Robot
from .ball import Ball, Mode

__all__ = ["MOST_BALLS", "Balls"]

Array = NDArray[np.float64]

MOST_BALLS = 12
_ON_THE_GROUND = 0.12  # [m] above the lowest frame


class Balls(Sequence[Ball]):
    """The balls in the order in which pages number them."""

    def __init__(self, robot: Robot) -> None:
        """Place a ball at each of the robot's principal frames: the first is on, and those on the ground are pinned.

        Args:
            robot: The robot, in its home configuration.
        """
        self._robot = robot
        self._home = home_configuration(robot)
        self._balls: list[Ball] = []
        for frame in principal_frames(robot):
            self.add(frame, "pinned" if self._is_planted(frame) else "off")
        self._balls[0].mode = "on"

    @overload
    def __getitem__(self, index: int) -> Ball: ...
    @overload
    def __getitem__(self, index: slice) -> list[Ball]: ...
    def __getitem__(self, index: int | slice) -> Ball | list[Ball]:
        """The ball with a number, or several."""
        return self._balls[index]

    def __len__(self) -> int:
        return len(self._balls)

    def __iter__(self) -> Iterator[Ball]:
        return iter(self._balls)

    def number(self, index: int) -> Ball:
        """The ball with a number that a page has given.

        Raises:
            InputError: There is no such ball.
        """
        if not 0 <= index < len(self):
            raise InputError(f"balls are numbered from 0 to {len(self) - 1}; got {index}")
        return self._balls[index]

    @property
    def frames(self) -> list[str]:
        """The frame of each ball."""
        return [ball.frame for ball in self]

    @property
    def targets(self) -> list[Target]:
        """The targets of the balls that are not off."""
        return [ball.target for ball in self if ball.mode != "off"]

    def add(self, frame: str, mode: Mode) -> Ball:
        """Add a ball to a frame that has none yet, at its place in the home configuration.

        Raises:
            UnknownNameError: There is no such frame.
            InputError: The frame has a ball already, or there are too many balls.
        """
        home = self._robot.placement(frame, self._home)
        if frame in self.frames:
            raise InputError(f"frame {frame!r} already has a ball")
        if len(self) >= MOST_BALLS:
            raise InputError(f"a session can have at most {MOST_BALLS} balls; remove one first")
        ball = Ball(frame, home, mode)
        self._balls.append(ball)
        return ball

    def remove(self, index: int) -> None:
        """Remove a ball, but not the last one.

        Raises:
            InputError: There is no such ball, or it is the last one.
        """
        ball = self.number(index)
        if len(self) == 1:
            raise InputError("the last ball cannot be removed; switch it off instead")
        self._balls.remove(ball)

    def arrange(self, frames: Sequence[str]) -> None:
        """Number the balls in the order of these frames, which are those of the balls."""
        self._balls.sort(key=lambda ball: frames.index(ball.frame))

    def _is_planted(self, frame: str) -> bool:
        """Whether the robot stands on this frame: its root is not fixed, and the frame is near the ground."""
        if self._robot.root == "fixed":
            return False
        height = self._robot.placement(frame, self._home).translation[2] - lowest_point(self._robot, self._home)
        return bool(height < _ON_THE_GROUND)
