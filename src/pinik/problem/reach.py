"""How far a chain can possibly reach: a bound that proves some targets unreachable."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.chains import Chain
from ..model.joint import Joint
from ..model.limits import Limits
from .problem import Problem
from .targets import Target
from .term import Term

__all__ = ["Bounds", "Shortfall", "bounds_of", "reach_bounds", "shortfall"]

Vector = Sequence[float]  # three plain numbers: every solve asks, and numpy is slow with so few

ROUNDING = 1e-12  # of the lengths that enter: what rounding in the placements of a chain may amount to


class Shortfall(NamedTuple):
    """A proof that a target cannot be reached.

    Attributes:
        target: Its index.
        distance: How far it lies outside the bound [m].
        bound: The bound [m]: the largest distance, or with `inner` the smallest, from the chain's first joint.
        inner: Whether the target is too near instead of too far.
    """

    target: int
    distance: float
    bound: float
    inner: bool


class _Range(NamedTuple):
    """The least and the largest distance between two points [m]."""

    low: float
    high: float


class _Span(NamedTuple):
    """A part of a chain, from one of its points to another, and the distances between these.

    The points are the base (0), the joints' origins (1, 2, …) and the frame.
    """

    start: int
    end: int
    distance: _Range


def shortfall(targets: Sequence[Target], bounds: Sequence[Bounds | None], slack: float = 0.0) -> Shortfall | None:
    """The target that lies furthest outside its chain's reach, if one does by more than `slack` [m].

    Args:
        targets: What is asked for.
        bounds: Each target's, from `bounds_of`.
        slack: What still counts as reached [m].
    """
    worst = None
    for index, (target, own) in enumerate(zip(targets, bounds, strict=True)):
        found = _shortfall(index, target, own)
        if found is not None and (worst is None or found.distance > worst.distance):
            worst = found
    return None if worst is None or worst.distance <= slack else worst


def _shortfall(index: int, target: Target, bounds: Bounds | None) -> Shortfall | None:
    if target.position is None or bounds is None:
        return None
    base, reach, hole = bounds
    position = target.position
    distance = float(np.linalg.norm(position - base))
    slack = ROUNDING * (reach + float(np.linalg.norm(position)) + float(np.linalg.norm(base)))
    if distance > reach + slack:
        return Shortfall(index, distance - reach, reach, False)
    if distance < hole - slack:
        return Shortfall(index, hole - distance, hole, True)
    return None


class Bounds(NamedTuple):
    """Where a chain's frame can be at all.

    Attributes:
        base: The chain's first joint (3,) [m], in the reference's axes where the target has one.
        reach: The frame is never farther from it [m].
        hole: Nor nearer [m].
    """

    base: NDArray[np.float64]
    reach: float
    hole: float


def bounds_of(problem: Problem, limits: Limits) -> list[Bounds | None]:
    """The bounds of every target's chain; they hold for any values of the joints, wherever the targets are.

    A chain is cut into spans: from one joint's origin to the next, or to the one after it while the joint between them
    turns through its limits. The largest lengths of the spans add up to a bound on the reach. The smallest length of
    one span, less the largest of all others folded back, is a bound on how near the frame can come.
    """
    return [reach_bounds(term, limits) for term in problem.terms]


def reach_bounds(term: Term, limits: Limits) -> Bounds | None:
    """The bounds of a target's chain; None where it has none."""
    chain = term.chain
    if not chain.joints or not chain.is_one_branch:
        return None
    if any(not joint.has_one_axis for joint in chain.joints):
        return None
    base = chain.model.jointPlacements[chain.joints[0].id].translation
    if chain.reference_placement is not None:
        base = chain.reference_placement.actInv(base)
    reach, hole = _bounds(_spans(chain, limits), len(chain.joints) + 1)
    return Bounds(np.array(base), reach, hole) if math.isfinite(reach) else None


