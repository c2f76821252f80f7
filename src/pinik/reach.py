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
    """The least and the largest distance between two points of a chain [m]."""

    low: float
    high: float


def shortfall(kinematics: Kinematics, limits: Limits) -> Shortfall | None:
    """The target that lies furthest outside its chain's reach, if one does.

    The bound holds for any values of the joints: the distances between the origins of neighbouring joints, or of
    every second one as the joint between them turns through its limits, add up to the reach at most; what is left
    of the longest when all others fold back is the least.
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
    parts = _parts(term, model, limits)
    reach = sum(part.high for part in parts)
    if not math.isfinite(reach):
        return None
    hole = max(part.low - (reach - part.high) for part in parts)
    slack = _ROUNDING * reach
    if distance > reach + slack:
        return Shortfall(index, distance - reach, reach, False)
    if distance < hole - slack:
        return Shortfall(index, hole - distance, hole, True)
    return None


def _parts(term: TargetTerm, model: pinocchio.Model, limits: Limits) -> list[_Range]:
    """Ranges of consecutive parts of the chain, chosen so that their largest distances add up to the least."""
    joints = term.movers
    frame_placement = term.frame_placement
    placements = [pinocchio.SE3(model.jointPlacements[joints[0].id].rotation, np.zeros(3))]
    placements += [model.jointPlacements[joint.id] for joint in joints[1:]]
    best: list[tuple[float, list[_Range]]] = [(0.0, [])]
    for k in range(len(joints) + 1):
        tip = k == len(joints)
        offset = frame_placement if tip else placements[k]
        alone = _straight(offset, None if tip else joints[k], limits)
        total, parts = best[k]
        choices = [(total + alone.high, [*parts, alone])]
        if k >= 1 and _turns(joints[k - 1]) and (tip or _turns(joints[k])):
            bent = _bent(placements[k - 1], joints[k - 1], offset.translation, limits)
            total, parts = best[k - 1]
            choices.append((total + bent.high, [*parts, bent]))
        best.append(min(choices, key=lambda choice: choice[0]))
    return best[-1][1]


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
