"""The solution of a solve: its status, the best configuration and the remaining errors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import SolveError
from ..model.robot_model import RobotModel
from ..problem.targets import Target
from ..problem.tolerance import TargetError, largest_of
from ..shapes.collisions import Collision
from .alone import found_alone
from .attempts import Outcome
from .joint_bars import joint_bars
from .message import explain
from .native.module import why_not
from .native.outcomes import NativeOutcome
from .origin import unwound
from .question import Question
from .state import State, Status
from .verdict import Verdict

__all__ = ["Solution"]

if TYPE_CHECKING:
    from .. import _native

Array = NDArray[np.float64]

_IN_WORDS = (
    "robot", "method", "_parameters", "message", "active_limits", "collisions", "trace", "engine", "why_not_native",
)  # fmt: skip


class Solution:
    """The result of a solve, checked by plain Pinocchio."""

    _q: Array | None = None
    _turned: Mapping[str, float] = {}

    def __init__(
        self, outcome: Outcome | _native.Answer, question: Question, turned: Mapping[str, float] | None = None
    ) -> None:
        """Store the outcome of a solve; all other attributes are computed when they are first read.

        Args:
            outcome: The outcome.
            question: The problem and the options.
            turned: The start's angles [rad] of the continuous joints that were given by their angle.
        """
        self._came_to = outcome
        self._question = question
        if turned:
            self._turned = turned

    @property
    def _outcome(self) -> Outcome | NativeOutcome:
        outcome = self._came_to
        return outcome if isinstance(outcome, Outcome) else NativeOutcome(outcome, self._question.problem.targets)

    def __getstate__(self) -> dict[str, Any]:
        """Pickle the results only, without the compiled problem."""
        outcome = Outcome(*(getattr(self._outcome, name) for name in Outcome._fields))
        return {name: getattr(self, name) for name in _IN_WORDS} | {"_came_to": outcome, "_turned": dict(self._turned)}

    @cached_property
    def robot(self) -> RobotModel:
        """The robot."""
        return self._question.robot

    @cached_property
    def targets(self) -> tuple[Target, ...]:
        """The targets."""
        return self._outcome.targets

    @cached_property
    def time(self) -> float:
        """The duration of the solve [s]."""
        return self._outcome.time

    @cached_property
    def engine(self) -> str:
        """The engine that was used: "python" or "native"."""
        return self._outcome.engine

    @property
    def status(self) -> Status:
        """The reason why the solve ended."""
        return self._outcome.status

    @property
    def q(self) -> Array:
        """The best configuration found (nq,), also on failure; read-only, copy it to change it."""
        if self._q is None:  # not a `cached_property`, whose lock costs a microsecond
            q = self._came_to.q
            q.setflags(write=False)
            self._q = q
        return self._q

    @cached_property
    def errors(self) -> tuple[TargetError, ...]:
        """The error of each target at `q`, recomputed by plain forward kinematics."""
        return self._outcome.errors

    @cached_property
    def iterations(self) -> int:
        """The number of iterations in all attempts; sweeps for CCD."""
        return self._outcome.iterations

    @cached_property
    def joint_updates(self) -> int:
        """The number of single-joint updates in all attempts of CCD; 0 for methods that move all joints at once."""
        return self._outcome.joint_updates

    @cached_property
    def restarts(self) -> int:
        """The number of restarts used."""
        return self._outcome.restarts

    @cached_property
    def chosen_from(self) -> int:
        """The number of distinct answers that this one was chosen from.

        With `choose="first"` it is 1, unless the status is COLLIDING: then so many answers were found, up to whole
        turns, and all of them collide.
        """
        return self._outcome.chosen_from

    @cached_property
    def method(self) -> str:
        """The solver's short name."""
        return self._question.solver.name

    @cached_property
    def trace(self) -> tuple[State, ...] | None:
        """Every state of every attempt if a trace was requested, else None."""
        return self._outcome.states if self._question.options.trace else None

    @cached_property
    def message(self) -> str:
        """The status in one sentence, with the remaining errors and the joints at their limits.

        If a pose was missed and no proof says why, reading the message solves for the positions and the orientations
        alone, which takes milliseconds.
        """
        outcome = self._outcome
        verdict = Verdict(outcome.status, outcome.errors, outcome.proof)
        known = (Status.CONVERGED, Status.TIME_LIMIT, Status.COLLIDING)
        clueless = outcome.proof is None and outcome.status not in known
        alone = found_alone(self._question, self.targets, self.q) if clueless else []
        sides, chosen_from = self._sides_of_limits, outcome.chosen_from
        touching = self.collisions if outcome.status is Status.COLLIDING else ()
        return explain(self._question, self.targets, verdict, sides, alone, chosen_from, touching)

    @cached_property
    def collisions(self) -> tuple[Collision, ...]:
        """What touches at `q` of what was to be avoided, the deepest first; empty if nothing was."""
        guard = self._question.guard
        return () if guard is None else tuple(guard.collisions(self.q))

    @cached_property
    def active_limits(self) -> tuple[str, ...]:
        """The names of the joints that are at a limit and could move a target frame."""
        return tuple(self._sides_of_limits)

    @property
    def parameters(self) -> dict[str, Any]:
        """The solver's parameters; a new dictionary each time."""
        return dict(self._parameters)

    @cached_property
    def _parameters(self) -> dict[str, Any]:
        return self._question.solver.parameters

    @property
    def _sides_of_limits(self) -> dict[str, str]:
        return self._question.active_limits(self.q)

    def __repr__(self) -> str:
        return f"Solution({self.status.name}: {self.message}; {self.method}, {self.engine} engine, q={self.q})"

    def __bool__(self) -> bool:
        return self.success

    def __str__(self) -> str:
        return self.message

    def _repr_html_(self) -> str:
        """The message, and the joints as bars between their limits, as notebooks show them."""
        angles = self.angles
        return joint_bars(self.robot, self.message, self.success, np.array([list(angles.values())]), tuple(angles))

    @cached_property
    def why_not_native(self) -> str | None:
        """Why the compiled engine was not used; None if it was."""
        if self.engine == "native":
            return None
        return why_not(self._question.solver) or "the Python engine was requested"

    @property
    def success(self) -> bool:
        """Whether every target is within tolerance, and nothing touches that was to be avoided."""
        return self.status is Status.CONVERGED

    @property
    def angles(self) -> dict[str, float]:
        """Joint name → angle [rad], or displacement [m] for prismatic joints, at `q`.

        The angle of a continuous joint is the one nearest to its angle at the start: 3.35 after a start at 3.3, not
        −2.93. If the start was given as a configuration, its angle lies in (−π, π].
        """
        return unwound(self.robot, self.q, self._outcome.start, self._turned)

    @property
    def joint_placements(self) -> dict[str, pinocchio.SE3]:
        """Joint name → SE3 for the floating and planar joints, at `q`."""
        return self.robot.joint_placements(self.q)

    @property
    def position_error(self) -> float | None:
        """The largest position error of any target [m]; None if no target has a position."""
        return largest_of(self.errors).position

    @property
    def orientation_error(self) -> float | None:
        """The largest orientation error of any target [rad]; None if no target has an orientation."""
        return largest_of(self.errors).orientation

    def raise_for_status(self) -> None:
        """Raise an error unless this is a success.

        Raises:
            SolveError: A target was missed, or something touches; the error carries this solution.
        """
        if not self.success:
            raise SolveError(self.message, self)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form, made of plain numbers, strings, lists and dicts; docs/json.md explains the fields."""
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
            "chosen_from": self.chosen_from,
            "time_s": self.time,
            "active_limits": list(self.active_limits),
            "collisions": [
                {"pair": list(touch.pair), "with_world": touch.with_world, "depth_m": touch.depth}
                for touch in self.collisions
            ],
            "method": self.method,
            "parameters": {name: _jsonable(value) for name, value in self.parameters.items()},
            "engine": self.engine,
        }


def _jsonable(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None  # JSON has no infinity; None stands for "no bound"
    return dict(value) if isinstance(value, Mapping) else value
