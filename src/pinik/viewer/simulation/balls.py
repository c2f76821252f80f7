"""The balls: where the effectors should be, and whether they are asked."""

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
    """One ball, and the frame that chases it.

    Attributes:
        frame: The frame's name.
        mode: "on": the frame chases the ball; "pinned": likewise, but no motion moves the ball; "off".
        home: Where the ball begins (3,) [m].
        position: Where it is (3,) [m].
        rpy: The orientation that the frame should have, fixed-axis roll, pitch, yaw (3,) [rad].
        oriented: Whether that is asked for.
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
        """Back to where it began, its orientation too."""
        self.rpy: Array = np.array(self._home_rpy)
        self.put(self.home)

    def put(self, position: ArrayLike) -> None:
        """Put it at a point (3,) [m].

        Raises:
            InputError: That is no point.
        """
        self.position = as_point(position, f"the position of ball {self.frame!r}")
        self._target = None

    def orient(self, on: bool, rpy: ArrayLike) -> None:
        """Ask for an orientation (fixed-axis roll, pitch, yaw (3,) [rad]), or for none any more.

        Raises:
            InputError: These are no three numbers.
        """
        self.rpy = as_vector(rpy, 3, f"the orientation of ball {self.frame!r}", "roll, pitch, yaw in radians")
        self.oriented = on
        self._target = None

    @property
    def target(self) -> Target:
        """What the frame is asked for: the same object as long as nothing changed."""
        if self._target is None:
            self._target = Target(self.frame, self.position, rpy=self.rpy if self.oriented else None)
        return self._target

    @property
    def placement(self) -> Array:
        """Position and quaternion xyzw (7,)."""
        quaternion = pinocchio.Quaternion(pinocchio.rpy.rpyToMatrix(self.rpy)).coeffs()
        return np.concatenate([self.position, quaternion])
