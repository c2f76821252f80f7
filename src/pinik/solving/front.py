"""The functions `solve`, `prepare` and `iterate`, the same for every solver."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pinocchio
from numpy.typing import ArrayLike

from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.kinematics import Kinematics
from ..problem.target_values import Position
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..shapes.avoid import Avoided
from ..solvers.registry import Method
from .answer import answer
from .native.recalling import recalling
from .options import OPTION_NAMES, Options
from .origin import Origin
from .prepared import Prepared
from .question import Question
from .run import Pace, States, run
from .solution import Solution
from .words import UNWEIGHTED, asked_targets, options_of

__all__ = ["iterate", "prepare", "solve"]


_OPTIONS_OF_ITERATE = ("q0", "limits", "locked", "max_iterations", "tolerance", "polish")


@recalling()
def solve(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    *,
    position: Position | None = None,
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
    q0: ArrayLike | Mapping[str, float] | str | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    trace: bool = False,
    polish: bool = True,
    choose: str = "first",
    choose_weights: Mapping[str, float] | None = None,
    avoid: Avoided = None,
    **solver_parameters: Any,
) -> Solution:
    """Find joint values that move frames of the robot to their targets.

    A missed target raises no exception: the solution reports the remaining errors and the reason. Joints that move none
    of the frames keep their values in `q0`.

    Args:
        robot: The robot.
        targets: The name of a frame, with its target in the keywords from `position` to `weight`; or one or several
            Target objects.
        method: "ccd", "jt", "pinv", "dls", another name in `pinik.SOLVERS`, a Solver class or an instance; "two_bone"
            if two parallel hinges move the frame.
        position: Target position of the frame's origin (3,) [m], with None for axes that are free; `Target` explains
            this and the next eleven keywords.
        rotation, rpy, quat_xyzw, quat_wxyz: Target orientation.
        placement: Target position and orientation together.
        axis, direction, at: An axis of the frame, and the direction or the point at which it should point.
        tool: The point of the frame that should reach the target, or its placement in the frame.
        relative_to: The frame in which the target is expressed.
        weight: A factor on the target's residual in the step.
        q0: Start configuration (nq,); or angles by joint name, with all other joints neutral; neutral when None;
            "nearest" for a start near the targets, from a table. With limits, all joints of the start are moved inside
            them first, including joints that move no target frame and locked ones. Hinges of the answer are at the
            whole turn nearest to the start that the limits allow, and the angles of continuous joints in
            `solution.angles` at the whole turn nearest to the angles given here.
        limits: Whether to enforce the joint limits.
        locked: Names of joints that must not move; floating and planar joints can be locked too.
        restarts: The maximum number of restarts, from starts drawn with `seed`, after a failed attempt; the solver's
            default when None; 0 for the method alone, as in `iterate`.
        seed: The seed of the random starts.
        max_iterations: The maximum number of iterations per attempt; the solver's default when None.
        tolerance: The errors that count as reached (metres, radians); 1e-4 m and 1e-3 rad when None.
        time_limit: Time limit [s], checked between iterations; no limit when None.
        engine: "auto", "python" or "native".
        trace: Whether to keep every state. With restarts, attempts of Jacobian methods may leave the limits in between;
            the answer does not.
        polish: Whether "dls" and "pinv" go on once every target is within tolerance, while a step still halves the
            residual. This makes the answer exact to nanometres, usually by one more step.
        choose: "first" for the first answer found. "nearest" goes on with restarts and takes, of the distinct answers
            found, the one nearest to `q0` by the largest change of a joint; `solution.chosen_from` counts them. It ends
            after `restarts` restarts, or once a quarter of them in a row has found nothing new.
        choose_weights: Joint name → factor of at least 0 on the change of that joint (rad, or m for prismatic joints)
            in "nearest"; 1 for joints not named.
        avoid: What the answer must not touch: "self" for the robot's own links, a `pinik.World`, or a list of both. An
            attempt that ends where something touches counts as failed. If all do, small steps away from a slight touch
            are tried; then the status is COLLIDING, and `solution.collisions` names what touches. Where answers are
            isolated, the attempts end early once the same ones collide again and again. Joints that move no target
            count too, with their values in `q0`, which itself may collide.
        **solver_parameters: Parameters of the solver, such as `damping=0.1`.

    Returns:
        The solution, with its errors recomputed by plain Pinocchio.

    Raises:
        UnknownNameError: A frame, joint, method or keyword does not exist.
        InputError: An argument has the wrong shape, type or range; or something is to be avoided, and the robot has no
            collision shapes.
        MissingExtraError: Something is to be avoided, and trimesh, which reads meshes, is not installed.
        EngineError: The requested engine is not available.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    given = (
        limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace, polish, choose,
        choose_weights, avoid,
    )  # fmt: skip
    return answer(robot, targets, method, wanted, q0, given, solver_parameters)


