"""Which methods the balls leave to choose from, and what becomes of a method when the robot changes."""

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
    """See that a method can chase a ball on one of these frames, if it is the only one and asks for a position alone.

    Raises:
        InputError: It cannot; the message says why not the first.
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
    """Names of the methods that can: closed forms do not know every robot."""
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
    """The solvers for another robot, and what was done to them, in words.

    Parameters lose what they say of joints that the robot does not have. A method that cannot chase a ball there makes
    room for the first that can, and is not among the others if there is such a one.
    """
    fit, notes = [_with_joints_of(robot, solver) for solver in solvers], []
    for number, solver in enumerate(fit):
        try:
            check_balls(solver, robot, frames)
        except InputError as error:
            taken = [other.name for other in fit]
            name = min(offered(methods, robot, frames), key=lambda name: name in taken)
            fit[number] = make_solver(methods[name])
            notes.append(f"instance {number + 1} goes on with {name}: {error}")
    return fit, notes


def _with_joints_of(robot: Robot, solver: Solver) -> Solver:
    kept = {
        name: {joint: v for joint, v in value.items() if joint in robot.joint_names}
        for name, value in solver.parameters.items()
        if isinstance(value, Mapping)
    }
    return make_solver(solver, **kept)
