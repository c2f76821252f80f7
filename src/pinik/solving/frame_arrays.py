"""The placements and Jacobians of one frame at many configurations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..engine import load
from ..model.jacobians import as_reference_frame
from ..model.robot_model import RobotModel
from .native.kinematics import make_walk
from .native.module import why_not
from .processors import processors

__all__ = ["jacobians", "placements"]

if TYPE_CHECKING:
    from .. import _native

Array = NDArray[np.float64]


def placements(robot: RobotModel, frame: str, Q: ArrayLike, relative_to: str | None) -> Array:
    """The placements (N, 4, 4) of a frame; `Robot.placements` explains the arguments."""

    def at_once(walk: _native.FrameWalk, q: object) -> Array | None:
        return walk.placements(q, processors())

    def one(q: Array) -> Array:
        return np.array(robot.placement(frame, q, relative_to).homogeneous)

    return _at_many(robot, frame, Q, relative_to, at_once, one, (4, 4))


def jacobians(
    robot: RobotModel, frame: str, Q: ArrayLike, axes: str | pinocchio.ReferenceFrame, relative_to: str | None
) -> Array:
    """The Jacobians (N, 6, nv) of a frame; `Robot.jacobians` explains the arguments."""
    reference_frame = as_reference_frame(axes)

    def at_once(walk: _native.FrameWalk, q: object) -> Array | None:
        return walk.jacobians(q, load().ReferenceFrame[reference_frame.name], processors())

    def one(q: Array) -> Array:
        return robot.jacobian(frame, q, reference_frame, relative_to)

    return _at_many(robot, frame, Q, relative_to, at_once, one, (6, robot.model.nv))


def _at_many(
    robot: RobotModel,
    frame: str,
    Q: ArrayLike,
    relative_to: str | None,
    at_once: Callable[[_native.FrameWalk, object], Array | None],
    one: Callable[[Array], Array],
    shape: tuple[int, int],
) -> Array:
    """Results for all configurations, of the compiled engine or else of Pinocchio, one by one.

    The engine accepts only float64 arrays without faults. Everything else is checked and converted here first.
    """
    frame_id = robot.frame_id(frame)
    reference = None if relative_to is None else robot.frame_id(relative_to)
    walk = None if why_not() else make_walk(robot, frame_id, reference)
    found = None if walk is None else at_once(walk, Q)
    if found is not None:
        return found
    checked = robot.check_configurations(Q, "Q")
    found = None if walk is None else at_once(walk, checked)
    return np.array([one(q) for q in checked]).reshape(len(checked), *shape) if found is None else found
