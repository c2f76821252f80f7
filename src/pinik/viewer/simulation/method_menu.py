"""The methods that can chase the balls, and their replacements when the robot changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ...errors import InputError
from ...problem.problem import Problem
from ...problem.targets import Target
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import CLOSED_FORMS, Method, known_methods, make_solver

__all__ = ["Methods", "check_balls", "chosen", "filled_up", "fitting", "offered"]

Methods = Method | Iterable[Method]
"""One method or several, as names (also "ccd,dls"), classes or instances."""


def chosen(
    methods: Methods, robot: Robot, frames: Sequence[str], at_most: int
) -> tuple[list[Solver], dict[str, type[Solver]]]:
    """The solvers that a session begins with.

    Args:
        methods: The methods.
        robot: The robot.
        frames: The frames of the balls.
        at_most: The largest number of methods.

    Returns:
        The solvers, and short name → class for every available method.

    Raises:
        UnknownNameError: There is no such method.
        InputError: There are no methods or too many, one of them cannot chase any ball, or two of them share a name.
    """
    if isinstance(methods, (str, type, Solver)):
        methods = methods.split(",") if isinstance(methods, str) else [methods]
    solvers = [make_solver(method.strip() if isinstance(method, str) else method) for method in methods]
    if not 1 <= len(solvers) <= at_most:
        raise InputError(f"a live view has one to four methods; got {len(solvers)}")
    available = known_methods()
    for made in solvers:
        known = available.setdefault(made.name, type(made))
        if known is not type(made) or "," in made.name:
            raise InputError(f"a method's name must be unique and must not contain a comma; got {made.name!r}")
    for made in solvers:
        check_balls(made, robot, frames)
    return solvers, available


def filled_up(
    solvers: Sequence[Solver], methods: Mapping[str, type[Solver]], robot: Robot, frames: Sequence[str], count: int
) -> list[Solver]:
    """Solvers, followed by those of the remaining methods that can chase a ball, up to a number of solvers."""
    used = {solver.name for solver in solvers}
    others = [make_solver(methods[name]) for name in offered(methods, robot, frames) if name not in used]
    return [*solvers, *others][:count]


def check_balls(solver: Solver, robot: Robot, frames: Sequence[str]) -> None:
    """Check that a method can chase a ball on at least one of these frames, as its only target and by position alone.

    Raises:
        InputError: It can chase none; the message gives the reason for the first frame.
    """
    refusals = []
    for frame in frames:
        try:
            solver.check(Problem(robot, Target(frame, position=(0.0, 0.0, 0.0))))
            return
        except InputError as error:
            refusals.append(f"{solver.name} cannot chase a ball here: {error}")
    raise InputError(refusals[0])


def offered(methods: Mapping[str, type[Solver]], robot: Robot, frames: Sequence[str]) -> list[str]:
    """The names of the methods that can chase a ball on one of these frames; closed forms suit only some robots."""
    return [name for name, method in methods.items() if name not in CLOSED_FORMS or _can(method.make(), robot, frames)]


def _can(solver: Solver, robot: Robot, frames: Sequence[str]) -> bool:
    try:
        check_balls(solver, robot, frames)
    except InputError:
        return False
    return True


def fitting(
    solvers: Iterable[Solver], methods: Mapping[str, type[Solver]], robot: Robot, frames: Sequence[str]
) -> tuple[list[Solver], list[str]]:
    """Adapt solvers to another robot.

    Parameter entries for joints that the robot does not have are dropped. A method that cannot chase a ball on this
    robot is replaced by the first one that can, preferably one that is not in use yet.

    Returns:
        The solvers, and a note about each replacement.
    """
    fit, notes = [_with_joints_of(robot, solver) for solver in solvers], []
    for number, solver in enumerate(fit):
        try:
            check_balls(solver, robot, frames)
        except InputError as error:
            taken = [other.name for other in fit]
            name = min(offered(methods, robot, frames), key=lambda name: name in taken)
            fit[number] = make_solver(methods[name])
            notes.append(f"instance {number + 1} now uses {name}: {error}")
    return fit, notes


def _with_joints_of(robot: Robot, solver: Solver) -> Solver:
    kept = {
        name: {joint: v for joint, v in value.items() if joint in robot.joint_names}
        for name, value in solver.parameters.items()
        if isinstance(value, Mapping)
    }
    return make_solver(solver, **kept)
