"""The start of a solve as users give it, and the angles of continuous joints that are unwound from it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..checks import FARTHEST
from ..errors import InputError, RobotLoadError
from ..model.robot_model import RobotModel

__all__ = ["Origin", "as_start", "is_nearest", "not_by_name", "turned_near", "unwound", "unwound_path", "unwound_rows"]

Array = NDArray[np.float64]

_TURN = 2.0 * math.pi
_MOST_NAMED = 6
_NONE: Mapping[str, float] = {}


class Origin(NamedTuple):
    """The start of a solve.

    Attributes:
        q: The configuration (nq,).
        nearest: Whether the first attempt starts near the targets instead, from a table.
        turned: Joint name → angle [rad], for continuous joints that were given by their angle.
    """

    q: Array
    nearest: bool = False
    turned: Mapping[str, float] = _NONE

    @classmethod
    def of(cls, robot: RobotModel, q0: Any, *, searches: bool = True) -> Origin:
        """The start that `q0` stands for.

        Args:
            robot: The robot.
            q0: A configuration (nq,); angles by joint name [rad, or m for prismatic joints], with all other joints
                neutral; "nearest"; an Origin; or None for the neutral configuration.
            searches: Whether "nearest" is possible.

        Raises:
            UnknownNameError: There is no such joint.
            InputError: A wrong shape, or a value that cannot be used.
        """
        if is_nearest(q0) and not searches:
            raise InputError(
                "must be a configuration, or angles by joint name, from which the joints move on; got 'nearest', which "
                "solve, solve_many and prepared problems accept",
                argument="q0",
            )
        if isinstance(q0, Origin):
            return q0
        if q0 is None or is_nearest(q0):
            return cls(robot.neutral(), q0 is not None)
        if isinstance(q0, str):
            raise not_by_name(robot, q0, "q0", "must be a configuration, or angles by joint name")
        if isinstance(q0, Mapping):
            q = as_start(robot.configuration(q0))
            return cls(q, turned={name: float(angle) for name, angle in q0.items() if robot.joint(name).nq == 2})
        return cls(as_start(robot.check_configuration(q0, "q0")))


def not_by_name(robot: RobotModel, given: str, what: str, needed: str) -> InputError:
    """The error about a configuration that is given by a name; it says how the robot's poses are given.

    Args:
        robot: The robot.
        given: The name, which may be that of a pose.
        what: What the error message calls the argument.
        needed: What it must be.
    """
    poses: tuple[str, ...] = ()
    with contextlib.suppress(RobotLoadError):  # of poses that cannot be read
        poses = tuple(robot.srdf_poses)
    if given in poses:
        hint = f"the pose of this name is robot.poses[{given!r}]"
    elif poses:
        hint = f"the robot's poses are given as robot.poses[{poses[0]!r}]"
        hint += f", and likewise {', '.join(map(repr, poses[1:_MOST_NAMED]))}" if len(poses) > 1 else ""
    else:
        hint = "this robot has no named poses"
    return InputError(f"{needed}; got {given!r} ({hint})", argument=what)


def as_start(q: Array, what: str = "q0") -> Array:
    """One or many configurations (…, nq) as starts; InputError where a joint is farther away than 1e9 rad or m."""
    if np.abs(q).max(initial=0.0) > FARTHEST:
        raise InputError(f"must be within ±{FARTHEST:g} rad or m in each entry; got {q.tolist()}", argument=what)
    return q


def is_nearest(q0: object) -> bool:
    """Whether a start is the string "nearest"."""
    return isinstance(q0, str) and q0 == "nearest"


def unwound(robot: RobotModel, q: Array, start: Array, turned: Mapping[str, float] = _NONE) -> dict[str, float]:
    """The angles at `q`, with each continuous joint at the whole turn nearest to its start.

    Args:
        robot: The robot.
        q: The configuration (nq,).
        start: The start (nq,); it may be empty if no joint is (cos, sin) in q.
        turned: The start's angles of the continuous joints that were given by their angle.
    """
    angles = robot.angles(q)
    for joint in robot.joints:
        if joint.nq == 2 and joint.has_one_axis:
            near = turned.get(joint.name, joint.angle(start))
            angles[joint.name] = turned_near(angles[joint.name], near)
    return angles


def turned_near(angle: float, near: float) -> float:
    """An angle, turned by whole turns to be as near to `near` as possible [rad]."""
    return angle + _TURN * round((near - angle) / _TURN)


def unwound_rows(robot: RobotModel, q: Array, starts: Array, turned: Mapping[str, float] = _NONE) -> Array:
    """The angles (N, n_joints) at many configurations, in the order of `robot.joint_names`, unwound likewise.

    Args:
        robot: The robot.
        q: The configurations (N, nq).
        starts: Their starts (N, nq), or one for all (1, nq).
        turned: As for `unwound`.
    """
    angles = np.empty((len(q), len(robot.joint_names)))
    for column, name in zip(angles.T, robot.joint_names, strict=True):
        joint = robot.joint(name)
        if joint.nq == 1:
            column[:] = q[:, joint.idx_q]
            continue
        cosine, sine = joint.idx_q, joint.idx_q + 1
        near = turned.get(name, np.arctan2(starts[:, sine], starts[:, cosine]))
        column[:] = np.arctan2(q[:, sine], q[:, cosine])
        column += _TURN * np.round((near - column) / _TURN)
    return angles


def unwound_path(robot: RobotModel, q: Array, start: Array, turned: Mapping[str, float] = _NONE) -> Array:
    """The angles (N, n_joints) along a path; those of continuous joints go on beyond ±π, from the start's angles.

    Args:
        robot: The robot.
        q: The configurations (N, nq), in their order.
        start: The configuration (nq,) before them.
        turned: As for `unwound`.
    """
    angles = np.empty((len(q), len(robot.joint_names)))
    for column, name in zip(angles.T, robot.joint_names, strict=True):
        joint = robot.joint(name)
        if joint.nq == 1:
            column[:] = q[:, joint.idx_q]
            continue
        own = np.arctan2(q[:, joint.idx_q + 1], q[:, joint.idx_q])
        column[:] = np.unwrap(np.concatenate(([turned.get(name, joint.angle(start))], own)))[1:]
    return angles
