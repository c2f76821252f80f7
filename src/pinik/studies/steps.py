"""A method that chases a ball; each step starts where the last one ended."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import EngineError
from ..model.robot_model import RobotModel
from ..motion.figures import StepFigures
from ..problem.kinematics import Kinematics
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..robot import Robot
from ..solvers.base import Patience, Solver
from ..solving.front import prepare
from ..solving.options import Options
from ..solving.prepared import Prepared
from ..solving.question import Question
from ..solving.run import Pace, run
from ..solving.state import Status
from ..solving.verdict import measure_errors

__all__ = ["LAP", "PROGRAM", "BareChase", "Chase", "EngineChase", "Rules", "chase_with", "in_pieces"]

Array = NDArray[np.float64]
Clock = Callable[[], float]

LAP = 480
"""Steps per lap of a curve: eight seconds at 60 frames per second, as in the live view."""
PROGRAM = "program"
"""The engine name of the thesis's own program, whose joints are bones."""
NEVER_STALLED = Patience(10**9, 0.0)


@dataclass(frozen=True, kw_only=True)
class Rules:
    """The rules of a comparison, the same for all methods.

    Attributes:
        tolerance: The largest errors that count as reached.
        max_iterations: Per step, or per attempt if there are restarts; None for the solver's default.
        restarts: Per step; None for the solver's default.
        bare: Whether a step ignores stalls and ends at its last iteration, as in the thesis's program. Otherwise it
            ends at the best configuration, as `pinik.solve` does.
        lap: Steps per lap of the curve.
        rest: Steps that a random ball stays at one place.
        pieces: Number of equal moves into which each move of the ball is divided; each of them is solved.
    """

    tolerance: Tolerance
    max_iterations: int | None = None
    restarts: int | None = 0
    bare: bool = False
    lap: int = LAP
    rest: int = 1
    pieces: int = 1


class Chase(Protocol):
    """A method that chases the ball; it keeps its configuration between steps."""

    engine: str

    def step(self, place: Array) -> StepFigures:
        """Chase the ball to a place (3,) [m]."""
        ...


class EngineChase:
    """A chase in which each step is a solve, by either engine."""

    def __init__(self, prepared: Prepared, start: Array) -> None:
        """Start at the configuration `start` (nq,)."""
        self.engine = prepared.engine
        self._prepared = prepared
        self._q = start

    def step(self, place: Array) -> StepFigures:
        """Solve from where the last step ended."""
        before = self._q
        solution = self._prepared(place, before)
        self._q = solution.q
        error = solution.position_error
        assert error is not None
        return StepFigures(
            solution.time,
            solution.iterations,
            solution.joint_updates,
            solution.success,
            error,
            largest_change(self._prepared.robot, before, self._q),
        )


class BareChase:
    """A chase in which each step is the bare loop: no stall detection, no restarts, no best configuration."""

    engine = "python"

    def __init__(
        self, robot: Robot, frame: str, solver: Solver, limits: bool, rules: Rules, start: Array, clock: Clock
    ) -> None:
        """Start at the configuration `start` (nq,)."""
        target = Target(frame, robot.placement(frame, start).translation)
        options = Options(
            solver, limits=limits, tolerance=rules.tolerance, max_iterations=rules.max_iterations, polish=False
        )
        question = Question.of(robot, target, options)
        self._target, self._robot, self._tolerance, self._clock = target, robot, rules.tolerance, clock
        inside = question.limits.wrap(start)
        pace = Pace(options.iterations_at_most, NEVER_STALLED)
        self._states = run(question, Kinematics.of(question.problem), inside, pace)
        self._state = next(self._states)  # reached: the ball begins where the frame is

    def step(self, place: Array) -> StepFigures:
        """Iterate until the place is reached or the iterations run out; zero iterations if it is already reached."""
        before, began = self._state, self._clock()
        target = self._target.moved_to(place)
        (there,) = measure_errors(self._robot, (target,), before.q, self._tolerance)
        if there.position is not None and there.within(self._tolerance):
            return StepFigures(self._clock() - began, 0, 0, True, there.position, 0.0)
        state = self._states.send(target)
        while state.status is None:
            state = next(self._states)
        spent = self._clock() - began
        self._state = state
        error = state.position_error
        assert error is not None
        return StepFigures(
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
    """A chase by a method under these rules; the bare loop always runs in Python.

    Raises:
        UnknownNameError, InputError: As `pinik.prepare`.
        EngineError: As `pinik.prepare`; also if the compiled engine is requested for the bare loop.
    """
    if rules.bare:
        if engine == "native":
            raise EngineError("the bare loop, without stall detection, exists in the Python engine only")
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
        polish=False,
    )
    return EngineChase(prepared, start)


def in_pieces(chase: Chase, place: Array, last: Array, pieces: int) -> StepFigures:
    """Move the ball from `last` to `place` in equal pieces, as one step.

    Times and counts are sums, `jump` is the largest, and `reached` and `error` are those of the last piece.
    """
    steps = [chase.step(last + (place - last) * (number / pieces)) for number in range(1, pieces)]
    steps.append(chase.step(place))
    return StepFigures(
        math.fsum(step.time for step in steps),
        sum(step.iterations for step in steps),
        sum(step.joint_updates for step in steps),
        steps[-1].reached,
        steps[-1].error,
        max(step.jump for step in steps),
    )
