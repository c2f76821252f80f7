"""The bridge to the compiled engine, and why it is not there when it is not."""

from __future__ import annotations

import functools
import importlib.util
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.limits import Limits
from ..model.robot_model import RobotModel
from ..problem.problem import Problem
from ..problem.reach import Shortfall, reach_bounds
from ..problem.targets import Target, TargetError
from ..solvers.base import JacobianSolver, Solver
from ..solvers.ccd import CCD
from ..solvers.damped_least_squares import DampedLeastSquares
from ..solvers.pseudo_inverse import PseudoInverse
from ..solvers.transpose import JacobianTranspose
from .question import Question
from .state import State, Status

__all__ = [
    "Answer",
    "Answers",
    "attempt_many",
    "goals_of",
    "make_engine",
    "targets_of",
    "why_not",
]

if TYPE_CHECKING:
    from .. import _native
    from .._native import Engine

Array = NDArray[np.float64]

_KINDS = ("revolute", "continuous", "prismatic", "floating", "planar")
_METHODS: tuple[type[Solver], ...] = (CCD, JacobianTranspose, PseudoInverse, DampedLeastSquares)
_RULES = ("constant", "residual", "sugihara", "manipulability")
_STATUSES = tuple(Status)
_MOST = 2**31 - 1  # that the engine counts to
_IDENTITY = pinocchio.SE3.Identity()
_ROBOTS: WeakKeyDictionary[RobotModel, Any] = WeakKeyDictionary()


@functools.cache
def _load() -> Any:
    """The compiled module, or a sentence that says why there is none."""
    if importlib.util.find_spec("pinik._native") is None:
        return "it was not built when pinik was installed, as no C++ compiler worked"
    try:
        from .. import _native
    except ImportError as error:
        return f"it does not load: {error}"
    if _native.pinocchio_version != pinocchio.__version__:
        return (
            f"it was built against Pinocchio {_native.pinocchio_version}, and {pinocchio.__version__} is installed; "
            "install pinik again"
        )
    return _native


def why_not(solver: Solver | None = None) -> str | None:
    """Why the compiled engine cannot be used (for this solver); None where it can."""
    module = _load()
    if isinstance(module, str):
        return module
    if solver is not None and type(solver) not in _METHODS:
        return f"the method {solver.name!r} is written in Python"
    return None


@dataclass(frozen=True, eq=False)
class Answers:
    """What N solves came to, an entry each: the fields that `many.Solutions` describes."""

    q: Array
    status: NDArray[np.object_]
    position_error: Array
    orientation_error: Array
    iterations: NDArray[np.int64]
    joint_updates: NDArray[np.int64]
    restarts: NDArray[np.int64]
    time: Array


def attempt_many(engine: Engine, goals: Array, starts: Array, nearest: bool, threads: int) -> Answers:
    """Solve for goals (N, n, 18) from starts (N or 1, nq), question k drawing by the number k."""
    q, status, position, orientation, iterations, updates, restarts, seconds = engine.solve_many(
        starts, goals, nearest, threads
    )
    statuses = np.array(_STATUSES, dtype=object)[status]
    return Answers(q, statuses, position, orientation, iterations, updates, restarts, seconds)


class Answer:
    """What the attempts came to, as `attempts.Outcome` tells it; made into Python's numbers when looked at.

    Attributes:
        pattern: The targets, but for where they were.
    """

    __slots__ = ("_answer", "pattern")

    engine = "native"

    def __init__(self, answer: _native.Answer, pattern: tuple[Target, ...]) -> None:
        self._answer = answer
        self.pattern = pattern

    @property
    def targets(self) -> tuple[Target, ...]:
        """What was asked for."""
        return targets_of(self.pattern, self._answer.goals)

    @property
    def time(self) -> float:
        """Seconds."""
        return self._answer.seconds

    @property
    def status(self) -> Status:
        """The verdict."""
        return _STATUSES[self._answer.status]

    @property
    def q(self) -> Array:
        """A fresh copy of the best configuration (nq,)."""
        return self._answer.q

    @property
    def errors(self) -> tuple[TargetError, ...]:
        """Each target's error there."""
        return _errors(self._answer.errors)

    @property
    def iterations(self) -> int:
        """Of all attempts."""
        return self._answer.iterations

    @property
    def joint_updates(self) -> int:
        """Of all attempts."""
        return self._answer.joint_updates

    @property
    def restarts(self) -> int:
        """Attempts after the first."""
        return self._answer.restarts

    @property
    def proof(self) -> Shortfall | None:
        """Why a target is out of reach, where one is."""
        proof = self._answer.proof
        return None if proof is None else Shortfall(*proof)

    @property
    def states(self) -> tuple[State, ...]:
        """Every state, where a trace is wanted."""
        return tuple([_state(*state) for state in self._answer.states])


def _errors(pairs: Any) -> tuple[TargetError, ...]:
    return tuple([TargetError(position, orientation) for position, orientation in pairs])


def _state(q: Array, iteration: int, updates: int, errors: Any, residual: float, attempt: int, status: int) -> State:
    q.setflags(write=False)
    ended = _STATUSES[status] if status < len(_STATUSES) else None
    return State(q, iteration, updates, _errors(errors), residual, attempt, ended)


def make_engine(question: Question) -> Engine:
    """The compiled engine for a question."""
    module = _load()
    options, problem = question.options, question.problem
    robot = _robot(problem.robot)
    asked = module.Settings()
    asked.solver = _solver(question.solver, problem)
    asked.patience = question.solver.patience.iterations, question.solver.patience.progress
    asked.tolerance = tuple(options.tolerance)
    asked.limits = options.limits
    asked.restarts = min(options.restarts_at_most, _MOST)
    asked.seed = options.seed & 0xFFFFFFFFFFFFFFFF
    asked.max_iterations = min(options.iterations_at_most, _MOST)
    asked.iterations_to_the_end = min(options.iterations_to_the_end, _MOST)
    asked.time_limit = options.time_limit
    asked.trace = options.trace
    engine: Engine = module.Engine(robot, _problem(robot, problem), asked)
    return engine


