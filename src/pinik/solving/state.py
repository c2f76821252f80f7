"""Where a run stands, why it ended, and how far off its targets are by plain forward kinematics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.robot_model import Robot
from ..problem.targets import NO_DIRECTION, Target, TargetError, largest_of

__all__ = ["State", "Status", "measure_errors", "measure_positions"]

Array = NDArray[np.float64]


class Status(Enum):
    """Why a solve ended; `str()` gives the words."""

    CONVERGED = "every target is within tolerance"
    STALLED = "progress stopped short of the target"
    MAX_ITERATIONS = "the iterations ran out"
    TIME_LIMIT = "the time ran out"
    UNREACHABLE = "the target lies outside the chain's reach"

    def __str__(self) -> str:
        return self.value


class State(NamedTuple):
    """One iteration of a run.

    Attributes:
        q: The configuration (nq,), read-only.
        iteration: 0 at the start, then 1 for each step (for CCD, each sweep).
        joint_updates: Single joints updated so far, for sweeping methods.
        errors: Each target's error.
        residual: Norm of the weighted residual, which the steps work on.
        attempt: 0, or the number of the restart.
        status: None while running; the reason in a run's last state.
    """

    q: Array
    iteration: int
    joint_updates: int
    errors: tuple[TargetError, ...]
    residual: float
    attempt: int = 0
    status: Status | None = None

    @property
    def position_error(self) -> float | None:
        """The largest of the targets' [m]."""
        return largest_of(self.errors).position

    @property
    def orientation_error(self) -> float | None:
        """The largest of the targets' [rad]."""
        return largest_of(self.errors).orientation


def measure_errors(robot: Robot, targets: Sequence[Target], q: Array) -> tuple[TargetError, ...]:
    """Each target's error at `q`, by plain forward kinematics and nothing that the solvers use."""
    return tuple(_measure(robot, target, q) for target in targets)


def measure_positions(robot: Robot, target: Target, q: Array) -> Array:
    """Where a target's frame, or the tool in it, is at many configurations (N, nq), by the same: (N, 3) [m]."""
    model, data, frame = robot.model, robot.data, robot.frame_id(target.frame)
    reference = None if target.relative_to is None else robot.frame_id(target.relative_to)
    positions = np.empty((len(q), 3))
    for position, configuration in zip(positions, q, strict=True):
        pinocchio.forwardKinematics(model, data, configuration)
        placement = pinocchio.updateFramePlacement(model, data, frame)
        if reference is not None:
            placement = pinocchio.updateFramePlacement(model, data, reference).actInv(placement)
        position[:] = placement.translation if target.tool is None else placement.act(target.tool.translation)
    return positions


def _measure(robot: Robot, target: Target, q: Array) -> TargetError:
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
