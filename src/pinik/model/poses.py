"""Named configurations: the poses in an SRDF file."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.flaw import Flaw
from ..description.numbers import FARTHEST, plain_number
from ..description.slips import is_slip
from ..description.xml import MAX_BYTES, DocumentError, Element, parse
from ..echoes import QUOTED, shortened
from ..errors import RobotLoadError, UnknownNameError
from ..files import FileError, read_within
from .configurations import LARGEST_UNIT_ERROR, UNIT_ROUNDING
from .joint import Joint

__all__ = ["Poses", "read_poses"]

Array = NDArray[np.float64]

_ROUNDING = 1e-3  # [rad or m]: a pose this far outside the limits was rounded
_TURN = 2.0 * math.pi
_MOST_NEAR = 3


@dataclass(frozen=True, eq=False)
class Poses(Mapping[str, Array]):
    """The poses in an SRDF file: name → q (nq,), read-only arrays.

    A name that is not there raises an `UnknownNameError`; if that pose is left out, the message says why.

    Attributes:
        left_out: Name → flaw of each pose that is left out because it sets a joint outside its limits. The flaw's
            element names pose and joint.
    """

    _by_name: dict[str, Array] = field(default_factory=dict)
    left_out: dict[str, Flaw] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Array:
        if name not in self._by_name:
            why = self.left_out.get(name)
            raise UnknownNameError("pose", name, self._by_name, hint="" if why is None else f"{why}")
        return self._by_name[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)


class _BeyondLimitsError(DocumentError):
    """A pose sets a joint outside its limits."""


def read_poses(srdf: Path, model: pinocchio.Model, joints: Iterable[Joint], names: Collection[str]) -> Poses:
    """The poses in an SRDF file. Joints that a pose does not mention are neutral.

    States of the same name for several groups are one pose. Followers, and joints that the robot does not have, are
    skipped, as robots with fewer joints share the SRDF. An angle outside the limits is taken at the limit if it is at
    most 1e-3 [rad or m] away, as files round their numbers, or turned by whole turns to inside the limits; a pose with
    one that is farther off is left out. A quaternion or (cos, sin) pair that was rounded is scaled to unit length.

    Args:
        srdf: The SRDF file.
        model: Pinocchio's model with the robot's limits; it is not modified.
        joints: The joints of the model.
        names: The names of all joints in the URDF, fixed ones too.

    Raises:
        RobotLoadError: The file cannot be read, or is not XML; or a pose has something else than numbers for a joint,
            or sets it in two ways, or one that is misspelt, or gives it a quaternion that is not of unit length; or
            there are two states of the same name and group. The message names the pose and the joint.
    """
    try:
        robot = parse(read_within(srdf, MAX_BYTES, "an SRDF file"))
    except FileError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault}", source=str(srdf)) from None
    except DocumentError as fault:
        raise RobotLoadError(f"the SRDF cannot be read: {fault.message}", source=str(srdf)) from None
    by_name = {joint.name: joint for joint in joints}
    states: dict[str, list[Element]] = {}
    for state in robot.named("group_state"):
        states.setdefault(state.attributes.get("name", ""), []).append(state)
    poses: dict[str, Array] = {}
    left_out: dict[str, Flaw] = {}
    for name, parts in states.items():
        pose = f"pose {shortened(name, QUOTED)!r}"
        try:
            poses[name] = _pose(_settings(parts), model, by_name, names)
            poses[name].setflags(write=False)
        except _BeyondLimitsError as fault:
            left_out[name] = Flaw(
                f"{pose}, {fault.owner}",
                f"{fault.message} (line {fault.line} of {srdf.name}); the pose is left out",
                code="pose-outside-limits",
                common="its value is outside its limits; the pose is left out",
            )
        except DocumentError as fault:
            message = f"{fault.message} (line {fault.line})"
            element = pose + (f", {fault.owner}" if fault.owner else "")
            raise RobotLoadError(message, source=str(srdf), element=element) from None
    return Poses(poses, left_out)


def _settings(states: Iterable[Element]) -> list[Element]:
    """The `<joint>` elements of all states of one name.

    Raises:
        DocumentError: Two of them are for the same group.
    """
    first: dict[str, Element] = {}
    for state in states:
        group = state.attributes.get("group", "")
        other = first.setdefault(group, state)
        if other is not state:
            cause = f"it is given twice for group {shortened(group, QUOTED)!r}, first on line {other.line}"
            raise DocumentError(cause, line=state.line)
    return [setting for state in first.values() for setting in state.named("joint")]


def _pose(
    settings: Iterable[Element], model: pinocchio.Model, joints: dict[str, Joint], names: Collection[str]
) -> Array:
    q = np.array(pinocchio.neutral(model))
    by_joint: dict[str, list[Element]] = {}
    for setting in settings:
        by_joint.setdefault(setting.attributes.get("name", ""), []).append(setting)
    for name, same in by_joint.items():
        joint = joints.get(name)
        if joint is None:
            _check_known(same[0], {*joints, *names}, by_joint)
            continue
        values, *others = (_values(setting, joint) for setting in same)
        for setting, other in zip(same[1:], others, strict=True):
            if other != values:
                raise _fault(setting, f"it is set twice, to {_shown(values)} and to {_shown(other)}")
        if not joint.has_one_axis:
            if len(values) == joint.nq:
                q[joint.idx_q : joint.idx_q + joint.nq] = values
                _scale(same[0], joint, q)
            elif name in names:  # the root's own joint is none of the file's: a pose may be for another kind of root
                needed = f"must be {joint.nq} numbers, as many as a {joint.kind} joint has in q"
                raise _fault(same[0], f"its value {needed}; got {len(values)}")
        elif joint.leader is None:
            joint.set_angle(q, _within_limits(same[0], joint, values[0], model))
    return q


def _scale(setting: Element, joint: Joint, q: Array) -> None:
    """Scale a joint's quaternion or (cos, sin) pair in `q` to unit length, as `configurations.checked` does.

    Raises:
        DocumentError: It is farther from unit length than rounding makes it.
    """
    circle = joint.circle(q)
    if circle is None:
        return
    own, words = circle
    squared = float(own @ own)
    if not abs(squared - 1.0) <= LARGEST_UNIT_ERROR:
        raise _fault(setting, f"{words} must be of unit length; got {_shown(own.tolist())}")
    if abs(squared - 1.0) > UNIT_ROUNDING:
        own /= math.sqrt(squared)


def _check_known(setting: Element, known: Collection[str], given: Collection[str]) -> None:
    """Refuse a joint that the robot does not have if its name is a slip for one that the pose does not set."""
    name = setting.attributes.get("name", "")
    near = [] if name in known else [one for one in known if one not in given and is_slip(name, one)]
    if near:
        shown = " and ".join(repr(shortened(one, QUOTED)) for one in sorted(near)[:_MOST_NEAR])
        raise _fault(setting, f"the robot has no such joint (near: {shown}, which the pose does not set)")


def _shown(values: Iterable[float]) -> str:
    return " ".join(f"{value:g}" for value in values)


def _values(setting: Element, joint: Joint) -> list[float]:
    words = setting.attributes.get("value", "").split()
    values = [value for word in words if (value := plain_number(word)) is not None and abs(value) <= FARTHEST]
    needed = "a number" if joint.has_one_axis else "numbers"
    if len(values) < len(words) or not words or (joint.has_one_axis and len(words) > 1):
        given = shortened(setting.attributes.get("value", ""), QUOTED)
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
    cause = f"its value must be within its limits {lower:g}..{upper:g}; got {angle:g}"
    raise _fault(setting, cause, _BeyondLimitsError)


def _fault(setting: Element, cause: str, kind: type[DocumentError] = DocumentError) -> DocumentError:
    return kind(cause, owner=f"joint {shortened(setting.attributes.get('name', ''), QUOTED)!r}", line=setting.line)
