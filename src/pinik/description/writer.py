"""Write checked links and joints as the URDF text for Pinocchio, without shapes."""

from __future__ import annotations

from collections.abc import Iterable

from .edits import quoted
from .joints import ENDLESS, JointTag
from .links import INERTIA_ATTRIBUTES, Inertial, LinkTag
from .part import Vector
from .vocabulary import BOUNDED_KINDS

__all__ = ["UNLIMITED", "written"]

# For efforts and velocities that the file does not limit; Pinocchio uses the same number for its root joints.
UNLIMITED = 1.7976931348623157e308


def written(name: str, links: Iterable[LinkTag], joints: Iterable[JointTag]) -> str:
    """The URDF text of a robot; every number is written exactly."""
    lines = [f"<robot name={quoted(name)}>"]
    lines.extend(_link(link) for link in links)
    lines.extend(_joint(joint) for joint in joints)
    lines.append("</robot>")
    return "\n".join(lines)


def _link(link: LinkTag) -> str:
    start = f"<link name={quoted(link.name)}"
    return f"{start}/>" if link.inertial is None else f"{start}>{_inertial(link.inertial)}</link>"


def _inertial(inertial: Inertial) -> str:
    entries = zip(INERTIA_ATTRIBUTES, inertial.inertia, strict=True)
    inertia = " ".join(f'{attribute}="{value!r}"' for attribute, value in entries)
    origin = _origin(inertial.xyz, inertial.rpy)
    return f'<inertial>{origin}<mass value="{inertial.mass!r}"/><inertia {inertia}/></inertial>'


def _joint(joint: JointTag) -> str:
    parts = [
        f'<joint name={quoted(joint.name)} type="{joint.kind}">',
        _origin(joint.xyz, joint.rpy),
        f"<parent link={quoted(joint.parent)}/><child link={quoted(joint.child)}/>",
        f'<axis xyz="{_numbers(joint.axis)}"/>',
        _limit(joint),
    ]
    if joint.mimic is not None:
        leader = quoted(joint.mimic.leader)
        scale = f'multiplier="{joint.mimic.multiplier!r}" offset="{joint.mimic.offset!r}"'
        parts.append(f"<mimic joint={leader} {scale}/>")
    if joint.damping is not None or joint.friction is not None:
        parts.append(f'<dynamics damping="{joint.damping or 0.0!r}" friction="{joint.friction or 0.0!r}"/>')
    return "".join([*parts, "</joint>"])


def _limit(joint: JointTag) -> str:
    """The `<limit>` of a joint; empty if its kind needs none and none is given."""
    bounded = joint.kind in BOUNDED_KINDS
    if not bounded and joint.effort is None and joint.velocity is None:
        return ""
    effort = UNLIMITED if joint.effort is None else joint.effort
    velocity = UNLIMITED if joint.velocity is None else joint.velocity
    # An infinite limit is written as a large one: URDF has no word for it, and `set_position_limits` makes it infinite.
    lower, upper = max(joint.lower or 0.0, -ENDLESS), min(joint.upper or 0.0, ENDLESS)
    bounds = f'lower="{lower!r}" upper="{upper!r}" ' if bounded else ""
    return f'<limit {bounds}effort="{effort!r}" velocity="{velocity!r}"/>'


def _origin(xyz: Vector, rpy: Vector) -> str:
    return f'<origin xyz="{_numbers(xyz)}" rpy="{_numbers(rpy)}"/>'


def _numbers(vector: Vector) -> str:
    return " ".join(repr(value) for value in vector)
