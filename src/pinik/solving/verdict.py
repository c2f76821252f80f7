"""The verdict on a configuration, by plain forward kinematics that is independent of the solvers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from ..problem.reach import Shortfall, shortfall
from ..problem.targets import NO_DIRECTION, Target
from ..problem.tolerance import TargetError, Tolerance
from .question import Question
from .state import Status

__all__ = ["Verdict", "all_within", "judge", "measure_errors", "measure_positions"]

Array = NDArray[np.float64]

# The largest distance from the nearest point at which an exact method may stop, relative to the chain's length.
_EXACT = 1e-5


class Verdict(NamedTuple):
    """The verdict on a configuration.

    Attributes:
        status: The reason why the solve ended.
        errors: The error of each target, by plain forward kinematics.
        proof: The proof that a target is out of reach, if there is one.
    """

    status: Status
    errors: tuple[TargetError, ...]
    proof: Shortfall | None


def judge(question: Question, targets: Sequence[Target], q: Array, ended: Status) -> Verdict:
    """Judge a configuration.

    Args:
        question: The problem and the options.
        targets: The targets.
        q: The configuration (nq,).
        ended: The reason why the solver stopped.
    """
    errors = measure_errors(question.robot, targets, q, question.options.tolerance)
    judged = verdict(question, targets, errors, ended)
    if judged.status is Status.CONVERGED and question.touches(q):
        return judged._replace(status=Status.COLLIDING)
    return judged


def verdict(question: Question, targets: Sequence[Target], errors: tuple[TargetError, ...], ended: Status) -> Verdict:
    """The verdict for errors that are already measured, if nothing is to be avoided."""
    if all_within(errors, question):
        return Verdict(Status.CONVERGED, errors, None)
    proof = shortfall(targets, question.bounds, question.options.tolerance)
    if proof is not None or (ended is Status.STALLED and _is_nearest(question, errors)):
        return Verdict(Status.UNREACHABLE, errors, proof)
    return Verdict(Status.STALLED if ended in (Status.CONVERGED, Status.COLLIDING) else ended, errors, None)


def all_within(errors: Sequence[TargetError], question: Question) -> bool:
    """Whether every error is within its target's tolerance."""
    return all([error.within(term.tolerance) for error, term in zip(errors, question.problem.terms, strict=True)])


def _is_nearest(question: Question, errors: Sequence[TargetError]) -> bool:
    """Whether a stalled run has found the nearest reachable point, so that the target is out of reach.

    This is so if its method is exact and the error exceeds the tolerance plus the inaccuracy of the method.
    """
    slack = _EXACT * question.problem.size_of_chain
    return question.solver.exact and any(
        error.position is not None and error.position > term.tolerance.farthest + slack
        for error, term in zip(errors, question.problem.terms, strict=True)
    )


def measure_errors(
    robot: RobotModel, targets: Sequence[Target], q: Array, tolerance: Tolerance
) -> tuple[TargetError, ...]:
    """The error of each target at `q`, by plain forward kinematics, without any code of the solvers.

    Args:
        robot: The robot.
        targets: The targets.
        q: The configuration (nq,).
        tolerance: The tolerance of the targets that have none of their own.
    """
    pinocchio.forwardKinematics(robot.model, robot.data, q)
    return tuple(_measure(robot, target, target.tolerance or tolerance) for target in targets)


def measure_positions(robot: RobotModel, target: Target, q: Array) -> Array:
    """The positions (N, 3) [m] of a target's frame, or of its tool, at many configurations (N, nq)."""
    model, data, frame = robot.model, robot.data, robot.frame_id(target.frame)
    reference = None if target.relative_to is None else robot.frame_id(target.relative_to)
    tool = target.tool
    positions = np.empty((len(q), 3))
    for position, configuration in zip(positions, q, strict=True):
        pinocchio.forwardKinematics(model, data, configuration)
        placement = pinocchio.updateFramePlacement(model, data, frame)
        if reference is not None:
            placement = pinocchio.updateFramePlacement(model, data, reference).actInv(placement)
        position[:] = placement.translation if tool is None else placement.act(tool.translation)
    return positions


def _measure(robot: RobotModel, target: Target, tolerance: Tolerance) -> TargetError:
    """The error of a target after `forwardKinematics`.

    Near the smallest tolerances rounding decides. So that the compiled engine rounds alike, every product is one of
    Pinocchio's, and sums run from left to right (src/native/solving/certifier.cpp).
    """
    model, data = robot.model, robot.data
    at = pinocchio.updateFramePlacement(model, data, robot.frame_id(target.frame))
    if target.relative_to is not None:
        at = pinocchio.updateFramePlacement(model, data, robot.frame_id(target.relative_to)).actInv(at)
    tool = target.tool
    if tool is not None:
        at = at * tool
    position, orientation, offset = None, None, None
    if target.position is not None:
        left = np.where(target.along, target.position - at.translation, 0.0)
        position = _length(left)
        if tolerance.box is not None:
            x, y, z = (left if target.rotation is None else _turn(target.rotation).actInv(left)).tolist()
            offset = (x, y, z)
    if target.rotation is not None:
        orientation = _length(pinocchio.log3((_turn(target.rotation) * _turn(at.rotation).inverse()).rotation))
    elif target.axis is not None:
        axis = _turn(at.rotation).act(target.axis)
        line = target.direction if target.at is None else target.at - at.translation
        assert line is not None
        there = target.at is not None and _length(line) < NO_DIRECTION
        orientation = 0.0 if there else _angle(axis, line)
    return TargetError(position, orientation, offset)


def _turn(rotation: Array) -> pinocchio.SE3:
    return pinocchio.SE3(rotation, np.zeros(3))


def _length(vector: Array) -> float:
    x, y, z = vector.tolist()
    return math.sqrt(x * x + y * y + z * z)


def _angle(a: Array, b: Array) -> float:
    """The angle between two vectors [rad], precise near 0 and π too."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    cross = np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
    return math.atan2(_length(cross), ax * bx + ay * by + az * bz)
