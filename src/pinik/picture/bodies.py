"""The surfaces in a picture: a robot's shapes at one configuration, or its skeleton."""

from __future__ import annotations

import warnings
import weakref
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..description.flaw import Flaw
from ..errors import UrdfWarning
from ..model.home import robot_size
from ..robot import Robot
from ..shapes.known import known_shapes
from .solids import Solid, ball, rod

__all__ = ["Body", "bodies_of", "read_parts"]

Array = NDArray[np.float64]

_BONE = np.array([0.553, 0.596, 0.647])  # the colours of a skeleton in the live view
_JOINT = np.array([0.122, 0.435, 0.769])


@dataclass(frozen=True, eq=False)
class Body:
    """A surface in one colour.

    Attributes:
        solid: Its triangles in the world.
        color: Red, green, blue (3,), each in 0..1.
        opacity: In 0..1.
        gloss: The strength of its highlights, in 0..1.
        glow: The light that it emits, which keeps its colour in the shade.
        link: The name of the link that it belongs to; empty if there is none.
        ghost: Whether it is not there, but could be: it casts no shadow, and whatever is opaque and no scenery covers
            it, even from behind.
        scenery: Whether it is one of the things around the robots, in front of which ghosts are seen.
    """

    solid: Solid
    color: Array
    opacity: float = 1.0
    gloss: float = 0.15
    glow: float = 0.0
    link: str = ""
    ghost: bool = False
    scenery: bool = False


@dataclass(frozen=True, eq=False)
class _Part:
    """A shape in its link's frame."""

    link: str
    solid: Solid
    color: Array
    opacity: float


_PARTS: weakref.WeakKeyDictionary[Robot, list[_Part]] = weakref.WeakKeyDictionary()


def bodies_of(robot: Robot, q: Array) -> list[Body]:
    """A robot's shapes at `q` (nq,), or its skeleton if it has no shapes.

    Warns:
        UrdfWarning: Some shapes could not be read. Given once for each robot.
    """
    for fault in read_parts(robot):
        warnings.warn(f"{robot.name}: {fault}", UrdfWarning, stacklevel=4)
    parts = _PARTS[robot]
    if not parts:
        return list(_skeleton(robot, q))
    places = {part.link: robot.placement(part.link, q) for part in parts}
    return [
        Body(
            part.solid.moved(places[part.link].rotation, places[part.link].translation),
            part.color,
            part.opacity,
            link=part.link,
        )
        for part in parts
    ]


def read_parts(robot: Robot) -> list[Flaw]:
    """Read a robot's shapes, and return what could not be read; nothing if they are read already."""
    if robot in _PARTS:
        return []
    shapes, faults = known_shapes(robot)
    _PARTS[robot] = [
        _Part(
            shape.link,
            Solid.of(shape.mesh).moved(shape.placement[:3, :3], shape.placement[:3, 3]),
            np.clip(shape.color[:3], 0.0, 1.0),
            float(np.clip(shape.color[3], 0.0, 1.0)),
        )
        for shape in shapes
    ]
    return faults


def _skeleton(robot: Robot, q: Array) -> Iterable[Body]:
    """Spheres at the joints and rods between them, as in the live view."""
    model = robot.model
    size = robot_size(robot)
    radius = 0.018 * size
    robot.placement(robot.frame_names[0], q)  # updates the joints' placements
    joints = [joint.copy() for joint in robot.data.oMi]
    for joint_id, joint in enumerate(joints):
        yield Body(ball(joint.translation, radius), _JOINT if joint_id else _BONE)
    ways = [(joints[model.parents[k]].translation, joints[k].translation) for k in range(1, model.njoints)]
    for name in robot.description.links:
        link = model.frames[robot.frame_id(name)]
        if np.linalg.norm(link.placement.translation) > 0.01 * size:
            # A link whose frame lies away from its joint, such as a tool's tip, ends another rod.
            ways.append((joints[link.parentJoint].translation, robot.placement(name, q).translation))
    for start, end in ways:
        if np.linalg.norm(end - start) > 1e-4 * size:
            yield Body(rod(start, end, 0.55 * radius, 0.385 * radius), _BONE)
