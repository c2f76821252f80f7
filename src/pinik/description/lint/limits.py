"""Joint limits that exclude 0, leave no travel, or ask more of a leader than its follower can do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..flaw import Flaw
from ..joints import JointTag, Mimic
from ..vocabulary import BOUNDED_KINDS, URDF
from ..xml import Element
from .plain import JointValues, joint_values, named, plain_numbers

__all__ = ["followers", "limits"]

_SLACK = 1e-3  # of a follower's travel: files round their limits
_ONE_VALUE = 1e-9  # [rad or m]: a range this narrow holds a single value


def limits(robot: Element) -> Iterator[Flaw]:
    """The flaws of the limits of single joints."""
    for joint in joint_values(robot):
        yield from _soft_limits(joint)
        lower, upper = joint.lower, joint.upper
        if joint.kind not in BOUNDED_KINDS or lower is None or upper is None or lower > upper:
            continue
        if lower == upper and _is_meant(joint):
            yield Flaw(
                joint.owner,
                f"its lower and its upper limit are both {lower:g}, so that it cannot move",
                code="no-travel",
                line=joint.line,
                common="its lower and its upper limit are the same, so that it cannot move",
            )
        elif lower < upper and not lower <= 0.0 <= upper:
            yield Flaw(
                joint.owner,
                f"0 lies outside its limits {lower:g}…{upper:g}",
                code="zero-outside-limits",
                line=joint.line,
                common="0 lies outside its limits",
            )


def _soft_limits(joint: JointValues) -> Iterator[Flaw]:
    """Soft limits of which the lower one is above the upper one; one that is missing is 0."""
    for controller in joint.element.named("safety_controller"):
        ends = [
            plain_numbers(controller.attributes.get(name, "0")) for name in ("soft_lower_limit", "soft_upper_limit")
        ]
        lower, upper = (end[0] if end is not None and len(end) == 1 else None for end in ends)
        if lower is not None and upper is not None and lower > upper:
            yield Flaw(
                joint.owner,
                f"its soft lower limit {lower:g} is above its soft upper limit {upper:g}",
                code="soft-limits",
                line=controller.line,
                common="its soft lower limit is above its soft upper limit",
            )


def _is_meant(joint: JointValues) -> bool:
    """Whether the limits are those of the file, instead of zeros for attributes that are misspelt or misplaced."""
    if joint.limit is None:
        return {"lower", "upper"}.isdisjoint(joint.element.attributes)
    given = joint.limit.attributes.keys()
    absent = {"lower", "upper"} - given
    # Attributes such as min= and max= may be what is absent.
    return not absent or (given <= URDF["limit"].attributes and absent.isdisjoint(joint.element.attributes))


def followers(joints: Sequence[JointTag], robot: Element) -> Iterator[Flaw]:
    """The flaws of followers that reach the ends of their limits before their leaders do."""
    by_name = {joint.name: joint for joint in joints}
    elements = {element.attributes.get("name", ""): element for element in robot.named("joint")}
    for joint in joints:
        leader = None if joint.mimic is None else by_name.get(joint.mimic.leader)
        if joint.mimic is None or leader is None or joint.mimic.multiplier == 0.0:
            continue
        own, kept = _range(leader), _kept(joint, joint.mimic)
        if own is None or kept is None:
            continue
        slack = _SLACK * (kept[1] - kept[0])
        low, high = max(own[0], kept[0]), min(own[1], kept[1])
        # Without any room left the follower's limits are ignored, about which the robot itself warns.
        if high - low > _ONE_VALUE and (own[0] < kept[0] - slack or own[1] > kept[1] + slack):
            lower, upper = _range(joint) or (0.0, 0.0)
            element = elements[joint.name]
            yield Flaw(
                named(element),
                f"it cannot follow {leader.name!r} over its limits {own[0]:g}…{own[1]:g}: its own limits "
                f"{lower:g}…{upper:g} leave {leader.name!r} only {low:g}…{high:g}",
                code="follower-narrows",
                line=element.line,
                common="its own limits leave the joint that it follows only a part of its range",
            )


def _range(joint: JointTag) -> tuple[float, float] | None:
    return (joint.lower or 0.0, joint.upper or 0.0) if joint.kind in BOUNDED_KINDS else None


def _kept(follower: JointTag, mimic: Mimic) -> tuple[float, float] | None:
    """The range of the leader in which the follower stays inside its limits."""
    own = _range(follower)
    if own is None:
        return None
    ends = [(limit - mimic.offset) / mimic.multiplier for limit in own]
    return min(ends), max(ends)
