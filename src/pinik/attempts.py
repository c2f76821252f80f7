"""The attempts of one solve: restarts, the best so far, and the verdict on it."""

from __future__ import annotations

import math
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics
from .limits import Limits
from .message import explain
from .reach import Shortfall, shortfall
from .run import TO_THE_END, run
from .solution import Solution, State, Status, measure_errors
from .solvers import Patience, Solver
from .starts import random_start
from .targets import Tolerance

__all__ = ["Attempts", "Settings"]

Array = NDArray[np.float64]

# Restarts that a target proved unreachable still gets: the nearest point has valleys too.
_RESTARTS_WHEN_UNREACHABLE = 8


class Settings(NamedTuple):
    """What a solve was asked for, checked.

    Attributes:
        start: The first attempt's configuration (nq,).
        max_iterations: Of one attempt.
        iterations_to_the_end: Of the last run, which follows the best of the failed attempts.
        deadline: On `time.perf_counter`'s clock [s].
        target: The number of this problem among many; a key of the drawn starts.
    """

    solver: Solver
    kinematics: Kinematics
    limits: Limits
    start: Array
    restarts: int
    seed: int
    max_iterations: int
    iterations_to_the_end: int
    tolerance: Tolerance
    deadline: float
    target: int = 0


class Attempts:
    """The attempts of one solve: the first from the start given, the others from drawn ones.

    Attributes:
        iterations, joint_updates: Of all attempts so far.
        restarts: Drawn starts used so far.
        best: The state inside the limits with the smallest residual so far.
        states: Every state so far, where a trace is wanted.
    """

    def __init__(self, settings: Settings, *, trace: bool) -> None:
        self.settings = settings
        self.iterations = 0
        self.joint_updates = 0
        self.restarts = 0
        self.best: State | None = None
        self.states: list[State] | None = [] if trace else None

    def solution(self, began: float) -> Solution:
        """Run them and judge the best; `began` is when the solve did [s]."""
        asked = self.settings
        proof = shortfall(asked.kinematics, asked.limits)
        if proof is not None and proof.distance <= asked.tolerance.position:
            proof = None
        if not asked.kinematics.free.any():
            self._attempt(asked.start, TO_THE_END, 0)
            status = Status.STALLED
        elif asked.restarts == 0:  # the bare method, as `iterate` runs it
            status = self._attempt(asked.start, TO_THE_END, asked.max_iterations)
        else:
            status = self._attempt_and_restart(proof)
        return self._judged(status, proof, began)

    def _attempt_and_restart(self, proof: Shortfall | None) -> Status:
        asked = self.settings
        most = asked.restarts if proof is None else min(asked.restarts, _RESTARTS_WHEN_UNREACHABLE)
        for self.restarts in range(most + 1):
            status = self._attempt(
                asked.start if self.restarts == 0 else self._drawn_start(),
                asked.solver.patience,
                asked.max_iterations,
                judge_limits_at_end=proof is None,
                downhill=proof is not None,
            )
            if status in (Status.CONVERGED, Status.TIME_LIMIT):
                return status
        assert self.best is not None
        return self._attempt(self.best.q, TO_THE_END, asked.iterations_to_the_end, downhill=True)

    def _drawn_start(self) -> Array:
        asked = self.settings
        return random_start(
            asked.kinematics,
            asked.limits,
            asked.start,
            seed=asked.seed,
            target=asked.target,
            attempt=self.restarts,
        )

    def _attempt(
        self,
        start: Array,
        patience: Patience,
        max_iterations: int,
        *,
        judge_limits_at_end: bool = False,
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
            judge_limits_at_end=judge_limits_at_end,
            downhill=downhill,
            attempt=self.restarts,
        )
        for state in states:
            if self.states is not None:
                self.states.append(state)
            if (self.best is None or state.residual < self.best.residual) and asked.limits.contains(state.q):
                self.best = state
            status = state.status
            if status is None and asked.deadline < math.inf and time.perf_counter() > asked.deadline:
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

    def _judged(self, status: Status, proof: Shortfall | None, began: float) -> Solution:
        """The best state, measured by plain forward kinematics, which has the last word."""
        assert self.best is not None
        asked, kinematics, q = self.settings, self.settings.kinematics, self.best.q.copy()
        robot, targets = kinematics.robot, kinematics.targets
        errors = measure_errors(robot, targets, q)
        if all(error.within(asked.tolerance) for error in errors):
            status = Status.CONVERGED
        elif proof is not None:
            status = Status.UNREACHABLE
        elif status is Status.CONVERGED:
            status = Status.STALLED
        sides = asked.limits.active(q)
        active = {name: side for name, side in sides.items() if kinematics.free[robot.joint(name).idx_v]}
        moves = bool(kinematics.free.any())
        return Solution(
            robot=robot,
            targets=targets,
            status=status,
            message=explain(status, targets, errors, asked.tolerance, active, proof, moves),
            q=q,
            errors=errors,
            iterations=self.iterations,
            joint_updates=self.joint_updates,
            restarts=self.restarts,
            time=time.perf_counter() - began,
            active_limits=tuple(active),
            method=asked.solver.name,
            parameters=asked.solver.parameters,
            engine="python",
            trace=None if self.states is None else tuple(self.states),
        )
