"""Read and check a `<joint>`: its origin, axis, limits, dynamics and mimic."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .flaw import Flaw
from .values import Vector, attribute_text, bad_value, number, only_child, read_origin, required_name, vector
from .xml import DocumentError, Element

__all__ = ["ONE_AXIS_KINDS", "JointTag", "Mimic", "read_joint"]

JOINT_KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
ONE_AXIS_KINDS = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True)
class Mimic:
    """How a joint follows another: angle = multiplier · leader's angle + offset.

    Attributes:
        leader: The name of the joint that it follows.
        multiplier: The follower's rad or m per rad or m of the leader.
        offset: The follower's angle when the leader is at 0 [rad or m].
    """

    leader: str
    multiplier: float
    offset: float

    def after(self, leaders: Mimic) -> Mimic:
        """The mimic of a joint whose leader follows another by the mimic `leaders`: how it follows that other joint."""
        multiplier = self.multiplier * leaders.multiplier
        return Mimic(leaders.leader, multiplier, self.multiplier * leaders.offset + self.offset)


@dataclass(frozen=True)
class JointTag:
    """One `<joint>`.

    Attributes:
        name: Its name.
        kind: "revolute", "continuous", "prismatic", "fixed", "floating" or "planar".
        parent: The parent link.
        child: The child link.
        xyz: The joint's origin in the parent link's frame [m].
        rpy: The joint's orientation in the parent link's frame: fixed-axis roll, pitch, yaw [rad].
        axis: The unit axis in the joint's frame; (1, 0, 0) if the file gives none.
        lower: The lower limit [rad or m]; None if the file gives none, or joints of this kind have none.
        upper: The upper limit, likewise.
        mimic: How it follows another joint, if it does.
        effort: The largest effort [N m or N]; None if the file gives none.
        velocity: The largest velocity [rad/s or m/s], likewise.
        damping: Viscous friction [N m s/rad or N s/m], likewise.
        friction: Dry friction [N m or N], likewise.
    """

    name: str
    kind: str
    parent: str
    child: str
    xyz: Vector
    rpy: Vector
    axis: Vector
    lower: float | None
    upper: float | None
    mimic: Mimic | None
    effort: float | None = None
    velocity: float | None = None
    damping: float | None = None
    friction: float | None = None


def read_joint(element: Element, warnings: list[str]) -> JointTag:
    """Read and check a `<joint>`. Doubtful values are named in `warnings`, which is appended to.

    Raises:
        DocumentError: A number is malformed or not finite, a required part is missing, or the type is unknown.
    """
    name = required_name(element)
    owner = f"joint {name!r}"
    kind = attribute_text(element, "type", owner)
    if kind not in JOINT_KINDS:
        raise DocumentError(
            f"unknown type {kind!r}; it must be one of {', '.join(JOINT_KINDS)}", owner=owner, line=element.line
        )
    xyz, rpy = read_origin(element, owner)
    mimic = only_child(element, "mimic", owner)
    dynamics = only_child(element, "dynamics", owner) or Element("dynamics", {}, element.line)
    lower, upper, effort, velocity = _read_limit(element, kind, owner, warnings)
    friction = number(dynamics, "friction", owner)
    if friction is not None and friction < 0.0:
        raise bad_value(dynamics, "friction", owner, "it must not be negative")
    return JointTag(
        name=name,
        kind=kind,
        parent=_linked(element, "parent", owner),
        child=_linked(element, "child", owner),
        xyz=xyz,
        rpy=rpy,
        axis=_read_axis(element, kind, owner, warnings),
        lower=lower,
        upper=upper,
        mimic=None if mimic is None else _read_mimic(mimic, owner),
        effort=effort,
        velocity=velocity,
        damping=number(dynamics, "damping", owner),
        friction=friction,
    )


def _read_mimic(element: Element, owner: str) -> Mimic:
    multiplier = number(element, "multiplier", owner)
    return Mimic(
        leader=attribute_text(element, "joint", owner),
        multiplier=1.0 if multiplier is None else multiplier,
        offset=number(element, "offset", owner) or 0.0,
    )


def _read_axis(joint: Element, kind: str, owner: str, warnings: list[str]) -> Vector:
    """The unit axis; scaled before it is normalised, so that squares neither overflow nor underflow."""
    default = (1.0, 0.0, 0.0)
    element = only_child(joint, "axis", owner)
    # Exporters write "0 0 0" for joints without an axis, where it has no meaning.
    if element is None or kind in ("fixed", "floating"):
        return default
    attribute_text(element, "xyz", owner)
    x, y, z = vector(element, "xyz", owner, default)
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        raise bad_value(element, "xyz", owner, "the axis is zero")
    x, y, z = x / largest, y / largest, z / largest
    length = math.hypot(x, y, z)
    axis = (x / length, y / length, z / length)
    if kind == "planar" and axis != (0.0, 0.0, 1.0):
        cause = "a planar joint moves in the xy-plane of its own frame here; its axis is ignored"
        warnings.append(Flaw(owner, cause, code="planar-axis", line=element.line))
    return axis


def _read_limit(
    joint: Element, kind: str, owner: str, warnings: list[str]
) -> tuple[float | None, float | None, float | None, float | None]:
    """The lower and upper limit, effort and velocity; None for each that is not given."""
    element = only_child(joint, "limit", owner)
    bounded = kind in ("revolute", "prismatic")
    if element is None:
        if bounded:
            raise DocumentError(f"a {kind} joint needs a <limit> element", owner=owner, line=joint.line)
        return None, None, None, None
    if kind not in ONE_AXIS_KINDS:
        return None, None, None, None
    effort, velocity = (number(element, attribute, owner) for attribute in ("effort", "velocity"))
    for attribute, value in (("effort", effort), ("velocity", velocity)):
        if value is not None and value < 0.0:
            raise bad_value(element, attribute, owner, "it must not be negative")
    if not bounded:
        return None, None, effort, velocity
    lower, upper = number(element, "lower", owner), number(element, "upper", owner)
    absent = [name for name, value in (("lower", lower), ("upper", upper)) if value is None]
    if absent:
        bounds = f"{lower or 0.0:g}..{upper or 0.0:g}"
        cause = f"<limit> has no {' and no '.join(absent)}, which is read as 0: its range is {bounds}"
        warnings.append(Flaw(owner, cause, code="absent-limit", line=element.line))
    if (lower or 0.0) > (upper or 0.0):
        note = f" (no {absent[0]} is given, which is read as 0)" if absent else ""
        raise DocumentError(
            f"lower limit {lower or 0.0:g} is above upper limit {upper or 0.0:g}{note}",
            owner=owner,
            line=element.line,
        )
    return lower, upper, effort, velocity


def _linked(joint: Element, tag: str, owner: str) -> str:
    """The link that `<parent>` or `<child>` names."""
    element = only_child(joint, tag, owner)
    if element is None:
        raise DocumentError(f"has no <{tag}> element", owner=owner, line=joint.line)
    return attribute_text(element, "link", owner)
