"""The attempts of one solve: restarts, the best so far, and the verdict on it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

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

__all__ = ["Attempts"]

Array = NDArray[np.float64]

# Restarts that a target proved unreachable still gets: the nearest point has valleys too.
_RESTARTS_WHEN_UNREACHABLE = 8


@dataclass
class Attempts:
    """The attempts of one solve: the first from the start given, the others from drawn ones."""

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
    states: list[State] | None
    target: int = 0
    iterations: int = 0
    joint_updates: int = 0
    best: State | None = None

    def solution(self, began: float) -> Solution:
        """Run them and judge the best."""
        proof = shortfall(self.kinematics, self.limits)
        if proof is not None and proof.distance <= self.tolerance.position:
            proof = None
        if not self.kinematics.free.any():
            self.restarts = self.max_iterations = 0
        restarts = self.restarts if proof is None else min(self.restarts, _RESTARTS_WHEN_UNREACHABLE)
        patience = self.solver.patience if restarts else TO_THE_END
        status, attempt = Status.STALLED, 0
        for attempt in range(restarts + 1):
            start = self.start if attempt == 0 else self._drawn_start(attempt)
            if not self.restarts:  # the bare method, as `iterate` runs it
                status = self._attempt(start, attempt, patience)
            elif proof is None:
                status = self._attempt(start, attempt, patience, judge_limits_at_end=True)
            else:
                status = self._attempt(start, attempt, patience, downhill=True)
            if status in (Status.CONVERGED, Status.TIME_LIMIT):
                break
        assert self.best is not None
        if status not in (Status.CONVERGED, Status.TIME_LIMIT) and self.restarts:
            self.max_iterations = self.iterations_to_the_end
            status = self._attempt(self.best.q, attempt, TO_THE_END, downhill=True)
        return self._judged(status, proof, attempt, began)

    def _drawn_start(self, attempt: int) -> Array:
        return random_start(
            self.kinematics, self.limits, self.start, seed=self.seed, target=self.target, attempt=attempt
        )

    def _attempt(
        self,
        start: Array,
        attempt: int,
        patience: Patience,
        *,
        judge_limits_at_end: bool = False,
        downhill: bool = False,
    ) -> Status:
        states = run(
            self.solver,
            self.kinematics,
            self.limits,
            start,
            self.max_iterations,
            self.tolerance,
            patience,
            judge_limits_at_end=judge_limits_at_end,
            downhill=downhill,
            attempt=attempt,
        )
        state = None
        status = None
        for state in states:
            if self.states is not None:
                self.states.append(state)
            if (self.best is None or state.residual < self.best.residual) and self.limits.contains(state.q):
                self.best = state
            if self.deadline < math.inf and time.perf_counter() > self.deadline and state.status is None:
                status = Status.TIME_LIMIT
                break
        assert state is not None
        self.iterations += state.iteration
        self.joint_updates += state.joint_updates
        if state.status is Status.CONVERGED:
            self.best = state
        elif self.best is None or not self.limits.contains(state.q):
            self._consider_inside(state)
        return status or state.status or Status.STALLED

    def _consider_inside(self, state: State) -> None:
        """Take a state outside the limits for what it is worth inside."""
        at = self.kinematics.linearize(self.limits.clip(self.limits.wrap(state.q)))
        if self.best is None or at.residual < self.best.residual:
            self.best = state._replace(q=at.q, errors=tuple(at.errors), residual=at.residual)

    def _judged(self, status: Status, proof: Shortfall | None, attempt: int, began: float) -> Solution:
        assert self.best is not None
        robot, targets, q = self.kinematics.robot, self.kinematics.targets, self.best.q
        errors = measure_errors(robot, targets, q)
        if all(error.within(self.tolerance) for error in errors):
            status = Status.CONVERGED
        elif proof is not None:
            status = Status.UNREACHABLE
        elif status is Status.CONVERGED or not self.kinematics.free.any():
            status = Status.STALLED
        active = {name: side for name, side in self.limits.active(q).items() if self._moves(name)}
        return Solution(
            robot=robot,
            targets=targets,
            status=status,
            message=explain(status, targets, errors, self.tolerance, active, proof, bool(self.kinematics.free.any())),
            q=q,
            errors=errors,
            iterations=self.iterations,
            joint_updates=self.joint_updates,
            restarts=attempt,
            time=time.perf_counter() - began,
            active_limits=tuple(active),
            method=self.solver.name,
            parameters=self.solver.parameters,
            engine="python",
            trace=None if self.states is None else tuple(self.states),
        )

    def _moves(self, name: str) -> bool:
        return bool(self.kinematics.free[self.kinematics.robot.joint(name).idx_v])
