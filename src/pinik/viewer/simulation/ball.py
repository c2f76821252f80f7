"""A ball that an effector chases, and what it asks for."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ...checks import as_point, as_vector
from ...errors import InputError
from ...problem.targets import Target
from ...problem.tolerance import Tolerance

__all__ = ["AXES", "MODES", "Ball", "Mode"]

Array = NDArray[np.float64]

Mode = Literal["on", "pinned", "off"]
MODES: tuple[Mode, ...] = ("on", "pinned", "off")
AXES = "xyz"
"""The axes of the world along which a position may be free."""


class Ball:
    """A ball and the frame that chases it.

    Attributes:
        frame: The frame's name.
        mode: "on": the frame chases the ball; "pinned": it does too, but no motion moves the ball; "off": it does not.
        home: The ball's first position (3,) [m].
        position: Its current position (3,) [m].
        rpy: The orientation that the frame should have, fixed-axis roll, pitch, yaw (3,) [rad].
        oriented: Whether that orientation is asked for.
        free: The letters of the axes along which the position is not asked for, such as "xy".
        tolerance: The errors of this ball's target that count as reached; those of the session when None.
    """

    def __init__(self, frame: str, home: pinocchio.SE3, mode: Mode) -> None:
        self.frame = frame
        self.mode = mode
        self.home = home.translation.copy()
        self._home_rpy = pinocchio.rpy.matrixToRpy(home.rotation)
        self.oriented = False
        self.free = ""
        self.tolerance: Tolerance | None = None
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

    def follow(self, placement: pinocchio.SE3) -> None:
        """Move to where a frame is, and ask for its orientation there if an orientation is asked for."""
        self.rpy = pinocchio.rpy.matrixToRpy(placement.rotation)
        self.put(placement.translation)

    def orient(self, on: bool, rpy: ArrayLike) -> None:
        """Ask for an orientation, fixed-axis roll, pitch, yaw (3,) [rad], or stop asking for one.

        Raises:
            InputError: The angles are not three finite numbers, or nothing would be asked for any more.
        """
        rpy = as_vector(rpy, 3, f"the orientation of ball {self.frame!r}", "roll, pitch, yaw in radians")
        self._check_asked(self.free, on)
        self.rpy, self.oriented = rpy, on
        self._target = None

    def release(self, axes: str) -> None:
        """Leave the position free along these axes of the world, such as "xy", and ask for it along the others.

        Raises:
            InputError: These are not letters of "xyz" in that order, or nothing would be asked for any more.
        """
        if axes != "".join(axis for axis in AXES if axis in axes):
            raise InputError(f'the free axes of ball {self.frame!r} must be letters of "xyz" in order; got {axes!r}')
        self._check_asked(axes, self.oriented)
        self.free = axes
        self._target = None

    def tolerate(self, tolerance: Tolerance | None) -> None:
        """Set the errors that count as reached; those of the session when None."""
        self.tolerance = tolerance
        self._target = None

    def _check_asked(self, free: str, oriented: bool) -> None:
        if free == AXES and not oriented:
            raise InputError(
                f"ball {self.frame!r} must ask for the position along at least one axis, or for an orientation"
            )

    @property
    def target(self) -> Target:
        """The frame's target; the same object until something changes."""
        if self._target is None:
            asked = [None if axis in self.free else x for axis, x in zip(AXES, self.position.tolist(), strict=True)]
            self._target = Target(
                self.frame,
                None if self.free == AXES else asked,
                rpy=self.rpy if self.oriented else None,
                tolerance=self.tolerance,
            )
        return self._target

    @property
    def placement(self) -> Array:
        """The position and the quaternion xyzw (7,)."""
        # Not by pinocchio.Quaternion: each one made from a matrix leaks 80 bytes (eigenpy of Pinocchio 4.1.0).
        rotation = pinocchio.rpy.rpyToMatrix(self.rpy)
        return np.array(pinocchio.SE3ToXYZQUATtuple(pinocchio.SE3(rotation, self.position)))