def _bounds(spans: list[_Span], end: int) -> tuple[float, float]:
    """The largest and the least distance between the points 0 and `end`, over all ways to cut the chain."""
    before = [0.0] + [math.inf] * end  # the reach from 0 to each point
    for span in spans:
        before[span.end] = min(before[span.end], before[span.start] + span.distance.high)
    after = [math.inf] * end + [0.0]  # and from each point to the end
    for span in reversed(spans):
        after[span.start] = min(after[span.start], span.distance.high + after[span.end])
    return before[end], max(span.distance.low - before[span.start] - after[span.end] for span in spans)


def _spans(chain: Chain, limits: Limits) -> list[_Span]:
    """The spans of a chain, in the order of their ends."""
    joints = chain.joints
    placements = [chain.model.jointPlacements[joint.id] for joint in joints]
    # The chain begins where its first joint sits.
    translations: list[Vector] = [[0.0, 0.0, 0.0], *(offset.tolist() for offset in chain.offsets)]
    spans = []
    for k, offset in enumerate(translations):
        joint = joints[k] if k < len(joints) else None
        if joint is None or _turns(joint):
            length = math.hypot(*offset)
            distance = _Range(length, length)
        else:
            distance = _over_slide(placements[k].rotation.T.dot(offset).tolist(), joint, limits)
        spans.append(_Span(k, k + 1, distance))
        if k >= 1 and _turns(joints[k - 1]) and (joint is None or _turns(joint)):
            before = placements[k - 1].rotation.T.dot(translations[k - 1]).tolist()
            spans.append(_Span(k - 1, k + 1, _over_hinge(before, joints[k - 1], offset, limits)))
    return spans


def _turns(joint: Joint) -> bool:
    return joint.kind != "prismatic"


def _over_slide(before: Vector, joint: Joint, limits: Limits) -> _Range:
    """Distance from the origin before a slide, `before` away from it at 0 and in its axes, to its own."""
    low, high = _joint_range(joint, limits)
    if not (math.isfinite(low) and math.isfinite(high)):
        return _Range(0.0, math.inf)
    along = _dot(before, joint.axis)
    across = math.hypot(*_across(before, joint.axis, along))
    nearest = min(max(-along, low), high)
    return _Range(math.hypot(across, along + nearest), math.hypot(across, max(abs(along + low), abs(along + high))))


def _over_hinge(before: Vector, joint: Joint, after: Vector, limits: Limits) -> _Range:
    """Distance over a hinge: from the origin before it to the origin after it, both parts as seen at its angle 0."""
    axis = joint.axis
    rise_before, rise_after = _dot(before, axis), _dot(after, axis)
    u, v = _across(before, axis, rise_before), _across(after, axis, rise_after)
    rise, r, s = rise_before + rise_after, math.hypot(*u), math.hypot(*v)
    turned = (axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0])
    straight = math.atan2(_dot(u, turned), _dot(u, v))  # the angle at which the parts are in line

    def distance(angle: float) -> float:
        # r² + s² + 2rs·cos, written so that nothing cancels where the parts fold back onto each other
        return math.hypot(rise, r - s, 2.0 * math.sqrt(r * s) * math.cos(0.5 * (angle - straight)))

    low, high = _joint_range(joint, limits)
    ends = [distance(angle) for angle in (low, high) if math.isfinite(angle)]
    least = distance(straight + math.pi) if _meets(straight + math.pi, low, high) else min(ends)
    largest = distance(straight) if _meets(straight, low, high) else max(ends)
    return _Range(least, largest)


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _across(vector: Vector, axis: Vector, along: float) -> tuple[float, float, float]:
    """What is left of a vector without its part along an axis."""
    return vector[0] - along * axis[0], vector[1] - along * axis[1], vector[2] - along * axis[2]


def _meets(angle: float, low: float, high: float) -> bool:
    """Whether the angle, or one that is whole turns away, lies in [low, high]."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return True
    return (angle - low) % (2.0 * math.pi) <= high - low


def _joint_range(joint: Joint, limits: Limits) -> tuple[float, float]:
    return joint.angle_range(float(limits.lower[joint.idx_q]), float(limits.upper[joint.idx_q]))
