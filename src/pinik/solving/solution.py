"""What a solve gives back: its verdict, the best configuration, and why it stopped."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import SolveError
from ..model.robot_model import Robot
from ..problem.targets import Target, TargetError, largest_of
from .attempts import Outcome, Settings
from .message import explain
from .native.answers import Answer
from .native.module import why_not
from .state import State, Status

__all__ = ["Solution"]

if TYPE_CHECKING:
    from .. import _native

Array = NDArray[np.float64]

_IN_WORDS = ("robot", "method", "parameters", "message", "active_limits", "trace", "engine", "why_not_native")


class Solution:
    """The answer of a solve, checked by plain Pinocchio."""

    _q: Array | None = None

    def __init__(self, outcome: Outcome | _native.Answer, asked: Settings) -> None:
        """Keep what a solve came to; it is put into words when somebody looks."""
        self._came_to = outcome
        self._asked = asked

    @property
    def _outcome(self) -> Outcome | Answer:
        outcome = self._came_to
        return outcome if isinstance(outcome, Outcome) else Answer(outcome, self._asked.kinematics.targets)

    def __getstate__(self) -> dict[str, Any]:
        """Everything in words and numbers: what it was computed with stays here."""
        outcome = Outcome(*(getattr(self._outcome, name) for name in Outcome._fields))
        return {name: getattr(self, name) for name in _IN_WORDS} | {"_came_to": outcome}

    @cached_property
    def robot(self) -> Robot:
        """The robot."""
        return self._asked.kinematics.robot

    @cached_property
    def targets(self) -> tuple[Target, ...]:
        """What was asked for."""
        return self._outcome.targets

    @cached_property
    def time(self) -> float:
        """Seconds that the engine took."""
        return self._outcome.time

    @cached_property
    def engine(self) -> str:
        """Which one computed: "python" or "native"."""
        return self._outcome.engine

    @property
    def status(self) -> Status:
        """Why the solve ended."""
        return self._outcome.status

    @property
    def q(self) -> Array:
        """The best configuration found (nq,), also on failure."""
        if self._q is None:  # `cached_property` takes a lock, and a microsecond
            q = self._came_to.q
            self._q = q.copy() if isinstance(self._came_to, Outcome) else q  # the caller's own
        return self._q

    @cached_property
    def errors(self) -> tuple[TargetError, ...]:
        """Each target's error at `q`, recomputed by plain forward kinematics."""
        return self._outcome.errors

    @cached_property
    def iterations(self) -> int:
        """Steps taken in all attempts; sweeps for CCD."""
        return self._outcome.iterations

    @cached_property
    def joint_updates(self) -> int:
        """Single joints updated in all attempts, for CCD; 0 for methods that take whole steps."""
        return self._outcome.joint_updates

    @cached_property
    def restarts(self) -> int:
        """Fresh starts used."""
        return self._outcome.restarts

    @cached_property
    def method(self) -> str:
        """The solver's short name."""
        return self._asked.solver.name

    @cached_property
    def trace(self) -> tuple[State, ...] | None:
        """Every state of every attempt when asked for, else None."""
        return self._outcome.states if self._asked.trace else None

    @cached_property
    def message(self) -> str:
        """The status in one sentence, with what is missing and which joints sit at their limits."""
        asked, outcome = self._asked, self._outcome
        return explain(
            outcome.status,
            self.targets,
            outcome.errors,
            asked.tolerance,
            self._sides_of_limits,
            outcome.proof,
            asked.solver.off_plane(self.robot, self.targets),
            anything_moves=bool(asked.kinematics.free.any()),
        )

    @cached_property
    def active_limits(self) -> tuple[str, ...]:
        """Names of the joints that sit at a limit and could have moved a target."""
        return tuple(self._sides_of_limits)

    @cached_property
    def parameters(self) -> dict[str, Any]:
        """The solver's parameters."""
        return self._asked.solver.parameters

    @property
    def _sides_of_limits(self) -> dict[str, str]:
        free = self._asked.kinematics.free
        sides = self._asked.limits.active(self._came_to.q)
        return {name: side for name, side in sides.items() if free[self.robot.joint(name).idx_v]}

    def __repr__(self) -> str:
        return f"Solution({self.status.name}: {self.message}; {self.method}, {self.engine} engine, q={self.q})"

    def __bool__(self) -> bool:
        return self.success

    def __str__(self) -> str:
        return self.message

    @cached_property
    def why_not_native(self) -> str | None:
        """Why the compiled engine was not used, where it was not."""
        if self.engine == "native":
            return None
        return why_not(self._asked.solver) or "the Python engine was asked for"

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


def _jsonable(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None  # JSON has no infinity: None says "no bound"
    return value