def _robot(robot: RobotModel) -> Any:
    """The robot as the engine knows it, made once."""
    if robot not in _ROBOTS:
        _ROBOTS[robot] = _make_robot(robot)
    return _ROBOTS[robot]


def _make_robot(robot: RobotModel) -> Any:
    native = _load().Robot()
    leaders = {joint.leader for joint in robot.joints}
    model = robot.model
    for joint in robot.joints:
        placement = model.jointPlacements[joint.id]
        native.add_joint(
            kind=_KINDS.index(joint.kind),
            parent=model.parents[joint.id],
            rotation=placement.rotation,
            translation=placement.translation,
            axis=np.array(joint.axis),
            idx_q=joint.idx_q,
            nq=joint.nq,
            idx_v=joint.idx_v,
            nv=joint.nv,
            follows=joint.leader is not None,
            multiplier=joint.multiplier,
            offset=joint.offset,
            lower=float(robot.lower_q[joint.idx_q]) if joint.nq == 1 else -math.inf,
            upper=float(robot.upper_q[joint.idx_q]) if joint.nq == 1 else math.inf,
            shared=joint.name in leaders,
        )
    native.finish()
    return native


def _problem(robot: Any, asked: Problem) -> Any:
    problem = _load().Problem(robot)
    free, limited = Limits.of(asked.robot, False), Limits.of(asked.robot)
    for term in asked.terms:
        target, chain = term.pattern, term.chain
        bounds = [reach_bounds(term, limits) for limits in (free, limited)]
        base = next((b.base for b in bounds if b is not None), np.zeros(3))
        reference = chain.reference_placement or _IDENTITY
        problem.add_term(
            robot=robot,
            frame_joint=chain.frame_joint,
            frame_rotation=chain.frame_placement.rotation,
            frame_translation=chain.frame_placement.translation,
            has_reference=chain.reference_placement is not None,
            reference_joint=chain.reference_joint,
            reference_rotation=reference.rotation,
            reference_translation=reference.translation,
            asks_position=target.position is not None,
            asks_rotation=target.rotation is not None,
            asks_axis=target.axis is not None,
            asks_at=target.at is not None,
            axis=np.array([1.0, 0.0, 0.0]) if target.axis is None else target.axis,
            weight=term.weight,
            has_bounds=any(b is not None for b in bounds),
            base=base,
            reach=[math.inf if b is None else b.reach for b in bounds],
            hole=[0.0 if b is None else b.hole for b in bounds],
        )
    for coordinate in asked.coordinates:
        joint = coordinate.joint
        problem.add_coordinate(
            joint=joint.id,
            index=coordinate.index,
            entry=joint.idx_q if joint.nq == 1 else -1,
            movers=[(mover.id, multiplier) for mover, multiplier in coordinate.movers],
            moved=[(j.id, j.multiplier) for j in asked.robot.joints if joint.name in (j.name, j.leader)],
        )
    problem.finish(lightest=asked.lightest, size_of_chain=asked.size_of_chain)
    return problem


def _solver(solver: Solver, problem: Problem) -> Any:
    native = _load().Solver()
    native.method = _METHODS.index(type(solver))
    native.max_step, native.max_residual = solver.max_step, solver.max_residual
    if isinstance(solver, CCD):
        if solver.stiffness:
            native.stiffness = [solver.stiffness.get(c.joint.name, 1.0) for c in problem.coordinates]
        native.relaxation = solver.relaxation_for(problem)
        native.position_weight = solver.position_weight
        native.printed_scaling = solver.scaling == "printed"
        return native
    assert isinstance(solver, JacobianSolver)
    roots = solver.roots(problem)
    if roots is not None:
        native.stiffness = [roots[c.joint.idx_v + c.index] ** 2 for c in problem.coordinates]
    native.step_size, native.target_jacobian = solver.step_size, solver.target_jacobian
    if isinstance(solver, JacobianTranspose):
        native.alpha = solver.alpha or 0.0
    elif isinstance(solver, PseudoInverse):
        native.cutoff, native.rest_gain = solver.cutoff, solver.rest_gain
        robot = problem.robot
        native.rest_posture = [(robot.joint(name).id, angle) for name, angle in solver.rest_posture.items()]
    elif isinstance(solver, DampedLeastSquares):
        native.damping, native.manipulability = solver.damping, solver.manipulability
        native.rule, native.by_svd = _RULES.index(solver.rule), solver.factorization == "svd"
    return native


def goals_of(targets: tuple[Target, ...]) -> Array:
    """What each target wants, as the engine reads it: position, rotation by rows, direction, at (n, 18)."""
    goals = np.zeros((len(targets), 18))
    for row, target in zip(goals, targets, strict=True):
        if target.position is not None:
            row[:3] = target.position
        if target.rotation is not None:
            row[3:12] = target.rotation.ravel()
        if target.direction is not None:
            row[12:15] = target.direction
        if target.at is not None:
            row[15:] = target.at
    return goals


def targets_of(pattern: tuple[Target, ...], goals: Iterable[Array]) -> tuple[Target, ...]:
    """The targets that `goals_of` read: what is asked as in the pattern, where as in the numbers."""
    return tuple(
        target.with_numbers(goal[:3], goal[3:12].reshape(3, 3), goal[12:15], goal[15:])
        for target, goal in zip(pattern, goals, strict=True)
    )
