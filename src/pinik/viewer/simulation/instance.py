"""One robot with one solver, which chases the balls step by step."""

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
from ...motion.figures import StepFigures
from ...problem.targets import Target
from ...problem.tolerance import Tolerance, largest_of
from ...robot import Robot
from ...shapes.avoid import Avoid
from ...solvers.base import Solver
from ...solving.message import explain
from ...solving.native.module import engine_for
from ...solving.options import Options
from ...solving.pursuit import Pursuit, pursue
from ...solving.question import Question
from ...solving.state import State, Status
from ...solving.verdict import judge, measure_errors
from .contacts import Contacts
from .detour import Detours

__all__ = ["STATUSES", "Instance", "Standing", "StepSettings", "same_objects"]

Array = NDArray[np.float64]

STATUSES = ("IDLE", *(status.name for status in Status), "FAILED", "REFUSED")
"""How a step may end: with the status of a solve; IDLE without targets; FAILED if a custom solver raised an exception;
REFUSED if the method cannot solve for these targets."""


_STILL = 1e-7
"""The largest change of a joint in one step [rad or m] that nobody sees."""


def same_objects(some: Sequence[object], others: Sequence[object]) -> bool:
    """Whether two sequences hold the very same objects."""
    return len(some) == len(others) and all(a is b for a, b in zip(some, others, strict=True))


@dataclass(frozen=True)
class StepSettings:
    """How a step goes, the same for all instances of a session.

    Attributes:
        limits: Whether the joint limits are enforced.
        tolerance: The errors that count as reached.
        until_reached: Whether a step runs until the targets are reached or the method gives up.
        at_most: The maximum number of iterations per step if `until_reached` is False.
        polish: Whether methods that converge quadratically go on within the tolerance; off, so that the methods are
            compared by their iterations until the tolerance.
    """

    limits: bool = True
    tolerance: Tolerance = field(default_factory=Tolerance)
    until_reached: bool = True
    at_most: int = 20
    polish: bool = False


class Standing(NamedTuple):
    """The present result of an instance.

    Attributes:
        status: One of `STATUSES`; UNREACHABLE only if there is a proof.
        message: An explanation in one sentence.
        position_error: The largest position error of any target [m], by plain forward kinematics; None if no target
            has a position.
        orientation_error: The largest orientation error [rad], likewise.
        active_limits: Names of the joints that are at a limit and could move a target frame.
    """

    status: str
    message: str
    position_error: float | None
    orientation_error: float | None
    active_limits: tuple[str, ...]


class _RefusedError(Exception):
    """The method cannot solve for these targets; the message says why."""


