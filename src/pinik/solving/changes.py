"""How far joints move between two configurations, and how far a target asks them to move."""

from __future__ import annotations

import math

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from ..problem.coordinates import Coordinate
from ..problem.kinematics import Kinematics, Linearization
from ..problem.problem import Problem

__all__ = ["asked_step", "farthest_coordinate", "is_jump", "joint_change", "largest_change"]

Array = NDArray[np.float64]

JUMP_FLOOR = 0.1
"""A change of every joint by at most this [rad] between neighbours on a path is never a jump."""

JUMP_FACTOR = 3.0
"""How many times the step that the target's motion asks for a joint may move beyond the floor."""

JUMP_DAMPING = 0.02
"""The damping of that step, relative to the Frobenius norm of J: it bounds what a singular place may ask for."""


def joint_change(joint: Joint, before: Array, after: Array, length: float = 1.0) -> float:
    """The signed change of a joint from one configuration to another [rad or m].

    It is the difference of the angles of a joint with one entry in q, and lies in (−π, π] for one with (cos, sin). For
    a floating or planar joint it is the larger of its turn [rad] and its way.

    Args:
        joint: The joint, which must not be a follower.
        before, after: The configurations (nq,).
        length: The length [m] that counts as one radian in ways.
    """
    i = joint.idx_q
    if joint.nq == 1:
        return float(after[i] - before[i]) / (length if joint.kind == "prismatic" else 1.0)
    if joint.nq == 2:
        return _turn(before[i : i + 2], after[i : i + 2])
    if joint.kind == "planar":
        way = math.dist(before[i : i + 2], after[i : i + 2]) / length
        return max(way, abs(_turn(before[i + 2 : i + 4], after[i + 2 : i + 4])))
    way = math.dist(before[i : i + 3], after[i : i + 3]) / length
    product = abs(float(before[i + 3 : i + 7].dot(after[i + 3 : i + 7])))
    return max(way, 2.0 * math.acos(min(product, 1.0)))


def largest_change(problem: Problem, before: Array, after: Array) -> float:
    """The largest change of a joint that moves the targets [rad]; metres count per length of the chain."""
    joints = {coordinate.joint for coordinate in problem.coordinates}
    changes = [abs(joint_change(joint, before, after, problem.size_of_chain)) for joint in joints]
    return max(changes, default=0.0)


def farthest_coordinate(problem: Problem, before: Array, after: Array) -> Coordinate | None:
    """The free coordinate that changes by the largest number [rad or m]; the first of equal ones, None if none is free.

    Args:
        problem: The problem, whose coordinates are compared.
        before, after: The configurations (nq,).
    """
    step = np.abs(pinocchio.difference(problem.model, before, after))
    return max(problem.coordinates, key=lambda one: float(step[one.joint.idx_v + one.index]), default=None)


def asked_step(at: Linearization) -> Array:
    """The least damped step (nv,) that the residual asks for: Jᵀ(JJᵀ + λ²I)⁻¹e with λ = 0.02 ‖J‖."""
    squared = JUMP_DAMPING * JUMP_DAMPING * float(at.J.ravel().dot(at.J.ravel()))
    if squared == 0.0:
        return np.zeros(at.J.shape[1])
    return np.array(at.J.T.dot(np.linalg.solve(at.J.dot(at.J.T) + squared * np.eye(len(at.e)), at.e)))


def largest_asked(kinematics: Kinematics, q: Array) -> float:
    """The largest change of a joint that is no jump, if the joints leave `q` for the present targets [rad].

    That is 0.1 rad plus three times the largest part of `asked_step` at `q`; metres count per length of the chain.
    """
    step, problem = asked_step(kinematics.linearize(q)), kinematics.problem
    largest = 0.0
    for coordinate in problem.coordinates:
        part = abs(float(step[coordinate.joint.idx_v + coordinate.index]))
        largest = max(largest, part / problem.size_of_chain if coordinate.slides else part)
    return JUMP_FLOOR + JUMP_FACTOR * largest


def is_jump(kinematics: Kinematics, before: Array, after: Array) -> bool:
    """Whether joints change far more than the motion of the present targets asks for (see `largest_asked`)."""
    change = largest_change(kinematics.problem, before, after)
    return change > JUMP_FLOOR and change > largest_asked(kinematics, before)


def _turn(before: Array, after: Array) -> float:
    cosine = float(before.dot(after))
    return math.atan2(float(before[0] * after[1] - before[1] * after[0]), cosine)
