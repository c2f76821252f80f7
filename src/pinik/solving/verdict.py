"""The verdict on a configuration: plain forward kinematics has the last word, whatever the solver thought."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.robot_model import RobotModel
from ..problem.reach import Shortfall, shortfall
from ..problem.targets import NO_DIRECTION, Target, TargetError
from .question import Question
from .state import Status

__all__ = ["Verdict", "all_within", "judge", "measure_errors", "measure_positions"]

Array = NDArray[np.float64]

# As a part of the chain's length: how far from the nearest point an exact method may come to rest.
_EXACT = 1e-5


class Verdict(NamedTuple):
    """What a configuration is worth.

    Attributes:
        status: Why the solve ended.
        errors: Each target's error, by plain forward kinematics.
        proof: Why a target is out of reach, where one provably is.
    """

    status: Status
    errors: tuple[TargetError, ...]
    proof: Shortfall | None


def judge(question: Question, targets: Sequence[Target], q: Array, ended: Status) -> Verdict:
    """The verdict on `q` (nq,).

    Args:
        question: What was asked, and how.
        targets: Where the frames should be.
        q: The configuration.
        ended: Why the solver stopped.
    """
    errors = measure_errors(question.robot, targets, q)
    return verdict(question, targets, errors, ended)


def verdict(question: Question, targets: Sequence[Target], errors: tuple[TargetError, ...], ended: Status) -> Verdict:
    """The verdict for errors that were measured already."""
    if all_within(errors, question):
        return Verdict(Status.CONVERGED, errors, None)
    proof = shortfall(targets, question.bounds, question.options.tolerance.position)
    if proof is not None or (ended is Status.STALLED and _is_nearest(question, errors)):
        return Verdict(Status.UNREACHABLE, errors, proof)
    return Verdict(Status.STALLED if ended is Status.CONVERGED else ended, errors, None)


def all_within(errors: Sequence[TargetError], question: Question) -> bool:
    """Whether every error is within the question's tolerance."""
    tolerance = question.options.tolerance
    return all([error.within(tolerance) for error in errors])


def _is_nearest(question: Question, errors: Sequence[TargetError]) -> bool:
    """Whether a run that stalled is as near as can be.

    So it is if its method comes to rest at the nearest point alone, and it missed by more than it may be off by.
    """
    least = question.options.tolerance.position + _EXACT * question.problem.size_of_chain
    return question.solver.exact and any(error.position is not None and error.position > least for error in errors)


def measure_errors(robot: RobotModel, targets: Sequence[Target], q: Array) -> tuple[TargetError, ...]:
    """Each target's error at `q`, by plain forward kinematics and nothing that the solvers use."""
    return tuple(_measure(robot, target, q) for target in targets)


def measure_positions(robot: RobotModel, target: Target, q: Array) -> Array:
    """Where a target's frame, or the tool in it, is at many configurations (N, nq): (N, 3) [m]."""
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


def _measure(robot: RobotModel, target: Target, q: Array) -> TargetError:
    placement = robot.placement(target.frame, q, target.relative_to)
    if target.tool is not None:
        placement = placement * target.tool
    position, orientation = None, None
    if target.position is not None:
        position = float(np.linalg.norm(target.position - placement.translation))
    if target.rotation is not None:
        orientation = float(np.linalg.norm(pinocchio.log3(target.rotation @ placement.rotation.T)))
    elif target.axis is not None:
        axis = placement.rotation @ target.axis
        direction = target.direction if target.at is None else target.at - placement.translation
        assert direction is not None
        if target.at is not None and np.linalg.norm(direction) < NO_DIRECTION:
            return TargetError(position, 0.0)
        orientation = math.atan2(float(np.linalg.norm(np.cross(axis, direction))), float(axis @ direction))
    return TargetError(position, orientation)
