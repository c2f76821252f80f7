"""The methods that can chase the balls, and their replacements when the robot changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ...errors import InputError
from ...problem.problem import Problem
from ...problem.targets import Target
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import CLOSED_FORMS, make_solver

__all__ = ["check_balls", "fitting", "offered"]


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
