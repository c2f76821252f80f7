"""Named configurations: the poses in an SRDF file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.numbers import FARTHEST, in_words, plain_number
from ..description.xml import MAX_BYTES, DocumentError, Element, parse
from ..errors import RobotLoadError
from ..files import FileError, read_within
from .joint import Joint

__all__ = ["read_poses"]

Array = NDArray[np.float64]

_ROUNDING = 1e-3  # [rad or m]: a pose this far outside the limits was rounded
_TURN = 2.0 * math.pi


def read_poses(srdf: Path, model: pinocchio.Model, joints: Iterable[Joint]) -> dict[str, Array]:
    """The poses in an SRDF file: name → q (nq,). Joints that a pose does not mention are neutral.

    Followers, and joints that the model does not have, are skipped. An angle outside the limits is taken at the limit
    if it is at most 1e-3 [rad or m] away, as files round their numbers, or turned by whole turns to inside the limits.

    Args:
        srdf: The SRDF file.
        model: Pinocchio's model with the robot's limits; it is not modified.
        joints: The joints of the model.

    Raises:
        RobotLoadError: The file cannot be read, or is not XML; or a pose has something else than a number for a joint,
            or a number outside its limits. The message names the pose and the joint.
    """
    try:
        robot = parse(read_within(srdf, MAX_BYTES, "an SRDF file"))
    except FileError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault}", source=str(srdf)) from None
    except DocumentError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault.message}", source=str(srdf)) from None
    by_name = {joint.name: joint for joint in joints}
    poses = {}
    for state in robot.named("group_state"):
        name = state.attributes.get("name", "")
        try:
            poses[name] = _pose(state, model, by_name)
        except DocumentError as fault:
            message = f"{fault.message} (line {fault.line})"
            raise RobotLoadError(message, source=str(srdf), element=f"pose {in_words(name)!r}, {fault.owner}") from None
    return poses


def _pose(state: Element, model: pinocchio.Model, joints: dict[str, Joint]) -> Array:
    q = np.array(pinocchio.neutral(model))
    for setting in state.named("joint"):
        joint = joints.get(setting.attributes.get("name", ""))
        if joint is None:
            continue
        values = _values(setting, joint)
        if not joint.has_one_axis:
            if len(values) == joint.nq:
                q[joint.idx_q : joint.idx_q + joint.nq] = values
        elif joint.leader is None:
            joint.set_angle(q, _within_limits(setting, joint, values[0], model))
    return np.array(pinocchio.normalize(model, q))


def _values(setting: Element, joint: Joint) -> list[float]:
    words = setting.attributes.get("value", "").split()
    values = [value for word in words if (value := plain_number(word)) is not None and abs(value) <= FARTHEST]
    needed = "a number" if joint.has_one_axis else "numbers"
    if len(values) < len(words) or not words or (joint.has_one_axis and len(words) > 1):
        given = in_words(setting.attributes.get("value", ""))
        raise _fault(setting, f"its value must be {needed} of at most {FARTHEST:g}; got {given!r}")
    return values


def _within_limits(setting: Element, joint: Joint, angle: float, model: pinocchio.Model) -> float:
    """The angle [rad or m], moved inside the limits where it was rounded, or is whole turns away."""
    if joint.nq != 1:
        return angle
    lower, upper = (float(bound[joint.idx_q]) for bound in (model.lowerPositionLimit, model.upperPositionLimit))
    turns = 0.0 if joint.kind == "prismatic" or lower <= angle <= upper else math.ceil((lower - angle) / _TURN)
    for same in (angle, angle + turns * _TURN):
        nearest = min(max(same, lower), upper)
        if abs(same - nearest) <= _ROUNDING:
            return nearest
    raise _fault(setting, f"its value must be within its limits {lower:g}..{upper:g}; got {angle:g}")


def _fault(setting: Element, cause: str) -> DocumentError:
    return DocumentError(cause, owner=f"joint {in_words(setting.attributes['name'])!r}", line=setting.line)
