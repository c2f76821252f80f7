"""Bounds on a chain's reach, which prove some targets unreachable."""

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
from .tolerance import Tolerance

__all__ = ["Bounds", "Shortfall", "bounds_of", "reach_bounds", "shortfall"]

Vector = Sequence[float]  # three plain numbers, because numpy is slow for so few

ROUNDING = 1e-12  # relative to the lengths involved: allowance for rounding in the placements of a chain


_NONE = Tolerance(0.0, 0.0)


class Shortfall(NamedTuple):
    """A proof that a target cannot be reached.

    Attributes:
        target: The index of the target.
        distance: How far the target lies outside the bound [m].
        bound: The largest possible distance of the frame from the chain's first joint, or the smallest if `inner` [m].
        inner: Whether the target is too near instead of too far.
    """

    target: int
    distance: float
    bound: float
    inner: bool


class _Range(NamedTuple):
    """The smallest and the largest distance between two points [m]."""

    low: float
    high: float


class _Span(NamedTuple):
    """A part of a chain between two of its points, and the range of the distance between them.

    The points are the origin of the first joint (0), the origins of the other joints (1, 2, …) and the frame.
    """

    start: int
    end: int
    distance: _Range


def shortfall(
    targets: Sequence[Target], bounds: Sequence[Bounds | None], tolerance: Tolerance = _NONE
) -> Shortfall | None:
    """The target that lies farthest outside its chain's reach, by more than its tolerance; None if there is none.

    Args:
        targets: The targets.
        bounds: The bounds for each target, from `bounds_of`.
        tolerance: The tolerance of the targets that have none of their own; zero by default.
    """
    worst = None
    for index, (target, own) in enumerate(zip(targets, bounds, strict=True)):
        found = _shortfall(index, target, own)
        if found is None or found.distance <= (target.tolerance or tolerance).farthest:
            continue
        if worst is None or found.distance > worst.distance:
            worst = found
    return worst


def _shortfall(index: int, target: Target, bounds: Bounds | None) -> Shortfall | None:
    if target.position is None or bounds is None:
        return None
    base, reach, hole = bounds
    position = np.where(target.along, target.position, base)  # along free axes, the nearest to the base
    distance = float(np.linalg.norm(position - base))
    slack = ROUNDING * (reach + float(np.linalg.norm(position)) + float(np.linalg.norm(base)))
    if distance > reach + slack:
        return Shortfall(index, distance - reach, reach, False)
    if distance < hole - slack and all(target.along):
        return Shortfall(index, hole - distance, hole, True)
    return None


class Bounds(NamedTuple):
    """Bounds on the position of a chain's frame.

    Attributes:
        base: The origin of the chain's first joint (3,) [m], in the reference frame if the target has one.
        reach: The frame is never farther than this from `base` [m].
        hole: The frame is never nearer than this to `base` [m].
    """

    base: NDArray[np.float64]
    reach: float
    hole: float


def bounds_of(problem: Problem, limits: Limits) -> list[Bounds | None]:
    """The bounds for the chain of each target; they hold for all joint values and all positions of the targets.

    The chain is divided into spans. A span goes from one joint's origin to the next, or to the one after that, with the
    hinge in between anywhere in its range. The sum of the largest lengths of the spans bounds the reach from above. The
    smallest length of one span, minus the largest lengths of all others, bounds the distance from below.
    """
    return [reach_bounds(term, limits) for term in problem.terms]


def reach_bounds(term: Term, limits: Limits) -> Bounds | None:
    """The bounds for a target's chain; None if the chain has none."""
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
    """Bounds (upper, lower) on the distance from point 0 to point `end`, the best of all divisions into spans."""
    before = [0.0] + [math.inf] * end  # the reach from 0 to each point
    for span in spans:
        before[span.end] = min(before[span.end], before[span.start] + span.distance.high)
    after = [math.inf] * end + [0.0]  # and from each point to the end
    for span in reversed(spans):
        after[span.start] = min(after[span.start], span.distance.high + after[span.end])
    return before[end], max(span.distance.low - before[span.start] - after[span.end] for span in spans)


def _spans(chain: Chain, limits: Limits) -> list[_Span]:
    """The spans of a chain, ordered by their end points."""
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
    """The distance from the previous origin to a prismatic joint; `before` is the offset at 0, in the joint's axes."""
    low, high = _joint_range(joint, limits)
    if not (math.isfinite(low) and math.isfinite(high)):
        return _Range(0.0, math.inf)
    along = _dot(before, joint.axis)
    across = math.hypot(*_across(before, joint.axis, along))
    nearest = min(max(-along, low), high)
    return _Range(math.hypot(across, along + nearest), math.hypot(across, max(abs(along + low), abs(along + high))))


def _over_hinge(before: Vector, joint: Joint, after: Vector, limits: Limits) -> _Range:
    """The distance between the origins before and after a hinge; both offsets are in its axes at angle 0."""
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
    """The component of a vector perpendicular to an axis, given its component `along` the axis."""
    return vector[0] - along * axis[0], vector[1] - along * axis[1], vector[2] - along * axis[2]


def _meets(angle: float, low: float, high: float) -> bool:
    """Whether the angle lies in [low, high], if need be after whole turns."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return True
    return (angle - low) % (2.0 * math.pi) <= high - low


def _joint_range(joint: Joint, limits: Limits) -> tuple[float, float]:
    return joint.angle_range(float(limits.lower[joint.idx_q]), float(limits.upper[joint.idx_q]))
