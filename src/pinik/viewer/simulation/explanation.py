"""What a method does in its next iteration: Jacobian, singular values and step, or the turns of a sweep."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...model.limits import Limits
from ...problem.coordinates import Coordinate
from ...problem.kinematics import Kinematics, Linearization
from ...problem.problem import Problem
from ...problem.targets import Target
from ...solvers.base import JacobianSolver, Solver
from ...solving.question import Question
from ...solving.run import Pace, run
from ...solving.state import State
from .spectrum import Spectrum, spectrum_of
from .turns import Passage, Turn, turns_of

__all__ = ["Explanation", "explain_iteration"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Explanation:
    """One iteration of a method from one configuration, with n free tangent coordinates and m rows.

    Attributes:
        method: The method's short name.
        columns: The name of each free coordinate (n,).
        rows: The name of each row of J and e (m,), such as "tip x".
        J: The Jacobian as the method gets it (m, n) [m], zero in the columns of joints that a limit holds.
        e: The residual as the method gets it (m,) [m].
        held: Names of the coordinates that a limit holds in this iteration.
        spectrum: The singular values of J and what the method makes of them.
        asked: The step that the method computes (n,), before it is clamped [rad or m]; empty for a sweep.
        step: The step that the robot takes (n,) [rad or m].
        largest: The largest change of one joint to which the method clamps its step [rad or m].
        residual: The norm of the residual now [m].
        predicted: The norm that the linearisation promises after the step [m].
        after: The norm after the step [m].
        turns: The turns of a sweep, in their order.
        reached: Whether all targets are reached, so that no iteration would follow.
    """

    method: str
    columns: tuple[str, ...]
    rows: tuple[str, ...]
    J: Array
    e: Array
    held: tuple[str, ...]
    spectrum: Spectrum
    asked: Array
    step: Array
    largest: float
    residual: float
    predicted: float
    after: float
    turns: tuple[Turn, ...]
    reached: bool


def explain_iteration(question: Question, targets: Sequence[Target], q: Array) -> Explanation:
    """Let the solver's own loop take one iteration from `q` (nq,), and write down what the method is given and returns.

    Args:
        question: The question; its problem may hold other targets of the same kinds.
        targets: The targets.
        q: The configuration.

    Raises:
        Exception: Whatever a method of one's own raises.
    """
    watched = _Watch()
    problem = watched.problem(question.problem)
    options = dataclasses.replace(question.options, method=watched.solver(question.solver))
    kinematics = Kinematics.of(problem)
    kinematics.retarget(targets)
    copied = dataclasses.replace(question, problem=problem, options=options)
    vars(copied)["bounds"] = question.bounds  # where the property keeps them; computing them anew would take too long
    begin, end = _one_iteration(copied, kinematics, q)
    reached = end is begin
    first = kinematics.linearize(begin.q)
    if reached and isinstance(question.solver, JacobianSolver):
        watched.steps.append((first, question.solver.step(first, kinematics)))
    at, asked = watched.steps[-1] if watched.steps else (first, np.zeros(0))
    return _explained(question, kinematics, at, first, asked, (begin, end), watched.passages, reached)


def _one_iteration(question: Question, kinematics: Kinematics, q: Array) -> tuple[State, State]:
    """The state at `q` and the next one, which is the same if no iteration follows."""
    states = run(question, kinematics, question.limits.wrap(q), Pace(1))
    begin = next(states)
    return begin, next(states, begin)


def _explained(
    question: Question,
    kinematics: Kinematics,
    at: Linearization,
    first: Linearization,
    asked: Array,
    ends: tuple[State, State],
    passages: Sequence[Passage],
    reached: bool,
) -> Explanation:
    problem, solver = kinematics.problem, question.solver
    begin, end = ends
    free = np.flatnonzero(problem.free)
    step = pinocchio.difference(kinematics.model, begin.q, end.q)
    names = _column_names(problem)
    held = np.flatnonzero(first.J.any(axis=0) & ~at.J.any(axis=0)) if passages == [] else np.zeros(0, dtype=int)
    return Explanation(
        method=solver.name,
        columns=tuple(names[k] for k in free),
        rows=_row_names(problem),
        J=at.J[:, free],
        e=at.e,
        held=tuple(names[k] for k in held if problem.free[k]),
        spectrum=spectrum_of(solver, at, problem, asked),
        asked=asked[free] if asked.size else asked,
        step=step[free],
        largest=solver.max_step,
        residual=first.residual,
        predicted=float(np.linalg.norm(first.e - first.J.dot(step))),
        after=end.residual,
        turns=turns_of(kinematics, begin.q, passages, question.limits),
        reached=reached,
    )


class _Watch:
    """Notes what a method is given and returns during one iteration.

    Attributes:
        steps: The linearizations that a Jacobian method was given, each with the step (nv,) that it returned.
        passages: The coordinates that a sweep changed, in its order.
    """

    def __init__(self) -> None:
        self.steps: list[tuple[Linearization, Array]] = []
        self.passages: list[Passage] = []

    def solver(self, solver: Solver) -> Solver:
        """A copy of a solver whose steps are noted; a solver that sweeps stays as it is."""
        if not isinstance(solver, JacobianSolver):
            return solver
        watched = copy.copy(solver)

        def step(at: Linearization, kinematics: Kinematics) -> Array:
            dq = solver.step(at, kinematics)
            self.steps.append((at, dq))
            return dq

        object.__setattr__(watched, "step", step)  # solvers are frozen; this one is a copy of its own
        return watched

    def problem(self, problem: Problem) -> Problem:
        """A copy of a problem whose coordinates note each change."""
        watched = copy.copy(problem)
        watched.coordinates = tuple(
            _Noted(own.joint, own.index, own.movers, self.passages) for own in problem.coordinates
        )
        return watched


@dataclass(frozen=True)
class _Noted(Coordinate):
    """A coordinate that notes each change."""

    passages: list[Passage] = field(compare=False)

    def advance(self, q: Array, change: float, model: pinocchio.Model, limits: Limits) -> None:
        super().advance(q, change, model, limits)
        self.passages.append(Passage(self, change, q.copy()))


def _column_names(problem: Problem) -> list[str]:
    names = [""] * problem.model.nv
    for joint in problem.robot.joints:
        for k in range(joint.nv):
            names[joint.idx_v + k] = joint.name if joint.nv == 1 else f"{joint.name} {_part(joint, k)}"
    return names


def _part(joint: Any, k: int) -> str:
    """The name of a joint's tangent coordinate: three shifts before three turns, or else its number."""
    return ("x", "y", "z", "turn x", "turn y", "turn z")[k] if joint.nv == 6 else str(k + 1)


def _row_names(problem: Problem) -> tuple[str, ...]:
    names: list[str] = []
    for term in problem.terms:
        frame = term.pattern.frame
        if term.pattern.position is not None:
            names += [f"{frame} {axis}" for axis in "xyz"]
        if term.pattern.asks_orientation:
            names += [f"{frame} turn {axis}" for axis in "xyz"]
    return tuple(names)
