"""`iterate` and `solve`: the front of the one loop, the same for every solver."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..checks import as_count, as_names
from ..errors import InputError
from ..model.limits import Limits
from ..model.robot_model import Robot
from ..problem.targets import TARGET_KEYWORDS, Target, Tolerance, as_targets
from ..solvers.base import Solver
from ..solvers.registry import SOLVERS, make_solver
from .prepared import Prepared, check_joint_names, prepare
from .run import TO_THE_END, compiled_for, run
from .solution import Solution
from .state import State

__all__ = ["iterate", "solve"]

# Kinds of questions that a robot keeps compiled, for each thread; large robots' working memory is too large to keep.
_MOST_KEPT = 16
_MOST_FREEDOMS_KEPT = 80

_OTHER_KEYWORDS = frozenset(TARGET_KEYWORDS) - {"position", "placement"}


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
    (hybrid). `states.send(targets)` moves the targets while it runs, starts its count of iterations anew, takes the
    next step and returns its state, also after a state that was the last.

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
    if not isinstance(robot, Robot):
        raise InputError(f"robot is what pinik.load returns; got {robot!r}")
    made = make_solver(solver, **solver_parameters)
    check_joint_names(robot, made)
    kinematics = compiled_for(made, robot, targets, as_names(locked, "locked"))
    box = Limits.of(robot, limits)
    q = robot.neutral() if q0 is None else robot.check_configuration(q0, "q0")
    most = made.max_iterations if max_iterations is None else as_count(max_iterations, "max_iterations")
    return run(made, kinematics, box, box.clip(box.wrap(q)), most, Tolerance.of(tolerance), TO_THE_END)


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
        method: "ccd", "jt", "pinv", "dls", another name in `pinik.SOLVERS`, a Solver class or an instance; "two_bone"
            where two parallel hinges move the frame.
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
    asked = as_targets(targets)
    if not isinstance(locked, (str, tuple)) and isinstance(locked, Iterable):
        locked = tuple(locked)
    prepared = _prepared(
        robot, asked, method, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine, trace=trace,
        **solver_parameters,
    )  # fmt: skip
    return prepared(asked, q0)


def solve_from_keywords(
    robot: Robot,
    targets: str | Target | Sequence[Target],
    position: ArrayLike | None,
    method: str | type[Solver] | Solver,
    options: dict[str, Any],
) -> Solution:
    """`Robot.solve`: sort the keywords into those of one Target and those of `solve`."""
    if not isinstance(targets, str):
        if position is not None or any(name in options for name in TARGET_KEYWORDS):
            raise InputError("with Target objects the target's keywords belong into Target(...)")
        return solve(robot, targets, method, **options)
    key = _key_of_a_place(targets, position, method, options)
    prepared: Prepared | None = None
    if key is not None:
        try:
            prepared = robot.kept.get(key)
        except TypeError:  # something in it cannot be a key
            key = None
    if prepared is not None:
        place = options["placement"] if position is None else _as_point(position)
        solution = prepared.at(place, options.get("q0"))
        if solution is not None:
            return solution
    fields = {name: options.pop(name) for name in TARGET_KEYWORDS if name in options}
    target = Target(targets, position, **fields)
    if key is None:
        return solve(robot, target, method, **options)
    q0 = options.pop("q0", None)
    return (prepared or _keep(robot, key, prepare(robot, target, method, **options)))(target, q0)


def _key_of_a_place(
    frame: str, position: ArrayLike | None, method: object, options: Mapping[str, Any]
) -> tuple[object, ...] | None:
    """What to keep the compiled question under, where it asks one frame for a position, or for a placement."""
    if (position is None) is not ("placement" in options) or type(method) is not str or method not in SOLVERS:
        return None
    settings = []
    for name, value in options.items():
        if name in _OTHER_KEYWORDS:
            return None
        if name != "placement" and name != "q0":
            settings.append((name, type(value), value))
    return (frame, position is None, method, SOLVERS[method], *settings)


def _as_point(position: ArrayLike) -> object:
    """Three plain numbers as an array; None for what others have to judge."""
    if isinstance(position, (list, tuple)) and [type(x) for x in position] == [float, float, float]:
        return np.array(position)
    return position if isinstance(position, np.ndarray) and position.ndim == 1 else None


def _prepared(
    robot: Robot, targets: tuple[Target, ...], method: str | type[Solver] | Solver, /, **options: Any
) -> Prepared:
    """The question, compiled; of the last few kinds that this thread asked, what was compiled then."""
    if not isinstance(robot, Robot):
        raise InputError(f"robot is what pinik.load returns; got {robot!r}")
    if isinstance(method, str) and method not in SOLVERS:  # "module:Class", which may be another one next time
        return prepare(robot, targets, method, **options)
    try:
        shapes = tuple(target.shape for target in targets)
        meant = SOLVERS[method] if isinstance(method, str) else None
        key = (shapes, method, meant, *((name, type(value), value) for name, value in options.items()))
        found = robot.kept.get(key)
    except TypeError:  # something in it cannot be a key
        return prepare(robot, targets, method, **options)
    return found or _keep(robot, key, prepare(robot, targets, method, **options))


def _keep(robot: Robot, key: tuple[object, ...], prepared: Prepared) -> Prepared:
    if robot.model.nv <= _MOST_FREEDOMS_KEPT:
        robot.kept[key] = prepared
        while len(robot.kept) > _MOST_KEPT:
            del robot.kept[next(iter(robot.kept))]
    return prepared
