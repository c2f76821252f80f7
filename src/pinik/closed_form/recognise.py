"""The recognition of two parallel hinges of a robot as two bones in a plane."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import InputError
from ..model.chains import Chain, chain_of
from ..model.joint import Joint
from ..model.robot_model import RobotModel

__all__ = ["Bones", "recognise"]

Array = NDArray[np.float64]

_LARGEST_TILT = 1e-5  # [rad]: how far a rounded 1.5708 or 3.14159 in a URDF may turn an axis
_NO_LENGTH = 1e-9  # of the longer bone
_MOST_NAMED = 3  # joints that an error message lists


class Bones(NamedTuple):
    """Two parallel hinges, and the two bones between them and a frame.

    Attributes:
        joints: The two joints, base first.
        l1, l2: The bones' lengths: from axis to axis, and from the second axis to the frame or its tool [m].
        origin: The point (3,) on the first axis that lies in the plane of motion [m].
        axes: (3, 3), with columns x along the first bone at angle 0, y, and z along the first joint's axis.
        bend: γ, the angle between the bones when the second joint is at 0 [rad].
        sense: σ, 1 where the axes point the same way, −1 where they are opposed.
        tilt: The angle by which the axes differ from parallel [rad].
    """

    joints: tuple[Joint, Joint]
    l1: float
    l2: float
    origin: Array
    axes: Array
    bend: float
    sense: float
    tilt: float


def recognise(robot: RobotModel, frame: str, tool: pinocchio.SE3 | None, relative_to: str | None) -> Bones:
    """The two bones that move a frame.

    Args:
        robot: The robot.
        frame: The name of the frame.
        tool: The point of interest in the frame; its origin when None.
        relative_to: The frame in which `origin` and `axes` are expressed; the world when None.

    Raises:
        UnknownNameError: No such frame.
        InputError: The frame is not moved by two parallel hinges alone; the message says why.
    """
    moved, reference = robot.frame_id(frame), None if relative_to is None else robot.frame_id(relative_to)
    chain = chain_of(robot.model, robot.joints, moved, reference, tool)
    first, second = joints = _two_hinges(chain, frame, relative_to)
    shank, end = robot.model.jointPlacements[second.id], chain.frame_placement.translation
    axis, own_axis = np.array(first.axis), np.array(second.axis)
    sense, tilt = _alignment(axis, shank.rotation @ own_axis)
    if tilt > _LARGEST_TILT:
        raise _refusal(frame, f"the axes of {first.name!r} and {second.name!r} are {_degrees(tilt)} from parallel")
    bone, tip = _across(shank.translation, axis), shank.rotation @ _across(end, own_axis)
    l1, l2 = float(np.linalg.norm(bone)), float(np.linalg.norm(tip))
    if l1 <= _NO_LENGTH * l2:
        raise _refusal(frame, f"joints {first.name!r} and {second.name!r} turn about the same line")
    if l2 <= _NO_LENGTH * l1:
        raise _refusal(frame, f"it lies on the axis of joint {second.name!r}, which cannot move it; give a tool")
    x = bone / l1
    y = np.cross(axis, x)
    base = robot.model.jointPlacements[first.id]
    if chain.reference_placement is not None:
        base = chain.reference_placement.actInv(base)
    rise = float(axis @ shank.translation) + sense * float(own_axis @ end)
    return Bones(
        joints,
        l1,
        l2,
        origin=base.act(rise * axis),
        axes=base.rotation @ np.column_stack([x, y, axis]),
        bend=math.atan2(float(tip @ y), float(tip @ x)),
        sense=sense,
        tilt=tilt,
    )


def _alignment(axis: Array, other: Array) -> tuple[float, float]:
    """1 or −1, as two unit axes point the same or the opposite way, and the angle that they are from parallel [rad]."""
    along = float(axis @ other)
    return math.copysign(1.0, along), math.atan2(float(np.linalg.norm(np.cross(axis, other))), abs(along))


def _two_hinges(chain: Chain, frame: str, relative_to: str | None) -> tuple[Joint, Joint]:
    """The two hinges of the chain that moves a frame, base first.

    Raises:
        InputError: Other joints move it, or none does; the message names them.
    """
    movers = chain.joints
    seen = "" if relative_to is None else f" relative to {relative_to!r}"
    if not chain.is_one_branch:
        raise _refusal(frame, f"{relative_to!r} is moved by joints that do not move {frame!r}")
    names = ", ".join(f"{joint.name!r} ({joint.kind})" for joint in movers[:_MOST_NAMED])
    if len(movers) > _MOST_NAMED:
        names += f" and {len(movers) - _MOST_NAMED} more"
    if len(movers) != 2:
        number = {0: "no joint moves", 1: "only one joint moves"}.get(len(movers), f"{len(movers)} joints move")
        raise _refusal(frame, f"{number} it{seen}" + (f": {names}" if movers else ""))
    for joint in movers:
        if joint.kind not in ("revolute", "continuous"):
            raise _refusal(frame, f"joint {joint.name!r} is {joint.kind}")
        if joint.leader is not None:
            raise _refusal(frame, f"joint {joint.name!r} mimics {joint.leader!r}")
    return movers[0], movers[1]


def _refusal(frame: str, reason: str) -> InputError:
    return InputError(f"frame {frame!r} is not moved by two parallel hinges alone: {reason}")


def _across(vector: Array, axis: Array) -> Array:
    """The part of a vector across a unit axis."""
    return np.array(vector - (vector @ axis) * axis)


def _degrees(radians: float) -> str:
    return f"{math.degrees(radians):.3g}°"