def prepare(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    *,
    position: Position | None = None,
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
    polish: bool = True,
    choose: str = "first",
    choose_weights: Mapping[str, float] | None = None,
    avoid: Avoided = None,
    **solver_parameters: Any,
) -> Prepared:
    """Check and compile a problem once, to solve it many times for other target positions and starts.

    The arguments and errors are those of `solve`. The frames and the kinds of their targets are fixed; the target
    positions and orientations may differ from call to call.
    """
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    asked = asked_targets(targets, wanted, method, solver_parameters, OPTION_NAMES)
    given = (
        limits, locked, restarts, seed, max_iterations, tolerance, time_limit, engine, trace, polish, choose,
        choose_weights, avoid,
    )  # fmt: skip
    return Prepared(robot, asked, options_of(method, given, solver_parameters))


def iterate(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    q0: ArrayLike | Mapping[str, float] | None = None,
    *,
    position: Position | None = None,
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
    polish: bool = True,
    **solver_parameters: Any,
) -> States:
    """Run one solver from one start, and yield a State per iteration, beginning with the start.

    The run ends with a state whose `status` is set: converged, stalled or out of iterations. There are three ways to
    use it: iterate until it ends; run it with `max_iterations=1` per simulation step, each time from the last q; or
    take a few iterations per step. `states.send(targets)` moves the targets during the run, resets the iteration limit,
    takes the next step and returns its state; it also works after the last state. If a tolerance is wide and the
    targets move before they are reached, the run looks for answers inside the tolerances at once.

    Args:
        robot: The robot.
        targets: The name of a frame, with its target in the keywords from `position` to `weight`; or one or several
            Target objects.
        method: A solver's name, class or instance.
        q0: Start configuration (nq,), or angles by joint name, moved inside the limits first; neutral when None.
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight: As for
            `Target`.
        limits: Whether to enforce the joint limits in every state.
        locked: Names of joints that must not move.
        max_iterations: The maximum number of iterations; the solver's default when None.
        tolerance: The errors that count as reached (metres, radians); 1e-4 m and 1e-3 rad when None.
        polish: As for `solve`; the steps within the tolerance count as iterations.
        **solver_parameters: Parameters of the solver.

    Raises:
        UnknownNameError, InputError: As for `solve`.
    """
    if "solver" in solver_parameters:
        if method != "dls":
            raise InputError("the method must be given once: solver= is the old name of method=")
        warnings.warn("iterate(solver=...) is deprecated; use method= instead", DeprecationWarning, stacklevel=2)
        method = solver_parameters.pop("solver")
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    asked = asked_targets(targets, wanted, method, solver_parameters, _OPTIONS_OF_ITERATE)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, max_iterations=max_iterations, tolerance=tolerance,
        polish=polish,
    )  # fmt: skip
    question = Question.of(robot, asked, options)
    origin = Origin.of(robot, q0)
    if origin.nearest:
        raise InputError("q0 must be a configuration or angles by joint name; only solve starts 'nearest'")
    start = question.limits.wrap(origin.q)
    return run(question, Kinematics.of(question.problem), start, Pace(options.iterations_at_most))
