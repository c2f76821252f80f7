"""The attempts of one solve: restarts, and the best so far."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.limits import Limits
from ..problem.kinematics import Kinematics
from ..problem.reach import Shortfall, shortfall
from ..problem.targets import Target, TargetError, Tolerance
from ..solvers.base import Patience, Solver
from .run import TO_THE_END, run
from .starts import Starts
from .state import State, Status, measure_errors

__all__ = ["Outcome", "Settings", "attempt_all", "is_nearest"]

Array = NDArray[np.float64]

# Restarts that a target proved unreachable still gets: the nearest point has valleys too.
RESTARTS_WHEN_UNREACHABLE = 8
# Of the chain's length: what an exact method may be off by.
_EXACT = 1e-5


class Settings(NamedTuple):
    """What a solve was asked for, checked.

    Attributes:
        starts: Where the attempts after the first begin.
        start: The first attempt's configuration (nq,), put inside the limits.
        nearest: Whether the first attempt begins where `starts` says as well; what is not drawn is then as in `start`.
        max_iterations: Of one attempt.
        iterations_to_the_end: Of the last run, which follows the best of the failed attempts.
        time_limit: Of the whole solve [s]; infinite where there is none.
        target: The number of this problem among many; a key of the drawn starts.
        trace: Whether every state is kept.
    """

    solver: Solver
    kinematics: Kinematics
    limits: Limits
    starts: Starts
    start: Array
    restarts: int
    seed: int
    max_iterations: int
    iterations_to_the_end: int
    tolerance: Tolerance
    time_limit: float = math.inf
    target: int = 0
    trace: bool = False
    nearest: bool = False


class Outcome(NamedTuple):
    """What the attempts came to.

    Attributes:
        status: The verdict on `q`, with the errors as plain forward kinematics finds them.
        q: The best configuration (nq,), inside the limits.
        errors: Each target's error there.
        iterations, joint_updates: Of all attempts.
        restarts: Drawn starts used.
        proof: Why a target is out of reach, where one is.
        states: Every state of every attempt, where a trace is wanted.
        targets: What was asked for.
        time: Seconds.
        engine: Which one computed: "python" or "native".
    """

    status: Status
    q: Array
    errors: tuple[TargetError, ...]
    iterations: int
    joint_updates: int
    restarts: int
    proof: Shortfall | None
    states: tuple[State, ...]
    targets: tuple[Target, ...]
    time: float
    engine: str = "python"


def attempt_all(settings: Settings, began: float) -> Outcome:
    """Make the attempts: the first from the start given, the others from drawn ones, until one reaches the targets.

    `began` is when the solve did, on `time.perf_counter`'s clock [s].
    """
    return _Attempts(settings, began).outcome()


def is_nearest(solver: Solver, kinematics: Kinematics, errors: Sequence[TargetError], tolerance: Tolerance) -> bool:
    """Whether a run that stalled came as near as can be: its method stops nowhere else, and it missed the targets by
    more than that may be off by."""
    least = tolerance.position + _EXACT * kinematics.size_of_chain
    return solver.exact and any(error.position is not None and error.position > least for error in errors)


class _Attempts:
    """Attempts under way.

    Attributes:
        iterations, joint_updates: Of all attempts so far.
        restarts: Drawn starts used so far.
        best: The state inside the limits with the smallest residual so far.
        states: Every state so far, where a trace is wanted.
    """

    def __init__(self, settings: Settings, began: float) -> None:
        self.settings = settings._replace(start=settings.limits.clip(settings.limits.wrap(settings.start)))
        self.began = began
        self.deadline = began + settings.time_limit
        self.iterations = 0
        self.joint_updates = 0
        self.restarts = 0
        self.best: State | None = None
        self.states: list[State] = []

    def outcome(self) -> Outcome:
        """Make them and judge the best."""
        asked = self.settings
        proof = shortfall(asked.kinematics, asked.limits, asked.tolerance.position)
        if not asked.kinematics.free.any():
            self._attempt(self._start(), TO_THE_END, 0)
            status = Status.STALLED
        elif asked.restarts == 0 or asked.solver.exact:  # the bare method, as `iterate` runs it
            status = self._attempt(self._start(), TO_THE_END, asked.max_iterations)
        else:
            status = self._attempt_and_restart(proof)
        return self._judged(status, proof)

    def _attempt_and_restart(self, proof: Shortfall | None) -> Status:
        asked = self.settings
        most = asked.restarts if asked.starts.draws else 0
        if proof is not None:
            most = min(most, RESTARTS_WHEN_UNREACHABLE)
        for self.restarts in range(most + 1):
            status = self._attempt(
                self._start(),
                asked.solver.patience,
                asked.max_iterations,
                bold=proof is None,
                downhill=proof is not None,
            )
            if status in (Status.CONVERGED, Status.TIME_LIMIT):
                return status
        assert self.best is not None
        return self._attempt(self.best.q, TO_THE_END, asked.iterations_to_the_end, downhill=True)

    def _start(self) -> Array:
        asked = self.settings
        number = self.restarts + asked.nearest
        return asked.starts.next(asked.start, target=asked.target, number=number) if number else asked.start

    def _attempt(
        self,
        start: Array,
        patience: Patience,
        max_iterations: int,
        *,
        bold: bool = False,
        downhill: bool = False,
    ) -> Status:
        asked = self.settings
        states = run(
            asked.solver,
            asked.kinematics,
            asked.limits,
            start,
            max_iterations,
            asked.tolerance,
            patience,
            bold=bold,
            downhill=downhill,
            attempt=self.restarts,
        )
        for state in states:
            if asked.trace:
                self.states.append(state)
            if (self.best is None or state.residual < self.best.residual) and asked.limits.contains(state.q):
                self.best = state
            status = state.status
            if status is None and self.deadline < math.inf and time.perf_counter() > self.deadline:
                status = Status.TIME_LIMIT
            if status is not None:
                break
        self.iterations += state.iteration
        self.joint_updates += state.joint_updates
        if status is Status.CONVERGED:
            self.best = state
        elif not asked.limits.contains(state.q):
            self._consider_inside(state)
        assert status is not None  # a run's last state has one
        return status

    def _consider_inside(self, state: State) -> None:
        """Take a state outside the limits for what it is worth inside."""
        limits = self.settings.limits
        at = self.settings.kinematics.linearize(limits.clip(limits.wrap(state.q)))
        if self.best is None or at.residual < self.best.residual:
            self.best = state._replace(q=at.q, errors=tuple(at.errors), residual=at.residual)

    def _judged(self, status: Status, proof: Shortfall | None) -> Outcome:
        """The best state, measured by plain forward kinematics, which has the last word."""
        assert self.best is not None
        asked, q = self.settings, self.best.q.copy()
        errors = measure_errors(asked.kinematics.robot, asked.kinematics.targets, q)
        if all(error.within(asked.tolerance) for error in errors):
            status = Status.CONVERGED
        elif proof is not None or (
            status is Status.STALLED and is_nearest(asked.solver, asked.kinematics, errors, asked.tolerance)
        ):
            status = Status.UNREACHABLE
        elif status is Status.CONVERGED:
            status = Status.STALLED
        return Outcome(
            status, q, errors, self.iterations, self.joint_updates, self.restarts, proof, tuple(self.states),
            asked.kinematics.targets, time.perf_counter() - self.began,
        )  # fmt: skip
