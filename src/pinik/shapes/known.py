"""The visual shapes of robots, read once for each robot."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING

from ..description.flaw import Flaw
from ..extras import needed_by
from ..model.robot_model import RobotModel

if TYPE_CHECKING:
    from .meshes import Shape

__all__ = ["known_shapes"]

_KNOWN: weakref.WeakKeyDictionary[RobotModel, tuple[list[Shape], list[Flaw]]] = weakref.WeakKeyDictionary()


def known_shapes(robot: RobotModel) -> tuple[list[Shape], list[Flaw]]:
    """A robot's visual shapes, and what could not be read. Reading those of a large robot takes seconds.

    Raises:
        MissingExtraError: trimesh is not installed.
    """
    if robot not in _KNOWN:
        with needed_by("the shapes of a robot", "pictures"):
            from .meshes import load_shapes  # over a second to import

        _KNOWN[robot] = load_shapes(robot)
    return _KNOWN[robot]
