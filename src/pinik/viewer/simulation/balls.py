"""The balls that the effectors chase."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ...checks import as_point, as_vector
from ...problem.targets import Target

__all__ = ["MODES", "Ball", "Mode"]

Array = NDArray[np.float64]

Mode = Literal["on", "pinned", "off"]
MODES: tuple[Mode, ...] = ("on", "pinned", "off")


class Ball:
    """A ball and the frame that chases it.

    Attributes:
        frame: The frame's name.
        mode: "on": the frame chases the ball; "pinned": it does too, but no motion moves the ball; "off": it does not.
        home: The ball's first position (3,) [m].
        position: Its current position (3,) [m].
        rpy: The orientation that the frame should have, fixed-axis roll, pitch, yaw (3,) [rad].
        oriented: Whether that orientation is asked for.
    """

    def __init__(self, frame: str, home: pinocchio.SE3, mode: Mode) -> None:
        self.frame = frame
        self.mode = mode
        self.home = home.translation.copy()
        self._home_rpy = pinocchio.rpy.matrixToRpy(home.rotation)
        self.oriented = False
        self._target: Target | None = None
        self.go_home()

    def go_home(self) -> None:
        """Restore the first position and orientation."""
        self.rpy: Array = np.array(self._home_rpy)
        self.put(self.home)

    def put(self, position: ArrayLike) -> None:
        """Move the ball to a point (3,) [m].

        Raises:
            InputError: The position is not three finite numbers.
        """
        self.position = as_point(position, f"the position of ball {self.frame!r}")
        self._target = None

    def orient(self, on: bool, rpy: ArrayLike) -> None:
        """Ask for an orientation, fixed-axis roll, pitch, yaw (3,) [rad], or stop asking for one.

        Raises:
            InputError: The angles are not three finite numbers.
        """
        self.rpy = as_vector(rpy, 3, f"the orientation of ball {self.frame!r}", "roll, pitch, yaw in radians")
        self.oriented = on
        self._target = None

    @property
    def target(self) -> Target:
        """The frame's target; the same object until something changes."""
        if self._target is None:
            self._target = Target(self.frame, self.position, rpy=self.rpy if self.oriented else None)
        return self._target

    @property
    def placement(self) -> Array:
        """The position and the quaternion xyzw (7,)."""
        quaternion = pinocchio.Quaternion(pinocchio.rpy.rpyToMatrix(self.rpy)).coeffs()
        return np.concatenate([self.position, quaternion])
