"""What a solve gives back: its verdict, the best configuration, and why it stopped."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .errors import SolveError
from .robot import Robot
from .targets import NO_DIRECTION, Target, TargetError, largest_of

__all__ = ["Solution", "State", "Status", "measure_errors"]

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


@dataclass(frozen=True, eq=False)
class Solution:
    """The answer of a solve, checked by plain Pinocchio.

    Attributes:
        robot: The robot.
        targets: What was asked for.
        status: Why the solve ended.
        message: The same in one sentence, with what is missing and which joints sit at their limits.
        q: The best configuration found (nq,), also on failure.
        errors: Each target's error at `q`, recomputed by plain forward kinematics.
        iterations: Steps taken in all attempts; sweeps for CCD.
        joint_updates: Single joints updated in all attempts, for CCD; 0 for methods that take whole steps.
        restarts: Fresh starts used.
        time: Seconds.
        active_limits: Names of the joints that sit at a limit.
        method: The solver's short name.
        parameters: The solver's parameters.
        engine: "python" or "native".
        trace: Every state of every attempt when asked for, else None.
    """

    robot: Robot
    targets: tuple[Target, ...]
    status: Status
    message: str
    q: Array
    errors: tuple[TargetError, ...]
    iterations: int
    joint_updates: int
    restarts: int
    time: float
    active_limits: tuple[str, ...]
    method: str
    parameters: dict[str, Any]
    engine: str
    trace: tuple[State, ...] | None = dataclasses.field(default=None, repr=False)

    def __bool__(self) -> bool:
        return self.success

    def __str__(self) -> str:
        return self.message

    @property
    def success(self) -> bool:
        """Whether every target is within tolerance."""
        return self.status is Status.CONVERGED

    @property
    def angles(self) -> dict[str, float]:
        """Joint name → rad, or m for prismatic joints, at `q`."""
        return self.robot.angles(self.q)

    @property
    def joint_placements(self) -> dict[str, pinocchio.SE3]:
        """Name → SE3 of the floating and planar joints at `q`."""
        return self.robot.joint_placements(self.q)

    @property
    def position_error(self) -> float | None:
        """The largest of the targets' [m]; None where no position was asked for."""
        return largest_of(self.errors).position

    @property
    def orientation_error(self) -> float | None:
        """The largest of the targets' [rad]; None where no orientation was asked for."""
        return largest_of(self.errors).orientation

    def raise_for_status(self) -> None:
        """Do nothing on success.

        Raises:
            SolveError: The targets were missed; the error carries this solution.
        """
        if not self.success:
            raise SolveError(self.message, self)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form, plain numbers, strings and lists; docs/json.md explains the fields."""
        targets = [
            target.to_dict() | {"position_error_m": error.position, "orientation_error_rad": error.orientation}
            for target, error in zip(self.targets, self.errors, strict=True)
        ]
        return {
            "schema": 1,
            "robot": self.robot.name,
            "targets": targets,
            "success": self.success,
            "status": self.status.name,
            "message": self.message,
            "angles": self.angles,
            "joint_placements": {name: M.homogeneous.tolist() for name, M in self.joint_placements.items()},
            "q": self.q.tolist(),
            "position_error_m": self.position_error,
            "orientation_error_rad": self.orientation_error,
            "iterations": self.iterations,
            "joint_updates": self.joint_updates,
            "restarts": self.restarts,
            "time_s": self.time,
            "active_limits": list(self.active_limits),
            "method": self.method,
            "parameters": {name: _jsonable(value) for name, value in self.parameters.items()},
            "engine": self.engine,
        }


def measure_errors(robot: Robot, targets: Sequence[Target], q: Array) -> tuple[TargetError, ...]:
    """Each target's error at `q`, by plain forward kinematics and nothing that the solvers use."""
    return tuple(_measure(robot, target, q) for target in targets)


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


def _jsonable(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None  # JSON has no infinity: None says "no bound"
    return value