class Instance:
    """One robot with one solver.

    Attributes:
        robot: The robot.
        q: Its configuration (nq,).
        contacts: What it touches, and whether it avoids that.
        last: The figures of the last step; None before the first step and while there are no targets.
        status: One of `STATUSES`.
        counted: Whether the last step had work to do, and so counts in the statistics, for all instances alike.
    """

    def __init__(
        self,
        robot: Robot,
        solver: Solver,
        home: Array,
        settings: StepSettings,
        clock: Callable[[], float] = time.perf_counter,
        contacts: Contacts | None = None,
    ) -> None:
        self.robot = robot
        self.contacts = contacts or Contacts(robot)
        self._detours = Detours(robot)
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
        """Start again from `q` (nq,)."""
        self.q = q
        self._forget_run()

    def pose(self, q: Array) -> None:
        """Take a pose (nq,) that somebody set by hand, and keep the statistics."""
        self.q = q
        self._forget_run("its joints lead, and the balls follow")

    def _forget_run(self, why: str = "no step has been taken yet") -> None:
        self.last: StepFigures | None = None
        self.status = "IDLE"
        self.counted = False
        self._idle = why
        self._pursuit: Pursuit | None = None
        self._state: State | None = None
        self._question: Question | None = None
        self._targets: tuple[Target, ...] = ()
        self._avoided: Avoid | None = None
        self._trouble = self._blocked = ""
        self._paused = False

    def step(self, targets: Sequence[Target], seconds: float = math.inf) -> None:
        """Follow the targets for one simulation step, for about `seconds` at most.

        A step does not count if all targets are reached already and none has moved, or if the method cannot solve for
        these targets.
        """
        asked = tuple(targets)
        if not asked:
            self._forget_run("there are no targets")
            return
        avoided = self.contacts.avoided
        moved = not same_objects(asked, self._targets) or avoided != self._avoided
        self._avoided = avoided
        if moved and [target.shape for target in asked] != [target.shape for target in self._targets]:
            self._forget_run()  # the kinds of the targets changed, so whether the method can solve for them may change
        self._targets = asked
        if self.status == "REFUSED":
            return
        self.counted = moved or self.status != Status.CONVERGED.name
        if not self.counted or (self._blocked and not moved):
            if self.last:
                self.last = self.last._replace(
                    time=0.0, iterations=0, joint_updates=0, jump=0.0, idle=True, cut_off=False
                )
            return
        self._paused = False
        began, before, former = self._clock(), self.q, self._state if self._pursuit else None
        try:
            state = self._kept_free(self._run(asked, began + seconds), asked)
        except _RefusedError as refusal:
            self.status, self.counted, self._trouble = "REFUSED", False, f"waiting: {refusal}"
            return
        except Exception as error:  # a custom solver may raise any exception
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
            cut_off=state.status is None,
        )

    def step_iteration(self, targets: Sequence[Target]) -> None:
        """Take one iteration instead of a whole step, which does not count.

        Nothing happens if all targets are reached, or if the method cannot solve for them.
        """
        for _ in range(2):  # the first one only begins a run, if none is under way
            self.step(targets, 0.0)
            if self.status != Status.TIME_LIMIT.name or (self.last and self.last.iterations > 0):
                break
        self.counted = False
        self._paused = self.status == Status.TIME_LIMIT.name

    def _run(self, targets: tuple[Target, ...], deadline: float) -> State:
        if self._pursuit is None:
            self._pursuit = self._begin(targets)
            state = self._pursuit.state
        else:
            state = self._pursuit.aim_at(targets)
        while state.status is None and self._clock() < deadline:
            state = self._pursuit.advance(self._pursuit.at_once)
        return state

    def _kept_free(self, state: State, targets: tuple[Target, ...]) -> State:
        """A state, or another one that touches nothing if things are to be avoided: the way round, or this place."""
        self._blocked, guard = "", self.contacts.guard
        if self._avoided is None or guard is None or not guard.touches(state.q):
            return state
        assert self._question is not None
        free = self._detours.find(targets, self.q, self._question.options, self._avoided)
        self._pursuit = None  # the next step begins where this one ends
        if free.success:
            return state._replace(q=free.q, errors=free.errors, status=Status.CONVERGED)
        self._blocked = free.message
        errors = measure_errors(self.robot, targets, self.q, self._question.options.tolerance)
        return state._replace(q=self.q, errors=errors, status=Status.COLLIDING)

    def _begin(self, targets: tuple[Target, ...]) -> Pursuit:
        solver, settings = self._solver, self._settings
        options = Options(solver, limits=settings.limits, tolerance=settings.tolerance, polish=settings.polish)
        try:
            self._question = Question.of(self.robot, targets, options)
        except InputError as error:
            raise _RefusedError(str(error)) from None
        most = solver.max_iterations if settings.until_reached else settings.at_most
        return pursue(self._question, self._question.limits.wrap(self.q), most)

    def _fail(self, error: Exception, spent: float) -> None:
        """Count a step in which the solver raised an exception as a miss."""
        self._forget_run()
        self._trouble = f"the solver failed: {type(error).__name__}: {error}"
        self.last = StepFigures(spent, 0, 0, reached=False, error=None, jump=0.0)
        self.status, self.counted = "FAILED", True

    @property
    def engine(self) -> str:
        """The engine that steps it: "native" or "python"."""
        return engine_for(self._solver, "auto")

    @property
    def moves(self) -> bool:
        """Whether the last step moved a joint as far as anybody can see."""
        return self.last is not None and self.last.jump > _STILL

    @property
    def orientation_error(self) -> float | None:
        """The largest orientation error of any target at the last step [rad]."""
        return None if self._state is None else largest_of(self._state.errors).orientation

    def limit_sides(self) -> dict[str, str]:
        """Joint name → "lower", "upper" or "both", for joints at or beyond a limit, even if limits are not enforced."""
        return self._all_limits.active(self.q)

    def verdict(self) -> Standing:
        """The present result: errors recomputed by plain forward kinematics, and the reason if a target is missed."""
        if self._trouble:
            return Standing(self.status, self._trouble, None, None, ())
        if self._question is None or not self._targets:
            return Standing("IDLE", self._idle, None, None, ())
        question = self._question
        verdict = judge(question, self._targets, self.q, Status[self.status])
        active = question.active_limits(self.q) if question.options.limits else {}
        words = explain(question, self._targets, verdict, active)
        if self._paused and self._state is not None:
            words = words.replace("out of time,", f"between two iterations, {self._state.iteration} taken,", 1)
        off = largest_of(verdict.errors)
        if self._blocked:
            words = f"waits, since every answer that was found touches something: {self._blocked}"
            return Standing(Status.COLLIDING.name, words, off.position, off.orientation, tuple(active))
        return Standing(verdict.status.name, words, off.position, off.orientation, tuple(active))
