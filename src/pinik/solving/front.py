"""`solve`, `prepare` and `iterate`: the fronts of the one loop, the same for every solver."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike

from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.kinematics import Kinematics
from ..problem.targets import Target, Tolerance
from ..solvers.registry import SOLVERS, Method
from .kept import Kept, Key, kept_of
from .options import Options
from .prepared import Prepared
from .question import Question
from .run import Pace, States, run
from .solution import Solution
from .words import UNWEIGHTED, Wanted, asked_targets

__all__ = ["answer", "iterate", "prepare", "solve"]

_PAIRS = (tuple, list, Tolerance)


def solve(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    *,
    position: ArrayLike | None = None,
    rotation: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    quat_xyzw: ArrayLike | None = None,
    quat_wxyz: ArrayLike | None = None,
    placement: pinocchio.SE3 | ArrayLike | None = None,
    axis: str | ArrayLike | None = None,
    direction: ArrayLike | None = None,
    at: ArrayLike | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    weight: float = UNWEIGHTED,
    q0: ArrayLike | str | None = None,
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
    """Find joint values that put frames where the targets want them.

    A missed target is not an exception: the solution says how far off it is and why. Joints that move none of the
    frames stay where `q0` has them.

    Args:
        robot: The robot.
        targets: The name of a frame, with its place in the keywords from `position` to `weight`; or one Target, or
            several.
        method: "ccd", "jt", "pinv", "dls", another name in `pinik.SOLVERS`, a Solver class or an instance; "two_bone"
            where two parallel hinges move the frame.
        position: Where the frame's origin should be (3,) [m]; this and the next eleven are explained at `Target`.
        rotation, rpy, quat_xyzw, quat_wxyz: The orientation wanted.
        placement: Position and orientation at once.
        axis, direction, at: An axis of the frame, and where it should point.
        tool: The point meant, in the frame.
        relative_to: The frame in which the target is expressed.
        weight: A factor on the target's residual in the step.
        q0: Start (nq,); neutral when None; "nearest" for a start near the targets, from a table. With limits it is put
            inside them first, joint by joint, joints that move nothing and locked ones included.
        limits: Whether the answer keeps inside the joints' limits.
        locked: Names of joints that hold still, floating and planar ones included.
        restarts: Fresh starts, drawn from `seed`, after a failed attempt; the solver's own number when None; 0 for the
            bare method, as `iterate` runs it.
        seed: The seed of the fresh starts.
        max_iterations: Iterations of one attempt at most; the solver's own number when None.
        tolerance: The errors that count as reached (metres, radians); 1e-4 m and 1e-3 rad when None.
        time_limit: Seconds; checked between iterations.
        engine: "auto", "python" or "native".
        trace: Whether to keep every state. With restarts, attempts of Jacobian methods may leave the limits on their
            way; the answer does not.
        **solver_parameters: The solver's own parameters, such as `damping=0.1`.

    Returns:
        The solution, with its errors computed anew by plain Pinocchio.

    Raises:
        UnknownNameError: A frame, joint, method or keyword that does not exist.
        InputError: An argument of the wrong shape, kind or range.
        EngineError: The engine asked for is not available.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    said = (limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace)
    return answer(robot, targets, method, wanted, q0, said, solver_parameters)


def prepare(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    *,
    position: ArrayLike | None = None,
    rotation: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    quat_xyzw: ArrayLike | None = None,
    quat_wxyz: ArrayLike | None = None,
    placement: pinocchio.SE3 | ArrayLike | None = None,
    axis: str | ArrayLike | None = None,
    direction: ArrayLike | None = None,
    at: ArrayLike | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    weight: float = UNWEIGHTED,
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
) -> Prepared:
    """Check and compile a kind of question once, to ask it many times with other places and starts.

    The arguments and errors are those of `solve`. What is asked of which frames is fixed; where they should be may
    differ from call to call.
    """
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    asked = asked_targets(targets, wanted, method, solver_parameters)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine, trace=trace,
    )  # fmt: skip
    return Prepared(robot, asked, options)


