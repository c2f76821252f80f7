"""Numbers that look like degrees or millimetres, compared with others in the same file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median

from ...rotations import like_degrees, rpy_like_degrees
from ..flaw import Flaw
from ..xml import Element
from .plain import JointValues, joint_values, named, plain_vector

__all__ = ["magnitudes"]

_MOST_TURNS = 4.0 * math.pi  # [rad]: real joints seldom turn further, except for those without an end
_FAR = 10.0  # [m]: shorter distances are plausible in metres
_TIMES = 100.0  # millimetres among metres are 1000 times too long; parts differ in length by themselves
_MOST_MILLIMETRES = 10_000.0


def magnitudes(robot: Element) -> Iterator[Flaw]:
    """The flaws of a robot description whose numbers look as if they had another unit than radians and metres."""
    joints = list(joint_values(robot))
    lengths = [math.hypot(*joint.xyz) for joint in joints if joint.xyz is not None and any(joint.xyz)]
    usual = [length for length in lengths if length < _FAR]
    typical = median(usual) if usual else None
    yield from _degrees_in_limits(joints)
    for joint in joints:
        if joint.origin is not None:
            yield from _origin(joint.origin, joint.owner, typical)
        if joint.kind == "prismatic" and typical is not None:
            yield from _millimetres_in_limit(joint, typical)
    for link in robot.named("link"):
        for part in link.children:
            if part.tag in ("visual", "collision", "inertial"):
                for origin in part.named("origin"):
                    yield from _origin(origin, f"{named(link)}, {part.tag}", typical)


def _degrees_in_limits(joints: list[JointValues]) -> Iterator[Flaw]:
    turning = [
        (joint, joint.lower, joint.upper)
        for joint in joints
        if joint.kind == "revolute" and joint.lower is not None and joint.upper is not None
    ]
    ends = [max(abs(lower), abs(upper)) for _, lower, upper in turning]
    usual = [end for end in ends if end <= _MOST_TURNS]
    compared = f", while {_joints(len(usual))} within {max(usual):.3g} rad" if usual else ""
    for (joint, lower, upper), end in zip(turning, ends, strict=True):
        if end <= _MOST_TURNS or not (like_degrees(lower) and like_degrees(upper)):
            continue
        turns = end / (2.0 * math.pi)
        cause = f"its limits {lower:g}…{upper:g} rad are up to {turns:.3g} turns, and look like degrees{compared}"
        yield Flaw(
            joint.owner,
            cause,
            code="limit-in-degrees",
            line=joint.line,
            common=f"its limits are many turns, and look like degrees{compared}",
            mend=f'If degrees are meant, write lower="{math.radians(lower):.6g}" upper="{math.radians(upper):.6g}".',
        )


def _origin(origin: Element, owner: str, typical: float | None) -> Iterator[Flaw]:
    rpy = plain_vector(origin, "rpy")
    if rpy is not None and rpy_like_degrees(rpy):
        shown = " ".join(f"{math.radians(angle):.6g}" for angle in rpy)
        yield Flaw(
            owner,
            f'<origin rpy="{_shown(rpy)}"> goes beyond a full turn in radians, and looks like degrees',
            code="rpy-in-degrees",
            line=origin.line,
            common="rpy goes beyond a full turn in radians, and looks like degrees",
            mend=f'If degrees are meant, write rpy="{shown}".',
        )
    xyz = plain_vector(origin, "xyz")
    if xyz is None or typical is None:
        return
    length = math.hypot(*xyz)
    if length >= max(_FAR, _TIMES * typical):
        shown = " ".join(f"{value / 1000.0:.6g}" for value in xyz)
        yield Flaw(
            owner,
            f'<origin xyz="{_shown(xyz)}"> is {length:.4g} m long, about {length / typical:.2g} times as long as the '
            "joints' usual ones, and looks like millimetres",
            code="origin-in-millimetres",
            line=origin.line,
            common="its origin is over 100 times as long as the joints' usual ones, and looks like millimetres",
            mend=f'If millimetres are meant, write xyz="{shown}".',
        )


def _millimetres_in_limit(joint: JointValues, typical: float) -> Iterator[Flaw]:
    if joint.lower is None or joint.upper is None:
        return
    # Limits that are the same on both sides often stand for a slide without an end.
    travel = joint.upper - joint.lower
    if joint.lower == -joint.upper or not max(_FAR, _TIMES * typical) <= travel <= _MOST_MILLIMETRES:
        return
    yield Flaw(
        joint.owner,
        f"its limits {joint.lower:g}…{joint.upper:g} m are a travel of {travel:g} m on a robot of parts of about "
        f"{typical:.2g} m, and look like millimetres",
        code="limit-in-millimetres",
        line=joint.line,
        common="its limits are a travel of over 100 times the length of other parts, and look like millimetres",
        mend=f'If millimetres are meant, write lower="{joint.lower / 1000.0:.6g}" upper="{joint.upper / 1000.0:.6g}".',
    )


def _joints(count: int) -> str:
    return "another joint stays" if count == 1 else f"{count} other joints stay"


def _shown(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:g}" for value in values)
