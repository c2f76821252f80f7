"""Read and check a `<joint>`: its origin, axis, limits, dynamics and mimic."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field

from ..echoes import QUOTED, shortened
from .flaw import Flaw
from .numbers import FARTHEST
from .part import Part, Vector
from .slips import meant, misspelt
from .vocabulary import BOUNDED_KINDS, URDF
from .xml import DocumentError, Element

__all__ = ["ENDLESS", "JOINT_KINDS", "ONE_AXIS_KINDS", "JointTag", "Mimic", "read_joint"]

# [rad or m]: how SDF and Gazebo write that there is no limit; larger ones are read as infinite.
ENDLESS = 1e16

_MOST_IGNORED = 4
_ROUNDING = 4.0 * sys.float_info.epsilon
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
        axis: The unit axis in the joint's frame, which is the normal of a planar joint's plane; (1, 0, 0) if the file
            gives none.
        lower: The lower limit [rad or m], which may be -inf; None if the file gives none, or joints of this kind have
            none.
        upper: The upper limit, likewise; it may be inf.
        mimic: How it follows another joint, if it does.
        effort: The largest effort [N m or N]; None if the file gives none.
        velocity: The largest velocity [rad/s or m/s], likewise.
        damping: Viscous friction [N m s/rad or N s/m], likewise.
        friction: Dry friction [N m or N], likewise.
        line: The line on which it begins, which makes no difference to the joint; None if it is of no file.
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
    line: int | None = field(default=None, compare=False)


def read_joint(element: Element, flaws: list[Flaw], document: bytes) -> JointTag:
    """Read and check a `<joint>` of a document. What is left out or assumed is added to `flaws`.

    Raises:
        DocumentError: Something that decides where links are cannot be read, can be read in two ways, or is missing.
    """
    joint = Part.named(element, flaws, document)
    kind = _read_kind(joint)
    xyz, rpy = joint.origin()
    # Reduced robots often have fixed joints with a mimic left on them.
    mimic, dynamics, limit = joint.only("mimic"), joint.only("dynamics"), joint.only("limit")
    lower, upper = _read_limits(joint, limit, kind)
    has_axis = kind in ONE_AXIS_KINDS
    return JointTag(
        name=joint.name,
        kind=kind,
        parent=_linked(joint, "parent"),
        child=_linked(joint, "child"),
        xyz=xyz,
        rpy=rpy,
        axis=_read_axis(joint, kind),
        lower=lower,
        upper=upper,
        mimic=None if mimic is None or kind == "fixed" else _read_mimic(mimic),
        effort=_strength(limit, "effort", "effort") if has_axis else None,
        velocity=_strength(limit, "velocity", "speed") if has_axis else None,
        damping=_strength(dynamics, "damping", "number", may_be_negative=True),
        friction=_strength(dynamics, "friction", "number"),
        line=element.line,
    )


def _read_kind(joint: Part) -> str:
    """The type; one with white space around it is a flaw."""
    written = joint.text("type")
    kind = written.strip()
    if kind not in JOINT_KINDS:
        near = meant(kind, JOINT_KINDS)
        advice = f"did you mean {near!r}?" if near else f"it must be one of {', '.join(JOINT_KINDS)}"
        raise joint.fault(f"unknown type {shortened(written, QUOTED)!r}; {advice}")
    if kind != written:
        cause = f"its type {shortened(written, QUOTED)!r} has white space around it; it is read as {kind!r}"
        common = f"its type has white space around it; it is read as {kind!r}"
        joint.misread("type", cause, kind, code="loose-type", common=common)
    return kind


def _read_mimic(mimic: Part) -> Mimic:
    multiplier = mimic.number("multiplier")
    return Mimic(
        leader=mimic.text("joint"),
        multiplier=1.0 if multiplier is None else multiplier,
        offset=mimic.number("offset", "angle") or 0.0,
    )


def _read_axis(joint: Part, kind: str) -> Vector:
    """The unit axis; scaled before it is normalised, so that squares neither overflow nor underflow.

    An axis that is one long already stays as it is written.
    """
    default = (1.0, 0.0, 0.0)
    axis = joint.only("axis")
    if axis is None and kind == "planar":
        cause = "it has no <axis>, for which URDF's default is x; it moves in the yz-plane of its frame"
        joint.flaw(cause, code="planar-axis", mend='Write <axis xyz="0 0 1"/> if it moves in the xy-plane.')
    # Exporters write "0 0 0" for joints without an axis, where it has no meaning.
    if axis is None or kind in ("fixed", "floating"):
        return default
    axis.text("xyz")
    x, y, z = axis.vector("xyz", "axis", default)
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        raise axis.bad_value("xyz", "the axis is zero")
    if abs(math.hypot(x, y, z) - 1.0) <= _ROUNDING:
        return (x, y, z)
    x, y, z = x / largest, y / largest, z / largest
    length = math.hypot(x, y, z)
    return (x / length, y / length, z / length)


def _read_limits(joint: Part, limit: Part | None, kind: str) -> tuple[float | None, float | None]:
    """The lower and upper limit; None for each that is not given."""
    bounded = kind in BOUNDED_KINDS
    if limit is None:
        if bounded:
            raise joint.fault(f"a {kind} joint needs a <limit> element")
        return None, None
    if kind in ("floating", "planar"):
        limit.flaw(f"a {kind} joint has no limits here; its <limit> is ignored", code="limit-ignored")
    if not bounded:
        return None, None
    lower, upper = _bounds(limit, kind)
    absent = [name for name, value in (("lower", lower), ("upper", upper)) if value is None]
    # The warning about a misspelt or misplaced attribute says already what is taken instead.
    unsaid = [name for name in absent if name not in misspelt(limit.element) | joint.element.attributes.keys()]
    if unsaid:
        bounds = f"{lower or 0.0:g}..{upper or 0.0:g}"
        cause = f"<limit> has no {' and no '.join(unsaid)}, which is read as 0: its range is {bounds}"
        limit.flaw(cause + _ignored(limit.element), code="absent-limit")
    low, high = lower or 0.0, upper or 0.0
    if low > high:
        note = f" (no {absent[0]} is given, which is read as 0)" if absent else ""
        raise limit.fault(
            f"lower limit {low:g} is above upper limit {high:g}{note}; either the two are swapped, and the range is "
            f"{high:g}..{low:g}, or one of them is wrong"
        )
    return lower, upper


def _ignored(limit: Element) -> str:
    """The attributes of a limit that URDF does not know, as the rest of a sentence."""
    known = URDF["limit"].attributes
    names = [f"{shortened(name, QUOTED)}=" for name in limit.attributes if name not in known and ":" not in name]
    return f"; URDF does not know its {' and '.join(names[:_MOST_IGNORED])}" if names else ""


def _bounds(limit: Part, kind: str) -> list[float | None]:
    """The two limits [rad or m], each infinite if the file says so, or gives a number that no joint can reach."""
    bounds: list[float | None] = []
    endless = []
    for attribute in ("lower", "upper"):
        value = limit.number(attribute, "length" if kind == "prismatic" else "angle", infinite=True)
        if value is not None and abs(value) > ENDLESS:
            written = f'{attribute}="{shortened(limit.element.attributes[attribute], QUOTED)}"'
            endless.append(f"{written} is {'infinite' if math.isinf(value) else f'beyond {ENDLESS:g}'}")
            value = math.copysign(math.inf, value)
        bounds.append(value)
    if endless:
        end = "it is read as no limit" if len(endless) == 1 else "they are read as no limits"
        common = f"a limit is infinite or beyond {ENDLESS:g}; it is read as no limit"
        turns = len(endless) == 2 and kind == "revolute"
        mend = 'Write type="continuous" if the joint turns without an end.' if turns else ""
        limit.flaw(f"<limit> {' and '.join(endless)}; {end}", code="endless-limit", common=common, mend=mend)
    return bounds


def _strength(part: Part | None, attribute: str, quantity: str, *, may_be_negative: bool = False) -> float | None:
    """The largest effort or velocity, or a friction; None if it is not given or no use, which is a flaw.

    Kinematics does without it. A number beyond 1e12 limits nothing, and is left out in silence.
    """
    if part is None:
        return None
    try:
        value = part.number(attribute, quantity, infinite=True)
        if value is not None and value < 0.0 and not may_be_negative:
            raise part.bad_value(attribute, "it must not be negative")
    except DocumentError as fault:
        common = f"<{part.element.tag} {attribute}> cannot be read; it is ignored"
        part.flaw(f"{fault.message}; it is ignored", code="bad-strength", common=common)
        return None
    return value if value is not None and abs(value) <= FARTHEST else None


def _linked(joint: Part, tag: str) -> str:
    """The link that `<parent>` or `<child>` names.

    Raises:
        DocumentError: There is no such element, it names no link, or several name different links.
    """
    names = list(dict.fromkeys(joint.of(element).text("link") for element in joint.element.named(tag)))
    if len(names) > 1:
        raise joint.fault(f"has {len(names)} <{tag}> elements, for link {' and for link '.join(map(repr, names))}")
    element = joint.only(tag)
    if element is None:
        raise joint.fault(f"has no <{tag}> element")
    return element.text("link")