def iterate(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    q0: ArrayLike | None = None,
    *,
    position: ArrayLike | None = None,
    rotation: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    quat_xyzw: ArrayLike | None = None,
    quat_wxyz: ArrayLike | None = None,
    placement: pinocchio.SE3 | ArrayLike | None = None,
    axis: str | ArrayLike | None = None,
    direction: ArrayLike | None = None,
    at: ArrayLike | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    weight: float = UNWEIGHTED,
    limits: bool = True,
    locked: Iterable[str] = (),
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    **solver_parameters: Any,
) -> States:
    """Run one solver from one start and yield a State per iteration, the start first.

    The run ends with the state whose `status` is set: converged, stalled or out of iterations. There are three ways to
    use it: drain it until the targets are reached; take `max_iterations=1` per simulation step, from the last q; or
    take a few iterations per step. `states.send(targets)` moves the targets while it runs, starts the count of
    iterations anew, takes the next step and returns its state; it works after the last state as well.

    Args:
        robot: The robot.
        targets: The name of a frame, with its place in the keywords from `position` to `weight`; or one Target, or
            several.
        method: A solver's name, class or instance.
        q0: Start (nq,), put inside the limits; neutral when None.
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight: As for
            `Target`.
        limits: Whether every q yielded keeps inside the joints' limits.
        locked: Names of joints that hold still.
        max_iterations: Iterations at most; the solver's own number when None.
        tolerance: The errors that count as reached (metres, radians).
        **solver_parameters: The solver's own parameters.

    Raises:
        UnknownNameError, InputError: As for `solve`.
    """
    if "solver" in solver_parameters:
        warnings.warn("iterate's solver= is called method=, as everywhere", DeprecationWarning, stacklevel=2)
        method = solver_parameters.pop("solver")
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    asked = asked_targets(targets, wanted, method, solver_parameters)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, max_iterations=max_iterations, tolerance=tolerance
    )
    question = Question.of(robot, asked, options)
    q = robot.neutral() if q0 is None else robot.check_configuration(q0, "q0")
    start = question.limits.clip(question.limits.wrap(q))
    return run(question, Kinematics.of(question.problem), start, Pace(options.iterations_at_most))


def answer(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method,
    wanted: Wanted,
    q0: ArrayLike | str | None,
    said: tuple[Any, ...],
    parameters: dict[str, Any],
) -> Solution:
    """Solve. What was compiled for the same words, or for the same question in other words, is used again.

    Args:
        robot: The robot.
        targets: A frame's name or targets.
        method: The method.
        wanted: The values of a target's keywords, in the order of `PLACE_WORDS`.
        q0: The start.
        said: The options, in the order of `OPTION_NAMES`.
        parameters: The solver's parameters.
    """
    kept = kept_of(robot)
    words, prepared = None, None
    if type(targets) is str and _is_plain(wanted):
        position = wanted[0]
        words = _words((targets, position is None), method, said, parameters)
        prepared = _said(kept, words)
        if prepared is not None:
            quick = prepared.at(wanted[5] if position is None else _as_point(position), q0)
            if quick is not None:
                return quick
    asked = asked_targets(targets, wanted, method, parameters)
    if words is None:
        words = _words(tuple([target.shape for target in asked]), method, said, parameters)
        prepared = _said(kept, words)
    if prepared is None:
        prepared = kept.prepared(robot, asked, _options(method, said, parameters), words)
    return prepared.answer(asked, q0)


def _is_plain(wanted: Wanted) -> bool:
    """Whether a position alone is wanted, or a placement alone."""
    (position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight) = wanted
    return (
        (position is None) is not (placement is None)
        and tool is None
        and relative_to is None
        and rotation is None
        and rpy is None
        and quat_xyzw is None
        and quat_wxyz is None
        and axis is None
        and direction is None
        and at is None
        and weight is UNWEIGHTED
    )


def _words(what: object, method: Method, said: tuple[Any, ...], parameters: dict[str, Any]) -> Key | None:
    """The words of a question as a key; None for words that have to be checked each time.

    Types are a part of it: equality alone would confuse `True` with 1.
    """
    meant: object = SOLVERS.get(method) if type(method) is str else method
    if meant is None:
        return None
    if said[1] != () or said[5] is not None:
        plain = _plain_options(*said)
        if plain is None:
            return None
        said = plain
    own = tuple([(name, type(value), _as_key(value)) for name, value in parameters.items()]) if parameters else ()
    return what, meant, said, tuple(map(type, said)), own


def _plain_options(limits: object, locked: Any, *between: Any) -> tuple[Any, ...] | None:
    """The options with names and tolerances in tuples; None where they are given in another way."""
    restarts, seed, max_iterations, tolerance, *rest = between
    if locked != () and type(locked) not in (tuple, list):
        return None
    if tolerance is not None:
        tolerance = tolerance.tolist() if type(tolerance) is np.ndarray else tolerance
        if type(tolerance) not in _PAIRS or any([type(number) is not float for number in tolerance]):
            return None
        tolerance = tuple(tolerance)
    return limits, tuple(locked), restarts, seed, max_iterations, tolerance, *rest


def _as_key(value: object) -> object:
    return tuple([(name, type(x), x) for name, x in value.items()]) if type(value) is dict else value


def _said(kept: Kept, words: Key | None) -> Prepared | None:
    try:
        return None if words is None else kept.said(words)
    except TypeError:  # something in them cannot be a key
        return None


def _options(method: Method, said: tuple[Any, ...], parameters: dict[str, Any]) -> Options:
    limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace = said
    return Options.of(
        method, parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine, trace=trace,
    )  # fmt: skip


def _as_point(position: ArrayLike) -> object:
    """Three plain numbers as an array; None for what a check has to judge."""
    if isinstance(position, (list, tuple)) and [type(x) for x in position] == [float, float, float]:
        return np.array(position)
    return position if isinstance(position, np.ndarray) and position.ndim == 1 else None
