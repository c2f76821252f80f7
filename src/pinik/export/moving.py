"""What a file shows: a robot, its configurations, and when it is at each."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_vector
from ..errors import InputError, UrdfWarning
from ..extras import needed_by
from ..picture.arguments import as_configurations
from ..robot import Robot
from ..solving.self_motion import SelfMotion
from ..solving.solution import Solution
from ..solving.track import Track

if TYPE_CHECKING:
    from ..shapes.meshes import Shape

__all__ = ["Moving", "Shown", "check_suffix", "moving"]

Array = NDArray[np.float64]
Shown: TypeAlias = Robot | Solution | Track | SelfMotion

_PERIOD = 1.0 / 30.0  # [s] between configurations without times


@dataclass(frozen=True, eq=False)
class Moving:
    """A robot that moves.

    Attributes:
        robot: The robot.
        q: The configurations (n, nq), at least one.
        times: When it is at each (n,) [s], increasing.
    """

    robot: Robot
    q: Array
    times: Array

    def shapes(self) -> list[Shape]:
        """The robot's visual shapes.

        Raises:
            InputError: There are none.
            MissingExtraError: trimesh is not installed.

        Warns:
            UrdfWarning: Some could not be read.
        """
        with needed_by("the shapes of a robot", "pictures"):
            from ..shapes.meshes import load_shapes  # over a second to import

        shapes, faults = load_shapes(self.robot)
        for fault in faults:
            warnings.warn(f"{self.robot.name}: {fault}", UrdfWarning, stacklevel=4)
        if not shapes:
            raise InputError(f"{self.robot.name} has no visual shapes that can be read", argument="shown")
        return shapes

    def places(self, link: str) -> tuple[Array, Array]:
        """A link's positions (n, 3) [m], and its orientations (n, 4) as quaternions (x, y, z, w)."""
        rows = np.array([pinocchio.SE3ToXYZQUAT(self.robot.placement(link, q)) for q in self.q])
        places, turns = rows[:, :3], rows[:, 3:]
        for k in range(1, len(turns)):  # q and −q are one orientation: the nearer one, so that it turns the short way
            if turns[k] @ turns[k - 1] < 0.0:
                turns[k] = -turns[k]
        return places, turns


def moving(shown: Shown, q: ArrayLike | None, times: ArrayLike | None) -> Moving:
    """What a file is to show.

    Args:
        shown: An answer, with its own robot and configurations; or a robot, with configurations in `q`.
        q: A configuration (nq,) or several (n, nq) of a robot; neutral when None.
        times: When it is at each (n,) [s], increasing; those of a track, or 30 a second, when None.

    Raises:
        InputError: `shown` is neither, or holds no configuration; or `q` or `times` do not fit it.
    """
    robot = getattr(shown, "robot", shown)
    if not isinstance(robot, Robot):
        raise InputError(f"must be a robot, a solution, a track or a self-motion; got an object of type "
                         f"{type(shown).__name__!r}", argument="shown")  # fmt: skip
    if q is not None and not isinstance(shown, Robot):
        raise InputError("must be left out, because the answer has its own configurations", argument="q")
    found = q if isinstance(shown, Robot) else shown.q
    rows = np.array(as_configurations(robot, found))
    if not len(rows):
        raise InputError("has no configuration to show", argument="shown")
    if times is None:
        own = shown.times if isinstance(shown, Track) else None
        when = np.asarray(_PERIOD * np.arange(len(rows)) if own is None else own[: len(rows)], dtype=np.float64)
    else:
        when = as_vector(times, len(rows), "times")
    if (np.diff(when) <= 0.0).any():
        raise InputError("must increase", argument="times")
    return Moving(robot, rows, when)


def check_suffix(path: str | os.PathLike[str], suffix: str) -> Path:
    """The path of a file.

    Raises:
        InputError: Its name does not end with `suffix`.
    """
    if Path(path).suffix.lower() != suffix:
        raise InputError(f"must end with {suffix!r}; got {os.fspath(path)!r}", argument="path")
    return Path(path)
