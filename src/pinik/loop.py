"""The one loop: limits, clamps, stopping and restarts, the same for every solver."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Generator, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from .checks import as_finite_number
from .errors import EngineError, InputError, UnknownNameError
from .kinematics import Kinematics, Linearization
from .limits import Limits
from .message import explain
from .reach import Shortfall, shortfall
from .robot import Robot
from .solution import Solution, State, Status, measure_errors
from .solvers import JacobianSolver, Patience, Solver, SweepingSolver, make_solver
from .starts import random_start
from .targets import Target, Tolerance

__all__ = ["iterate", "solve"]

Array = NDArray[np.float64]

# Restarts that a target proved unreachable still gets: the nearest point has valleys too.
_RESTARTS_WHEN_UNREACHABLE = 8
# How patiently a run is followed to its end when no other attempt waits.
_TO_THE_END = Patience(50, 1e-4)


def iterate(
    robot: Robot,
    targets: Target | Sequence[Target],
    solver: str | type[Solver] | Solver = "dls",
    q0: ArrayLike | None = None,
    *,
    limits: bool = True,
    locked: Iterable[str] = (),
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
) -> Generator[State, Sequence[Target] | None, None]:
    """Run one solver from one start and yield a State per iteration, the start first.

    Ends with the state whose `status` is set: converged, stalled or out of iterations. It serves the three ways to
    run: drain it (until reached); take `max_iterations=1` per simulation step from the last q (chase); or a few
    (hybrid). `states.send(targets)` moves the targets while it runs.

    Args:
        robot: The robot.
        targets: One target or several.
        solver: A name, a class or an instance.
        q0: Start (nq,), put inside the limits; neutral when None.
        limits: Whether every yielded q keeps inside the joints' limits.
        locked: Names of joints that hold still.
        max_iterations: Iterations at most; the solver's own number when None.
        tolerance: (metres, radians) that count as reached.

    Raises:
        InputError, UnknownNameError: As `solve`.
    """
    made = make_solver(solver)
    kinematics = _kinematics(robot, targets, made, locked)
    box = Limits.of(robot, limits)
    start = _start(robot, box, q0)
    most = made.max_iterations if max_iterations is None else _count(max_iterations, "max_iterations")
    return _run(made, kinematics, box, start, most, Tolerance.of(tolerance), _TO_THE_END)


def solve(
    robot: Robot,
    targets: Target | Sequence[Target],
    method: str | type[Solver] | Solver = "dls",
    *,
    q0: ArrayLike | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    trace: bool = False,
    **solver_parameters: Any,
) -> Solution:
    """Joint values that put frames where the targets want them.

    A missed target is no exception: the solution says how far off it is and why. Joints that move none of the
    frames asked for stay where `q0` has them.

    Args:
        robot: The robot.
        targets: One target or several.
        method: "ccd", "jt", "pinv", "dls", another name in `pinik.SOLVERS`, a Solver class or an instance.
        q0: Start (nq,), put inside the limits; neutral when None.
        limits: Whether the answer keeps inside the joints' limits.
        locked: Names of joints that hold still (a floating or planar joint's too).
        restarts: Fresh starts, drawn from `seed`, when an attempt fails; the solver's own number when None; 0 for
            the bare method.
        seed: Of the restarts' starts.
        max_iterations: Iterations of one attempt at most; the solver's own number when None.
        tolerance: (metres, radians) that count as reached; 1e-4 m and 1e-3 rad when None.
        time_limit: Seconds; checked between iterations.
        engine: "auto", "python" or "native".
        trace: Whether to keep every state.
        **solver_parameters: The solver's own parameters, such as `damping=0.1`.

    Returns:
        The solution, recomputed by plain Pinocchio.

    Raises:
        UnknownNameError: A frame, joint, method or parameter that does not exist.
        InputError: An argument of the wrong shape, kind or range.
        EngineError: The engine asked for is not there.
    """
    began = time.perf_counter()
    _check_engine(engine)
    solver = make_solver(method, **solver_parameters)
    kinematics = _kinematics(robot, targets, solver, locked)
    box = Limits.of(robot, limits)
    run = _Attempts(
        solver,
        kinematics,
        box,
        start=_start(robot, box, q0),
        restarts=solver.restarts if restarts is None else _count(restarts, "restarts", least=0),
        seed=_count(seed, "seed", least=0),
        max_iterations=solver.max_iterations if max_iterations is None else _count(max_iterations, "max_iterations"),
        tolerance=Tolerance.of(tolerance),
        deadline=math.inf if time_limit is None else began + _seconds(time_limit),
        states=[] if trace else None,
    )
    return run.solution(began)


def solve_from_keywords(
    robot: Robot,
    targets: str | Target | Sequence[Target],
    position: ArrayLike | None,
    method: str | type[Solver] | Solver,
    options: Mapping[str, Any],
) -> Solution:
    """`Robot.solve`: sort the keywords into those of one Target and those of `solve`."""
    options = dict(options)
    if not isinstance(targets, str):
        if position is not None or any(name in options for name in _TARGET_KEYWORDS):
            raise InputError("with Target objects the target's keywords belong into Target(...)")
        return solve(robot, targets, method, **options)
    fields = {name: options.pop(name) for name in _TARGET_KEYWORDS if name in options}
    return solve(robot, Target(targets, position, **fields), method, **options)


_TARGET_KEYWORDS = (
    "rotation", "rpy", "quat_xyzw", "quat_wxyz", "placement", "axis", "direction", "at", "tool", "relative_to",
    "weight",
)  # fmt: skip


def _run(
    solver: Solver,
    kinematics: Kinematics,
    limits: Limits,
    start: Array,
    max_iterations: int,
    tolerance: Tolerance,
    patience: Patience,
    *,
    judge_limits_at_end: bool = False,
    downhill: bool = False,
    attempt: int = 0,
) -> Generator[State, Sequence[Target] | None, None]:
    """States of one attempt.

    With `judge_limits_at_end` a Jacobian method steps freely until it has converged; what then lies outside the
    limits is turned by whole turns, and where that is not enough put inside and led on inside. With `downhill` a
    Jacobian method's step is cut until the residual falls, so that it comes to rest where it would swing about.
    """
    unlimited = judge_limits_at_end and limits.enabled and isinstance(solver, JacobianSolver)
    box = Limits.of(limits.robot, False) if unlimited else limits
    at = kinematics.linearize(start)
    milestone, since = at.residual, 0
    iteration, updates, scale = 0, 0, 1.0
    while True:
        status = None
        if all([error.within(tolerance) for error in at.errors]):
            if box is limits or limits.contains(at.q):
                status = Status.CONVERGED
            else:
                q = limits.wrap(at.q)
                box = limits
                at = kinematics.linearize(limits.clip(q))
                milestone, since = at.residual, 0
                if all([error.within(tolerance) for error in at.errors]):
                    status = Status.CONVERGED
        if status is None:
            if at.residual < milestone * (1.0 - patience.progress):
                milestone, since = at.residual, 0
            elif since >= patience.iterations:
                status = Status.STALLED
            if status is None and iteration >= max_iterations:
                status = Status.MAX_ITERATIONS
        moved = yield State(at.q, iteration, updates, tuple(at.errors), at.residual, attempt, status)
        if moved is not None:
            kinematics.retarget([moved] if isinstance(moved, Target) else moved)
            at = kinematics.linearize(at.q)
            milestone, since = math.inf, 0
        elif status is not None:
            return
        q, updated = _advance(solver, kinematics, box, at, tolerance, scale)
        there = kinematics.linearize(q)
        if not downhill or isinstance(solver, SweepingSolver):
            at = there
        elif there.residual < at.residual:
            at, scale = there, min(2.0 * scale, 1.0)
        else:
            scale /= 4.0
        iteration, updates, since = iteration + 1, updates + updated, since + 1


def _advance(
    solver: Solver, kinematics: Kinematics, limits: Limits, at: Linearization, tolerance: Tolerance, scale: float = 1.0
) -> tuple[Array, int]:
    """(the next configuration, joints updated one by one); `scale` shortens the step of a Jacobian method."""
    if isinstance(solver, SweepingSolver):
        return solver.sweep(at.q, kinematics, limits, tolerance)
    assert isinstance(solver, JacobianSolver)
    if solver.max_residual < math.inf:
        at = at._replace(e=kinematics.shortened(at.e, solver.max_residual))
    q = _stepped(solver.step(at, kinematics), solver, kinematics, at, scale)
    if not limits.enabled:
        return q, 0
    inside = limits.clip(q)
    if (inside == q).all():
        return q, 0
    return _step_along_limits(q, solver, kinematics, limits, at, scale), 0


def _stepped(dq: Array, solver: JacobianSolver, kinematics: Kinematics, at: Linearization, scale: float) -> Array:
    """The configuration after the step, clamped and scaled; joints that are not free stay to the last bit."""
    dq = dq * at.free
    length = math.sqrt(dq.dot(dq))
    if not math.isfinite(length):
        return at.q  # no step: the loop will say that it stalled
    if length > solver.max_step:
        largest = float(np.abs(dq).max())
        if largest > solver.max_step:
            dq = dq * (solver.max_step / largest)
    scale *= solver.step_size
    if scale != 1.0:
        dq = dq * scale
    return np.array(pinocchio.integrate(kinematics.model, at.q, dq))


def _step_along_limits(
    q: Array, solver: JacobianSolver, kinematics: Kinematics, limits: Limits, at: Linearization, scale: float
) -> Array:
    """The step again, after the first try `q` left the limits.

    Joints that sat at a limit already and would go further out hold still and leave their part to the others, until
    none does; what is outside then is clipped.
    """
    held = np.zeros_like(at.free)
    while True:
        inside = limits.clip(q)
        pushing = limits.blocked(at.q, q, inside) & ~held
        if not pushing.any():
            return inside
        held |= pushing
        J = at.J.copy()
        J[:, held] = 0.0
        free = at._replace(J=J, free=at.free & ~held)
        q = _stepped(solver.step(free, kinematics), solver, kinematics, free, scale)


@dataclasses.dataclass
class _Attempts:
    """The attempts of one solve: the first from the start given, the others from drawn ones."""

    solver: Solver
    kinematics: Kinematics
    limits: Limits
    start: Array
    restarts: int
    seed: int
    max_iterations: int
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
        restarts = self.restarts if proof is None else min(self.restarts, _RESTARTS_WHEN_UNREACHABLE)
        restarts = restarts if self.kinematics.free.any() else 0
        patience = self.solver.patience if restarts else _TO_THE_END
        status, attempt = Status.STALLED, 0
        for attempt in range(restarts + 1):
            start = self.start if attempt == 0 else self._drawn_start(attempt)
            if proof is None:
                status = self._attempt(start, attempt, patience, judge_limits_at_end=True)
            else:
                status = self._attempt(start, attempt, patience, downhill=True)
            if status in (Status.CONVERGED, Status.TIME_LIMIT):
                break
        assert self.best is not None
        if status not in (Status.CONVERGED, Status.TIME_LIMIT) and self.restarts:
            status = self._attempt(self.best.q, attempt, _TO_THE_END, downhill=True)
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
        run = _run(
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
        for state in run:
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
        if status is Status.CONVERGED and not all(error.within(self.tolerance) for error in errors):
            status = Status.STALLED
        if status is not Status.CONVERGED and proof is not None:
            status = Status.UNREACHABLE
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


def _kinematics(robot: Robot, targets: Target | Sequence[Target], solver: Solver, locked: Iterable[str]) -> Kinematics:
    if isinstance(targets, Target):
        targets = [targets]
    for target in targets:
        if not isinstance(target, Target):
            raise InputError(f"targets are Target objects; got {target!r}")
    at_target = isinstance(solver, JacobianSolver) and solver.target_jacobian
    _check_joint_names(robot, solver)
    return Kinematics(robot, targets, locked=locked, target_jacobian=at_target)


def _check_joint_names(robot: Robot, solver: Solver) -> None:
    for value in solver.parameters.values():
        if isinstance(value, Mapping):
            for name in value:
                robot.settable_joint(name)


def _start(robot: Robot, limits: Limits, q0: ArrayLike | None) -> Array:
    q = robot.neutral() if q0 is None else robot.check_configuration(q0, "q0")
    return limits.clip(limits.wrap(q))


def _check_engine(engine: str) -> None:
    if engine not in ("auto", "python", "native"):
        raise UnknownNameError("engine", engine, ("auto", "python", "native"))
    if engine == "native":
        raise EngineError("this version of pinik has no compiled engine; use engine='auto' or 'python'")


def _count(value: object, what: str, least: int = 1) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
        raise InputError(f"{what} is a whole number of at least {least}; got {value!r}")
    return int(value)


def _seconds(value: object) -> float:
    seconds = as_finite_number(value, "time_limit")
    if seconds <= 0.0:
        raise InputError(f"time_limit is a positive number of seconds; got {value!r}")
    return seconds
