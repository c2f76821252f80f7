"""One robot with one solver in it, which chases the balls step after step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...errors import InputError
from ...model.limits import Limits
from ...problem.kinematics import Kinematics
from ...problem.targets import Target, Tolerance, largest_of
from ...robot import Robot
from ...solvers.base import Solver
from ...solving.message import explain
from ...solving.options import Options
from ...solving.question import Question
from ...solving.run import Pace, States, run
from ...solving.state import State, Status
from ...solving.verdict import judge
from .statistics import Statistics, StepFigures

__all__ = ["STATUSES", "Instance", "Standing", "StepSettings"]

Array = NDArray[np.float64]

STATUSES = ("IDLE", *(status.name for status in Status), "FAILED", "REFUSED")
"""How a step may end: as a solve, or with nothing asked for, with a solver of one's own that raised, or with a question
that the method cannot answer."""


@dataclass(frozen=True)
class StepSettings:
    """How a step goes, the same for all instances of a session.

    Attributes:
        limits: Whether joint limits hold.
        tolerance: What counts as reached.
        until_reached: Whether a step goes on until the targets are reached or the method gives up.
        at_most: Iterations of one step at most, where it does not.
    """

    limits: bool = True
    tolerance: Tolerance = field(default_factory=Tolerance)
    until_reached: bool = True
    at_most: int = 20


class Standing(NamedTuple):
    """Where an instance stands, in words.

    Attributes:
        status: One of `STATUSES`; UNREACHABLE only where that is proved.
        message: One sentence.
        position_error: The largest of the targets' [m], by plain forward kinematics; None where none is asked for.
        orientation_error: The same [rad].
        active_limits: Names of the joints that sit at a limit and could move a target.
    """

    status: str
    message: str
    position_error: float | None
    orientation_error: float | None
    active_limits: tuple[str, ...]


class _RefusedError(Exception):
    """The method cannot do what is asked; why, in words."""


class Instance:
    """One robot with one solver.

    Attributes:
        robot: The robot.
        q: Its configuration (nq,).
        statistics: Of its last steps.
        last: The figures of the last step; None before the first, and while nothing is asked for.
        status: One of `STATUSES`.
        counted: Whether the last step had something to do, and so counts in the statistics.
    """

    def __init__(
        self,
        robot: Robot,
        solver: Solver,
        home: Array,
        settings: StepSettings,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self.robot = robot
        self.statistics = Statistics()
        self._solver = solver
        self._settings = settings
        self._clock = clock
        self._all_limits = Limits.of(robot)
        self.put(home)

    @property
    def solver(self) -> Solver:
        """The method with its parameters."""
        return self._solver

    @solver.setter
    def solver(self, solver: Solver) -> None:
        self._solver = solver
        self.statistics.clear()
        self._forget_run()

    @property
    def settings(self) -> StepSettings:
        """How its steps go."""
        return self._settings

    @settings.setter
    def settings(self, settings: StepSettings) -> None:
        self._settings = settings
        self._forget_run()

    def put(self, q: Array) -> None:
        """Start again from `q` (nq,), with nothing in the statistics."""
        self.q = q
        self.statistics.clear()
        self._forget_run()

    def _forget_run(self, why: str = "no step was made yet") -> None:
        self.last: StepFigures | None = None
        self.status = "IDLE"
        self.counted = False
        self._idle = why
        self._states: States | None = None
        self._state: State | None = None
        self._question: Question | None = None
        self._targets: tuple[Target, ...] = ()
        self._trouble = ""

    def step(self, targets: Sequence[Target], seconds: float = math.inf) -> None:
        """Chase the targets for one simulation step, for about `seconds` at most.

        A step that begins with every target reached, and none moved, has nothing to do and does not count; nor does
        one whose question the method refuses.
        """
        asked = tuple(targets)
        if not asked:
            self._forget_run("nothing is asked for")
            return
        moved = len(asked) != len(self._targets) or any(a is not b for a, b in zip(asked, self._targets, strict=True))
        if moved and [target.shape for target in asked] != [target.shape for target in self._targets]:
            self._forget_run()  # another kind of question, which the method may refuse, or no longer
        self._targets = asked
        if self.status == "REFUSED":
            return
        self.counted = moved or self.status != Status.CONVERGED.name
        if not self.counted:
            self.last = self.last._replace(time=0.0, iterations=0, joint_updates=0, jump=0.0) if self.last else None
            return
        began, before, former = self._clock(), self.q, self._state
        try:
            state = self._run(asked, began + seconds)
        except _RefusedError as refusal:
            self.status, self.counted, self._trouble = "REFUSED", False, f"waiting: {refusal}"
            return
        except Exception as error:  # a solver of the user's own may raise whatever it likes
            self._fail(error, self._clock() - began)
            return
        spent = self._clock() - began
        self._state, self.q = state, state.q
        self.status = (state.status or Status.TIME_LIMIT).name
        off = largest_of(state.errors)
        self.last = StepFigures(
            time=spent,
            iterations=state.iteration - (former.iteration if former else 0),
            joint_updates=state.joint_updates - (former.joint_updates if former else 0),
            reached=state.status is Status.CONVERGED,
            error=off.position,
            jump=float(np.abs(pinocchio.difference(self.robot.model, before, state.q)).max(initial=0.0)),
        )
        self.statistics.add(self.last)

    def _run(self, targets: tuple[Target, ...], deadline: float) -> State:
        if self._states is None:
            self._states = self._begin(targets)
            state = next(self._states)
        else:
            state = self._states.send(targets)
        while state.status is None and self._clock() < deadline:
            state = next(self._states)
        return state

    def _begin(self, targets: tuple[Target, ...]) -> States:
        solver, settings = self._solver, self._settings
        options = Options(solver, limits=settings.limits, tolerance=settings.tolerance)
        try:
            self._question = Question.of(self.robot, targets, options)
        except InputError as error:
            raise _RefusedError(str(error)) from None
        limits, kinematics = self._question.limits, Kinematics.of(self._question.problem)
        most = solver.max_iterations if settings.until_reached else settings.at_most
        return run(self._question, kinematics, limits.clip(limits.wrap(self.q)), Pace(most))

    def _fail(self, error: Exception, spent: float) -> None:
        """A step that the solver did not survive counts as one that missed."""
        self._forget_run()
        self._trouble = f"the solver failed: {type(error).__name__}: {error}"
        self.last = StepFigures(spent, 0, 0, reached=False, error=None, jump=0.0)
        self.status, self.counted = "FAILED", True
        self.statistics.add(self.last)

    @property
    def orientation_error(self) -> float | None:
        """The largest of the targets' at the last step [rad]."""
        return None if self._state is None else largest_of(self._state.errors).orientation

    def limit_sides(self) -> dict[str, str]:
        """Joint name → "lower", "upper" or "both", for joints at a limit or beyond one, whether limits hold or not."""
        return self._all_limits.active(self.q)

    def verdict(self) -> Standing:
        """Where it stands, with the errors recomputed by plain forward kinematics, and why a target is missed."""
        if self._trouble:
            return Standing(self.status, self._trouble, None, None, ())
        if self._question is None or not self._targets:
            return Standing("IDLE", self._idle, None, None, ())
        question = self._question
        verdict = judge(question, self._targets, self.q, Status[self.status])
        active = question.active_limits(self.q) if question.options.limits else {}
        words = explain(question, self._targets, verdict, active)
        off = largest_of(verdict.errors)
        return Standing(verdict.status.name, words, off.position, off.orientation, tuple(active))
