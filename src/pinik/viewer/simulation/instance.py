"""One robot with one solver, which chases the balls step by step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...errors import InputError
from ...model.limits import Limits
from ...motion.figures import StepFigures
from ...problem.targets import Target
from ...problem.tolerance import largest_of
from ...robot import Robot
from ...shapes.avoid import Avoid
from ...solvers.base import Solver
from ...solving.message import explain, how_far
from ...solving.native.module import engine_for
from ...solving.options import Options
from ...solving.pursuit import Pursuit, pursue
from ...solving.question import Question
from ...solving.state import State, Status
from ...solving.verdict import judge, measure_errors
from .contacts import Contacts
from .detour import Detours
from .standing import Standing
from .step_settings import StepSettings

__all__ = ["Instance", "same_objects"]

Array = NDArray[np.float64]

_STILL = 1e-7
"""The largest change of a joint in one step [rad or m] that nobody sees."""
_NOWHERE = 1e-10
"""The largest change of a joint in a step [rad or m] from which the next one would begin in the same place."""
_GIVEN_UP = 2
"""How many steps in a row stall in one place before the method is asked no more."""
_LONGEST = 0.5
"""How long a step may last in all [s], even if the solver does not compute meanwhile but waits for something."""
_NO_TARGETS = "there are no targets"


def same_objects(some: Sequence[object], others: Sequence[object]) -> bool:
    """Whether two sequences hold the very same objects."""
    return len(some) == len(others) and all(a is b for a, b in zip(some, others, strict=True))


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
        clock: Callable[[], float] = time.thread_time,
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
        self._stalls = 0
        self._paused = False
        self._earlier = 0  # iterations of this run for targets that have moved since

    def step(self, targets: Sequence[Target], seconds: float = math.inf) -> None:
        """Follow the targets for one simulation step, in which the solver computes for about `seconds` at most.

        A step does not count if none of the targets has moved and all are reached already, or the method has stalled
        without getting anywhere twice, nor if the method cannot solve for these targets.
        """
        asked = tuple(targets)
        if not asked:
            self._forget_run(_NO_TARGETS)
            return
        avoided = self.contacts.avoided
        moved = not same_objects(asked, self._targets) or avoided is not self._avoided
        self._avoided = avoided
        if moved and [target.shape for target in asked] != [target.shape for target in self._targets]:
            self._forget_run()  # the kinds of the targets changed, so whether the method can solve for them may change
        self._targets = asked
        if self.status == "REFUSED":
            return
        self.counted = moved or not (self.status == Status.CONVERGED.name or self._stalls >= _GIVEN_UP)
        if not self.counted or (self._blocked and not moved):
            if self.last:
                self.last = self.last._replace(
                    time=0.0, iterations=0, joint_updates=0, jump=0.0, idle=True, cut_off=False
                )
            return
        self._paused, self._blocked = False, ""
        began, before, former = self._clock(), self.q, self._state if self._pursuit else None
        if moved or former is None:
            self._earlier = former.iteration if former else 0
        try:
            state = self._run(asked, began, seconds)
            if avoided is not None and self._question is not None and self.contacts.touches(state.q):
                self._pursuit = None  # the next step begins where this one ends
                state, self._blocked = self._detours.around(state, asked, before, self._question.options, avoided)
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
        gave_up = state.status is Status.STALLED and self.last.jump <= _NOWHERE
        self._stalls = self._stalls + 1 if gave_up else 0

    def step_iteration(self, targets: Sequence[Target]) -> None:
        """Take one iteration instead of a whole step, which does not count.

        Nothing happens if all targets are reached, or if the method cannot solve for them.
        """
        self._stalls = 0
        for _ in range(2):  # the first one only begins a run, if none is under way
            self.step(targets, 0.0)
            if self.status != Status.TIME_LIMIT.name or (self.last and self.last.iterations > 0):
                break
        self.counted = False
        self._paused = self.status == Status.TIME_LIMIT.name

    def _run(self, targets: tuple[Target, ...], began: float, seconds: float) -> State:
        if self._pursuit is None:
            self._pursuit = self._begin(targets)
            state, began = self._pursuit.state, self._clock()  # the solver's time begins once it is prepared
        else:
            state = self._pursuit.aim_at(targets)
        deadline, latest = began + seconds, time.perf_counter() + _LONGEST
        while state.status is None and self._clock() < deadline and time.perf_counter() < latest:
            state = self._pursuit.advance(self._pursuit.at_once)
        return state

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

    def verdict(self, asked: Sequence[Target] | None = None) -> Standing:
        """The present result: errors recomputed by plain forward kinematics, and the reason if a target is missed.

        Args:
            asked: What the balls ask for now. If it is not what the last step was taken for, the result is IDLE, with
                the errors that are left. When None, the result is that of the last step.
        """
        if self._trouble:
            return Standing(self.status, self._trouble, None, None, ())
        if self._question is None or not self._targets:
            return Standing("IDLE", self._idle, None, None, ())
        if asked is not None and not same_objects(asked, self._targets):
            return self._overdue(asked)
        question = self._question
        verdict = judge(question, self._targets, self.q, Status[self.status])
        active = question.active_limits(self.q) if question.options.limits else {}
        words = explain(question, self._targets, verdict, active)
        if self._paused and self._state is not None:
            taken = self._state.iteration - self._earlier
            words = words.replace("out of time,", f"between two iterations, {taken} taken,", 1)
        off = largest_of(verdict.errors)
        if self._blocked:
            words = f"waits, since every answer that was found touches something: {self._blocked}"
            return Standing(Status.COLLIDING.name, words, off.position, off.orientation, tuple(active))
        return Standing(verdict.status.name, words, off.position, off.orientation, tuple(active))

    def _overdue(self, asked: Sequence[Target]) -> Standing:
        """The result while a step is due, because a ball has changed since the last one."""
        if not asked:
            return Standing("IDLE", _NO_TARGETS, None, None, ())
        errors = measure_errors(self.robot, asked, self.q, self._settings.tolerance)
        off = largest_of(errors)
        words = f"no step has been taken since a ball changed; {how_far(errors)} off"
        return Standing("IDLE", words, off.position, off.orientation, ())
