"""One method that chases a ball, step after step, each from where the last one ended."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import EngineError
from ..model.robot_model import RobotModel
from ..problem.kinematics import Kinematics
from ..problem.targets import Target, Tolerance
from ..robot import Robot
from ..solvers.base import Patience, Solver
from ..solving.front import prepare
from ..solving.options import Options
from ..solving.prepared import Prepared
from ..solving.question import Question
from ..solving.run import Pace, run
from ..solving.state import Status
from ..solving.verdict import measure_errors

__all__ = ["LAP", "PROGRAM", "BareChase", "Chase", "EngineChase", "Rules", "Step", "chase_with"]

Array = NDArray[np.float64]
Clock = Callable[[], float]

LAP = 480
"""Steps once round a curve: the live view's eight seconds at 60 frames a second."""
PROGRAM = "program"
"""The engine of a chase that is the thesis's own program, whose joints are bones."""
NEVER_STALLED = Patience(10**9, 0.0)


@dataclass(frozen=True, kw_only=True)
class Rules:
    """How the methods are run.

    Attributes:
        tolerance: What counts as reached.
        max_iterations: Of one step, or of one attempt where there are restarts; the solver's own number when None.
        restarts: Fresh starts of one step; the solver's own number when None.
        bare: Whether a step knows no stalls and ends where its last iteration did, as the thesis's program does; else
            it ends as `pinik.solve` does, at the best configuration.
        lap: Steps once round the curve.
        rest: Steps that a random ball stays at a place.
        pieces: Equal parts in which the ball moves from place to place, each of them solved.
    """

    tolerance: Tolerance
    max_iterations: int | None = None
    restarts: int | None = 0
    bare: bool = False
    lap: int = LAP
    rest: int = 1
    pieces: int = 1


class Step(NamedTuple):
    """One step of one method.

    Attributes:
        time: Seconds.
        iterations: Iterations; sweeps for CCD.
        joint_updates: Single joints updated, for CCD.
        reached: Whether the ball was within tolerance at the end.
        error: How far off it was [m].
        jump: The largest change of one joint [rad or m].
    """

    time: float
    iterations: int
    joint_updates: int
    reached: bool
    error: float
    jump: float


class Chase(Protocol):
    """One method at work; it remembers where it stands."""

    engine: str

    def step(self, place: Array) -> Step:
        """Chase the ball to a place (3,) [m]."""
        ...


class EngineChase:
    """A step is a solve, by either engine."""

    def __init__(self, prepared: Prepared, start: Array) -> None:
        """Begin at `start` (nq,)."""
        self.engine = prepared.engine
        self._prepared = prepared
        self._q = start

    def step(self, place: Array) -> Step:
        """Solve from where the last step ended."""
        before = self._q
        solution = self._prepared(place, before)
        self._q = solution.q
        error = solution.position_error
        assert error is not None
        return Step(
            solution.time,
            solution.iterations,
            solution.joint_updates,
            solution.success,
            error,
            largest_change(self._prepared.robot, before, self._q),
        )


class BareChase:
    """A step is the bare loop: it knows no stalls, no restarts and no best so far."""

    engine = "python"

    def __init__(
        self, robot: Robot, frame: str, solver: Solver, limits: bool, rules: Rules, start: Array, clock: Clock
    ) -> None:
        """Begin at `start` (nq,)."""
        target = Target(frame, robot.placement(frame, start).translation)
        options = Options(solver, limits=limits, tolerance=rules.tolerance, max_iterations=rules.max_iterations)
        question = Question.of(robot, target, options)
        self._target, self._robot, self._tolerance, self._clock = target, robot, rules.tolerance, clock
        inside = question.limits.clip(question.limits.wrap(start))
        pace = Pace(options.iterations_at_most, NEVER_STALLED)
        self._states = run(question, Kinematics.of(question.problem), inside, pace)
        self._state = next(self._states)  # reached: the ball begins where the frame is

    def step(self, place: Array) -> Step:
        """Iterate until the place is reached or the iterations run out; not at all where it is reached already."""
        before, began = self._state, self._clock()
        target = self._target.moved_to(place)
        (there,) = measure_errors(self._robot, (target,), before.q)
        if there.position is not None and there.within(self._tolerance):
            return Step(self._clock() - began, 0, 0, True, there.position, 0.0)
        state = self._states.send(target)
        while state.status is None:
            state = next(self._states)
        spent = self._clock() - began
        self._state = state
        error = state.position_error
        assert error is not None
        return Step(
            spent,
            state.iteration - before.iteration,
            state.joint_updates - before.joint_updates,
            state.status is Status.CONVERGED,
            error,
            largest_change(self._robot, before.q, state.q),
        )


def largest_change(robot: RobotModel, before: Array, after: Array) -> float:
    """The largest change of one joint between two configurations (nq,) [rad or m]."""
    return float(np.abs(pinocchio.difference(robot.model, before, after)).max(initial=0.0))


def chase_with(
    robot: Robot,
    frame: str,
    solver: Solver,
    *,
    limits: bool,
    rules: Rules,
    start: Array,
    engine: str = "auto",
    clock: Clock = time.perf_counter,
) -> Chase:
    """A method at work under these rules; the bare loop is Python's.

    Raises:
        UnknownNameError, InputError: As `pinik.prepare`.
        EngineError: As `pinik.prepare`; or the compiled engine is asked for the bare loop.
    """
    if rules.bare:
        if engine == "native":
            raise EngineError("the bare loop, which knows no stalls and keeps no best, is Python's alone")
        return BareChase(robot, frame, solver, limits, rules, start, clock)
    prepared = prepare(
        robot,
        Target(frame, np.zeros(3)),
        solver,
        limits=limits,
        restarts=rules.restarts,
        max_iterations=rules.max_iterations,
        tolerance=rules.tolerance,
        engine=engine,
    )
    return EngineChase(prepared, start)


def in_pieces(chase: Chase, place: Array, last: Array, pieces: int) -> Step:
    """One step whose ball comes from `last` in equal pieces: sums, but the end's verdict and the largest jump."""
    steps = [chase.step(last + (place - last) * (number / pieces)) for number in range(1, pieces)]
    steps.append(chase.step(place))
    return Step(
        math.fsum(step.time for step in steps),
        sum(step.iterations for step in steps),
        sum(step.joint_updates for step in steps),
        steps[-1].reached,
        steps[-1].error,
        max(step.jump for step in steps),
    )
