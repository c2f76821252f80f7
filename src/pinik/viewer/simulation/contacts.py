"""What the instances of a session touch: themselves, and the obstacles around them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...errors import PinikError
from ...robot import Robot
from ...shapes.avoid import Avoid
from ...shapes.collisions import Guard, RobotShapes, shapes_of
from ...shapes.solids import Solid

__all__ = ["Contacts"]


class Contacts:
    """A robot's collision shapes among obstacles. To find out which pairs of links count can take seconds.

    Attributes:
        on: Whether what touches is looked for.
        avoids: Whether the instances avoid it.
        why_not: Why nothing can be looked for, in words; empty if it can.
    """

    def __init__(self, robot: Robot) -> None:
        self.on = self.avoids = False
        self.why_not = ""
        self._robot = robot
        self._shapes: RobotShapes | None = None
        self._around: tuple[Solid, ...] = ()
        self._avoid = Avoid(True, ())

    @property
    def waits(self) -> bool:
        """Whether the shapes must be loaded before anything can be found."""
        return self.on and self._shapes is None and not self.why_not

    def load(self) -> RobotShapes:
        """Read the shapes, and find out which pairs count; any thread may do this.

        Raises:
            PinikError: The robot has no collision shapes, or what reads them is not installed.
        """
        shapes = shapes_of(self._robot)
        shapes.pairs(self._robot)
        return shapes

    def take(self, shapes: RobotShapes | BaseException) -> None:
        """Take what `load` returned or raised."""
        if isinstance(shapes, BaseException):
            known = isinstance(shapes, PinikError)
            self.why_not = str(shapes) if known else f"the collision shapes cannot be read: {shapes}"
        else:
            self._shapes = shapes

    def surround(self, solids: tuple[Solid, ...]) -> None:
        """Put the robot among these obstacles."""
        self._around, self._avoid = solids, Avoid(True, solids)

    @property
    def avoided(self) -> Avoid | None:
        """What the instances avoid, for the options of a solve; None if nothing, or if it is not known yet.

        It is the same object until the obstacles change.
        """
        return self._avoid if self.on and self.avoids and self._shapes is not None else None

    @property
    def guard(self) -> Guard | None:
        """What finds touches; None while nothing is looked for."""
        if not self.on or self._shapes is None:
            return None
        return self._shapes.guard(self._robot, self._around)

    def touches(self, q: NDArray[np.float64]) -> bool:
        """Whether anything that is looked for touches at q (nq,)."""
        guard = self.guard
        return guard is not None and guard.touches(q)

    def touching(self, q: NDArray[np.float64]) -> list[tuple[str, str]]:
        """The pairs that touch at q (nq,), the deepest first."""
        guard = self.guard
        return [] if guard is None or not guard.touches(q) else [c.pair for c in guard.collisions(q)]
