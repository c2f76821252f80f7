"""What a live view has recorded: its robots, where they were when, and the balls that they chased."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..robot import Robot
from ..solvers.base import Solver
from ..solvers.distinctions import called, distinctions

__all__ = ["LiveRecording", "RecordedBall"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RecordedBall:
    """A ball, and where it was.

    Attributes:
        frame: The frame that chases it.
        positions: (n, 3) [m] in the robot's world.
        quat_xyzw: Its orientations (n, 4).
        pinned: Whether no motion of the balls moves it.
        oriented: Whether the frame is asked to have its orientation.
    """

    frame: str
    positions: Array
    quat_xyzw: Array
    pinned: bool
    oriented: bool


@dataclass(frozen=True, eq=False)
class LiveRecording:
    """The last seconds of a live view.

    Attributes:
        robot: The robot, of which every instance is one.
        solvers: The method of each instance, from left to right.
        times: When it was (n,) [s], from 0 on, in the view's own time of 60 steps a second.
        q: The configurations (instances, n, nq).
        balls: The balls that were chased.
    """

    robot: Robot
    solvers: tuple[Solver, ...]
    times: Array
    q: Array
    balls: tuple[RecordedBall, ...]

    @property
    def names(self) -> list[str]:
        """A name for each instance: that of its method, with a number if several have it."""
        count: Counter[str] = Counter()
        names = []
        for solver in self.solvers:
            count[solver.name] += 1
            names.append(solver.name if count[solver.name] == 1 else f"{solver.name} {count[solver.name]}")
        return names

    @property
    def titles(self) -> list[str]:
        """What each instance is called: the title of its method, or, among others of that method, what is its own."""
        told_apart = zip(self.solvers, distinctions(self.solvers), strict=True)
        return [called(solver.name, own) if own else solver.title for solver, own in told_apart]

    def __repr__(self) -> str:
        return f"<LiveRecording of {self.robot.name!r}: {', '.join(self.names)}; {self.times[-1]:.1f} s>"
