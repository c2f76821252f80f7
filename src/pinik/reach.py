"""How far a chain can possibly reach: a bound that proves some targets unreachable."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .kinematics import Kinematics, TargetTerm
from .limits import Limits
from .robot import Joint

__all__ = ["Shortfall", "shortfall"]

Array = NDArray[np.float64]

_ROUNDING = 1e-12  # of the reach: what rounding in the placements of a chain may amount to


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


def shortfall(kinematics: Kinematics, limits: Limits) -> Shortfall | None:
    """The target that lies furthest outside its chain's reach, if one does.

    The bounds hold for any values of the joints. A chain is cut into spans: from one joint's origin to the next, or
    to the one after it as the joint between them turns through its limits. The longest these get add up to the
    reach at most; what is left of the shortest that one of them gets, when all others fold back, is the least.
    """
    worst = None
    for index, term in enumerate(kinematics.terms):
        found = _term_shortfall(index, term, kinematics.model, limits)
        if found is not None and (worst is None or found.distance > worst.distance):
            worst = found
    return worst


def _term_shortfall(index: int, term: TargetTerm, model: pinocchio.Model, limits: Limits) -> Shortfall | None:
    position = term.target.position
    # A reference that moves makes the chain go down one branch and up another; that one gets no bound.
    if position is None or not term.movers or any(j.id in term.reference_support for j in term.movers):
        return None
    if any(not joint.has_one_axis for joint in term.movers):
        return None
    base = model.jointPlacements[term.movers[0].id].translation
    if term.reference_placement is not None:
        base = term.reference_placement.actInv(base)
    distance = float(np.linalg.norm(position - base))
    reach, hole = _bounds(_spans(term, model, limits), len(term.movers) + 1)
    if not math.isfinite(reach):
        return None
    slack = _ROUNDING * reach
    if distance > reach + slack:
        return Shortfall(index, distance - reach, reach, False)
    if distance < hole - slack:
        return Shortfall(index, hole - distance, hole, True)
    return None


def _bounds(spans: list[_Span], end: int) -> tuple[float, float]:
    """The largest and the least distance between the points 0 and `end`, over all ways to cut the chain."""
    before = [0.0] + [math.inf] * end  # the reach from 0 to each point
    for span in spans:
        before[span.end] = min(before[span.end], before[span.start] + span.distance.high)
    after = [math.inf] * end + [0.0]  # and from each point to the end
    for span in reversed(spans):
        after[span.start] = min(after[span.start], span.distance.high + after[span.end])
    return before[end], max(span.distance.low - before[span.start] - after[span.end] for span in spans)


def _spans(term: TargetTerm, model: pinocchio.Model, limits: Limits) -> list[_Span]:
    """The spans of a term's chain, in the order of their ends."""
    joints = term.movers
    placements = [pinocchio.SE3(model.jointPlacements[joints[0].id].rotation, np.zeros(3))]
    placements += [model.jointPlacements[joint.id] for joint in joints[1:]]
    spans = []
    for k in range(len(joints) + 1):
        joint = joints[k] if k < len(joints) else None
        offset = term.frame_placement if joint is None else placements[k]
        spans.append(_Span(k, k + 1, _straight(offset, joint, limits)))
        if k >= 1 and _turns(joints[k - 1]) and (joint is None or _turns(joint)):
            bent = _bent(placements[k - 1], joints[k - 1], offset.translation, limits)
            spans.append(_Span(k - 1, k + 1, bent))
    return spans


def _turns(joint: Joint) -> bool:
    return joint.kind != "prismatic"


def _straight(offset: pinocchio.SE3, joint: Joint | None, limits: Limits) -> _Range:
    """Distance from one joint's origin to the next one's, which may slide."""
    t = offset.translation
    length = float(np.linalg.norm(t))
    if joint is None or _turns(joint):
        return _Range(length, length)
    low, high = _joint_range(joint, limits)
    axis = offset.rotation @ np.array(joint.axis)
    if not (math.isfinite(low) and math.isfinite(high)):
        return _Range(0.0, math.inf)
    ends = [float(np.linalg.norm(t + axis * slide)) for slide in (low, high)]
    nearest = min(max(-float(axis @ t), low), high)
    return _Range(float(np.linalg.norm(t + axis * nearest)), max(ends))


def _bent(offset: pinocchio.SE3, joint: Joint, following: Array, limits: Limits) -> _Range:
    """Distance over a hinge: from the origin before it to the origin after it, which turns about its axis."""
    axis = np.array(joint.axis)
    preceding = offset.rotation.T @ offset.translation
    along = float((preceding + following) @ axis)
    u, v = preceding - (preceding @ axis) * axis, following - (following @ axis) * axis
    r, s = float(np.linalg.norm(u)), float(np.linalg.norm(v))
    straight = math.atan2(float(u @ np.cross(axis, v)), float(u @ v))  # the angle at which the parts are in line

    def distance(angle: float) -> float:
        # r² + s² + 2rs·cos, written so that nothing cancels where the parts fold back onto each other
        return math.hypot(along, r - s, 2.0 * math.sqrt(r * s) * math.cos(0.5 * (angle - straight)))

    low, high = _joint_range(joint, limits)
    ends = [distance(angle) for angle in (low, high) if math.isfinite(angle)]
    least = distance(straight + math.pi) if _meets(straight + math.pi, low, high) else min(ends)
    largest = distance(straight) if _meets(straight, low, high) else max(ends)
    return _Range(least, largest)


def _meets(angle: float, low: float, high: float) -> bool:
    """Whether the angle, or one that is whole turns away, lies in [low, high]."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return True
    return (angle - low) % (2.0 * math.pi) <= high - low


def _joint_range(joint: Joint, limits: Limits) -> tuple[float, float]:
    if joint.kind == "continuous":
        return -math.inf, math.inf
    ends = [joint.multiplier * float(end[joint.idx_q]) + joint.offset for end in (limits.lower, limits.upper)]
    return min(ends), max(ends)
