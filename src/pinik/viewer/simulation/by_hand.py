"""Joints moved by hand: the robots take the pose, and the balls follow by forward kinematics."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...checks import as_finite_number, as_point, as_vector
from ...errors import InputError
from ...model.joint import WIDEST_RANGE, Joint
from ...problem.target_values import rotation_of
from ...robot import Robot
from .session import Session

__all__ = ["angle_range", "set_angles"]

Array = NDArray[np.float64]

_SLACK = 1e-6  # [rad or m] by which rounded text may exceed a limit


def angle_range(robot: Robot, joint: Joint) -> tuple[float, float] | None:
    """The limits of a joint's own angle [rad or m], those of its followers included; None if it has none."""
    lower, upper = joint.angle_range(float(robot.lower_q[joint.idx_q]), float(robot.upper_q[joint.idx_q]))
    return (lower, upper) if joint.nq < 2 and upper - lower <= WIDEST_RANGE else None


def set_angles(session: Session, instance: int | None, angles: Mapping[str, float | Sequence[float]]) -> None:
    """Set joints of one visible instance, or of all; they lead from now on, and the balls follow the first of them.

    All instances together take the pose of the first one, with these joints changed. The motion becomes "hand".

    Args:
        session: The session.
        instance: The number of the instance, or None for all.
        angles: Joint name → angle [rad], position [m] for sliding joints, or for floating and planar joints, such as a
            free root, the placement [x, y, z, qx, qy, qz, qw]. Joints that are not named stay.

    Raises:
        UnknownNameError: There is no such joint.
        InputError: There is no such visible instance, no joint is named, one has no angle or follows another joint, an
            angle is not finite or is outside the limits while these are enforced, or a placement is none or leaves the
            plane of its joint.
    """
    led = range(session.view) if instance is None else [instance]
    q = session.instances.visible(led[0]).q.copy()
    if not angles:
        raise InputError("no joint is named whose angle is to be set")
    for name, angle in angles.items():
        joint = session.robot.settable_joint(name)
        if isinstance(angle, Sequence) and not joint.has_one_axis:
            joint.set_placement(q, _placement(angle, f"the placement of joint {name!r}"))
            continue
        number = as_finite_number(angle, f"the angle of joint {name!r}")
        _check(session, joint, number)
        joint.set_angle(q, number)
    for index in led:
        session.instances[index].pose(q)
    session.set_motion("hand")
    for ball in session.balls:
        if ball.mode != "off":
            ball.follow(session.robot.placement(ball.frame, q))
    session.leading.hold(led, session.balls.targets)


def _placement(numbers: Sequence[float], what: str) -> pinocchio.SE3:
    """A placement from [x, y, z, qx, qy, qz, qw]."""
    values = as_vector(numbers, 7, what, "x, y, z [m] and a quaternion xyzw")
    rotation = rotation_of(f"{what}: ", None, None, values[3:], None)
    assert rotation is not None
    return pinocchio.SE3(rotation, as_point(values[:3], what))


def _check(session: Session, joint: Joint, angle: float) -> None:
    """Refuse what a joint cannot do, or may not do while limits are enforced."""
    within = angle_range(session.robot, joint) if joint.has_one_axis and session.settings.limits else None
    lower, upper = within or (-WIDEST_RANGE, WIDEST_RANGE)
    if not lower - _SLACK <= angle <= upper + _SLACK:
        reason = "its limits are" if within else "it can be set"
        at, ends = _in_units(joint, angle), _in_units(joint, lower, upper)
        raise InputError(f"joint {joint.name!r} cannot be at {at}: {reason} from {ends}")


def _in_units(joint: Joint, *numbers: float) -> str:
    """A number or a range of a joint: in metres, or in radians and in degrees."""
    words = " to ".join(f"{number:g}" for number in numbers)
    if joint.kind == "prismatic":
        return f"{words} m"
    return f"{words} rad ({' to '.join(f'{math.degrees(number):.4g}°' for number in numbers)})"
