"""What a file shows: one robot or several side by side, where each is when, and the balls around them."""

from __future__ import annotations

import itertools
import os
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_file_name, as_vector
from ..errors import InputError, UrdfWarning
from ..model.home import robot_size
from ..picture.arguments import as_configurations
from ..picture.draw import ball_radius
from ..picture.poses import TINTS
from ..robot import Robot
from ..shapes.known import known_shapes
from ..solving.self_motion import SelfMotion
from ..solving.solution import Solution
from ..solving.track import Track
from .live_recording import LiveRecording, RecordedBall

if TYPE_CHECKING:
    from ..shapes.meshes import Shape

__all__ = ["ARM", "Actor", "Scene", "Shown", "check_suffix", "scene_of"]

Array = NDArray[np.float64]
Shown: TypeAlias = Robot | Solution | Track | SelfMotion | LiveRecording

ARM = 3.4
"""How long the axes of a ball that asks for an orientation are, of its radius."""

_PERIOD = 1.0 / 30.0  # [s] between configurations without times
_GAP = 0.08  # between neighbours, of their width
_SLENDER = 0.4  # the least distance of neighbours, of their height
_FRONT = 0.06  # between the robots and the plates with their names, of the robot's size


@dataclass(frozen=True, eq=False)
class Actor:
    """One robot that moves.

    Attributes:
        name: What tells it from others; empty if it is the only one.
        title: What is written in front of it; empty if nothing is.
        color: "#rrggbb", the colour in which it is written.
        q: The configurations (n, nq), at least one.
    """

    name: str
    title: str
    color: str
    q: Array

    def part(self, name: str) -> str:
        """The name of one of its parts."""
        return f"{self.name} {name}" if self.name else name


@dataclass(frozen=True, eq=False)
class Scene:
    """Robots of one kind that move, and the balls that each of them chases.

    Attributes:
        robot: The robot.
        times: When it is (n,) [s], increasing.
        actors: The robots, from left to right, as somebody in front of them sees it.
        balls: The balls, in each robot's own world.
    """

    robot: Robot
    times: Array
    actors: tuple[Actor, ...]
    balls: tuple[RecordedBall, ...] = ()

    @property
    def shapes(self) -> list[Shape]:
        """The robot's visual shapes.

        Raises:
            InputError: There are none.
            MissingExtraError: trimesh is not installed.
        """
        shapes, _ = known_shapes(self.robot)
        if not shapes:
            raise InputError(f"{self.robot.name} has no visual shapes that can be read", argument="shown")
        return shapes

    def warn(self) -> None:
        """Warn of the shapes that could not be read, in the name of the function that calls its caller.

        Warns:
            UrdfWarning: For each of them.
        """
        for fault in known_shapes(self.robot)[1]:
            warnings.warn(f"{self.robot.name}: {fault}", UrdfWarning, stacklevel=3)

    @cached_property
    def offsets(self) -> Array:
        """Where the world of each robot is in the file (k, 3) [m]: side by side, far enough apart for all they do."""
        low, high = self._extent
        width, _, height = (high - low)[[1, 0, 2]]
        apart = max((1.0 + _GAP) * width, _SLENDER * height)
        places = np.zeros((len(self.actors), 3))
        places[:, 1] = apart * (np.arange(len(places)) - (len(places) - 1) / 2)
        return places

    @property
    def plate(self) -> Array:
        """The middle of the lower edge of a robot's name, in its own world (3,) [m]: in front of it, on the ground."""
        low, high = self._extent
        return np.array([high[0] + _FRONT * robot_size(self.robot), (low[1] + high[1]) / 2, self._ground])

    @property
    def ball_radius(self) -> float:
        """[m]"""
        return ball_radius(self.robot)

    @cached_property
    def _extent(self) -> tuple[Array, Array]:
        """The lowest and the highest coordinates (3,) [m] of all robots and balls at any time, in their own worlds."""
        reach = [ball.positions + side * self.ball_radius for ball in self.balls for side in (-1.0, 1.0)]
        points = np.vstack([*(self._corners(actor.q) for actor in self.actors), *reach])
        return points.min(axis=0), points.max(axis=0)

    @cached_property
    def _ground(self) -> float:
        return float(min(self._corners(actor.q[:1])[:, 2].min() for actor in self.actors))

    def _corners(self, q: Array) -> Array:
        """The corners of the boxes around all shapes (m, 3) [m] at configurations (n, nq)."""
        corners = []
        for shape in self.shapes:
            box = np.array(np.meshgrid(*shape.mesh.bounds.T)).reshape(3, -1)
            own = shape.placement[:3, :3] @ box + shape.placement[:3, 3:]
            where = self.robot.placements(shape.link, q)
            corners.append((where[:, :3, :3] @ own + where[:, :3, 3:]).swapaxes(1, 2).reshape(-1, 3))
        return np.vstack(corners)


def scene_of(shown: Shown, q: ArrayLike | None, times: ArrayLike | None) -> Scene:
    """What a file is to show.

    Args:
        shown: A recording, or another answer with its own robot and configurations; or a robot, with configurations in
            `q`.
        q: A configuration (nq,) or several (n, nq) of a robot; its rest configuration when None.
        times: When it is at each (n,) [s], increasing; those of a track or a recording, or 30 a second, when None.

    Raises:
        InputError: `shown` is none of these, or holds no configuration; or `q` or `times` do not fit it.
    """
    robot = getattr(shown, "robot", shown)
    if not isinstance(shown, get_args(Shown)) or not isinstance(robot, Robot):
        raise InputError(f"must be a robot, a solution, a track, a self-motion or the recording() of a live view; got "
                         f"an object of type {type(shown).__name__!r}", argument="shown")  # fmt: skip
    if q is not None and not isinstance(shown, Robot):
        raise InputError("must be left out, because the answer has its own configurations", argument="q")
    if isinstance(shown, LiveRecording):
        return Scene(robot, _times(shown.times, times, len(shown.times)), _cast(shown), shown.balls)
    rows = np.array(as_configurations(robot, q if isinstance(shown, Robot) else shown.q))
    if not len(rows):
        raise InputError("has no configuration to show", argument="shown")
    own = shown.times if isinstance(shown, Track) else None
    return Scene(robot, _times(own, times, len(rows)), (Actor("", "", "", rows),))


def _times(own: Array | None, given: ArrayLike | None, count: int) -> Array:
    if given is None:
        return np.asarray(_PERIOD * np.arange(count) if own is None else own[:count], dtype=np.float64)
    when = as_vector(given, count, "times")
    if (np.diff(when) <= 0.0).any():
        raise InputError("must increase", argument="times")
    return when


def _cast(recording: LiveRecording) -> tuple[Actor, ...]:
    cast = zip(recording.names, recording.titles, itertools.cycle(TINTS), recording.q, strict=False)
    return tuple(Actor(*one) for one in cast)


def check_suffix(path: str | os.PathLike[str], suffix: str) -> Path:
    """The path of a file.

    Raises:
        InputError: It is no name of a file, or does not end with `suffix`.
    """
    file = as_file_name(path, "path", f"robot{suffix}")
    if file.suffix.lower() != suffix:
        raise InputError(f"must end with {suffix!r}; got {str(file)!r}", argument="path")
    return file
