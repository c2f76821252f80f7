"""`iterate` and `solve`: the front of the one loop, the same for every solver."""

from __future__ import annotations

import math
import time
from collections.abc import Generator, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .attempts import Attempts, Settings
from .checks import as_finite_number, as_names
from .errors import EngineError, InputError, UnknownNameError
from .kinematics import Kinematics
from .limits import Limits
from .robot import Robot
from .run import TO_THE_END, run
from .solution import Solution, State
from .solvers import JacobianSolver, Solver, make_solver
from .targets import TARGET_KEYWORDS, Target, Tolerance

__all__ = ["check_joint_names", "iterate", "solve"]

Array = NDArray[np.float64]


# Iterations in which the best of the failed attempts is followed to its end, unless the caller allows fewer.
_TO_THE_END_AT_MOST = 5000


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
    **solver_parameters: Any,
) -> Generator[State, Target | Sequence[Target] | None, None]:
    """Run one solver from one start and yield a State per iteration, the start first.

    Ends with the state whose `status` is set: converged, stalled or out of iterations. It serves the three ways to
    run: drain it (until reached); take `max_iterations=1` per simulation step from the last q (chase); or a few
    (hybrid). `states.send(targets)` moves the targets while it runs and starts its count of iterations anew.

    Args:
        robot: The robot.
        targets: One target or several.
        solver: A name, a class or an instance.
        q0: Start (nq,), put inside the limits; neutral when None.
        limits: Whether every yielded q keeps inside the joints' limits.
        locked: Names of joints that hold still.
        max_iterations: Iterations at most; the solver's own number when None.
        tolerance: (metres, radians) that count as reached.
        **solver_parameters: The solver's own parameters.

    Raises:
        InputError, UnknownNameError: As `solve`.
    """
    made = make_solver(solver, **solver_parameters)
    kinematics = _kinematics(robot, targets, made, locked)
    box = Limits.of(robot, limits)
    start = _start(robot, box, q0)
    most = made.max_iterations if max_iterations is None else _count(max_iterations, "max_iterations")
    return run(made, kinematics, box, start, most, Tolerance.of(tolerance), TO_THE_END)


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
        q0: Start (nq,); neutral when None. With limits it is put inside them first, joint by joint, the joints that
            move nothing and the locked ones as well.
        limits: Whether the answer keeps inside the joints' limits.
        locked: Names of joints that hold still (a floating or planar joint's too).
        restarts: Fresh starts, drawn from `seed`, when an attempt fails; the solver's own number when None; 0 for
            the bare method, as `iterate` runs it.
        seed: Of the restarts' starts.
        max_iterations: Iterations of one attempt at most; the solver's own number when None.
        tolerance: (metres, radians) that count as reached; 1e-4 m and 1e-3 rad when None.
        time_limit: Seconds; checked between iterations.
        engine: "auto", "python" or "native".
        trace: Whether to keep every state. With restarts, attempts of Jacobian methods may pass the limits on their
            way; the answer does not.
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
    settings = Settings(
        solver,
        kinematics,
        box,
        start=_start(robot, box, q0),
        restarts=solver.restarts if restarts is None else _count(restarts, "restarts", least=0),
        seed=_count(seed, "seed", least=0),
        max_iterations=solver.max_iterations if max_iterations is None else _count(max_iterations, "max_iterations"),
        iterations_to_the_end=_TO_THE_END_AT_MOST if max_iterations is None else max_iterations,
        tolerance=Tolerance.of(tolerance),
        deadline=math.inf if time_limit is None else began + _seconds(time_limit),
    )
    return Attempts(settings, trace=trace).solution(began)


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
        if position is not None or any(name in options for name in TARGET_KEYWORDS):
            raise InputError("with Target objects the target's keywords belong into Target(...)")
        return solve(robot, targets, method, **options)
    fields = {name: options.pop(name) for name in TARGET_KEYWORDS if name in options}
    return solve(robot, Target(targets, position, **fields), method, **options)


def _kinematics(robot: Robot, targets: Target | Sequence[Target], solver: Solver, locked: Iterable[str]) -> Kinematics:
    if not isinstance(robot, Robot):
        raise InputError(f"robot is what pinik.load returns; got {robot!r}")
    at_target = isinstance(solver, JacobianSolver) and solver.target_jacobian
    check_joint_names(robot, solver)
    held = (*as_names(locked, "locked"), *solver.held)
    return Kinematics(robot, targets, locked=held, target_jacobian=at_target)


def check_joint_names(robot: Robot, solver: Solver) -> None:
    """See that the joints which a solver's parameters name are there and can be set."""
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
