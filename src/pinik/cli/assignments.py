"""NAME=VALUE options: joint angles and solver parameters."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from ..errors import UnknownNameError
from ..robot import Robot
from ..solvers import Solver, make_solver
from .exits import CommandError
from .output import native_output_silenced
from .units import Units

__all__ = ["configuration", "named_poses", "solver_with"]


def configuration(robot: Robot, pose: str | None, settings: Iterable[str] | None, option: str, units: Units) -> Any:
    """The configuration (nq,) of a named pose, or neutral, with some joints set.

    Args:
        robot: The robot.
        pose: The pose's name.
        settings: "JOINT=ANGLE" texts.
        option: The option that they came from, for errors.
        units: In which angles were given.

    Raises:
        UnknownNameError: No such pose or joint.
        CommandError, InputError: A text or value that cannot be used.
    """
    q = robot.neutral()
    if pose is not None:
        poses = named_poses(robot)
        if pose not in poses:
            raise UnknownNameError("pose", pose, poses)
        q = poses[pose].copy()
    for name, text in _pairs(settings, option, "JOINT=ANGLE"):
        joint = robot.settable_joint(name)
        if not joint.has_one_axis:
            raise CommandError(f"{option} sets joints that turn or slide about one axis; {name!r} is {joint.kind}")
        try:
            angle = units.scalar(float(text), joint)
            robot.configuration({name: angle})  # refuses what is not finite
        except ValueError:
            raise CommandError(f"{option} {name}: the value is a finite number; got {text!r}") from None
        joint.set_angle(q, angle)
    return q


def named_poses(robot: Robot) -> dict[str, Any]:
    """`robot.poses`, read without the words of Pinocchio's SRDF reader."""
    with native_output_silenced():
        return robot.poses


def solver_with(method: str, parameters: Iterable[str] | None) -> Solver:
    """The solver of that name with "NAME=VALUE" parameters, each JSON where it reads as such, else text.

    Raises:
        UnknownNameError: No such method or parameter.
        CommandError, InputError: A text or value that cannot be used.
    """
    solver = make_solver(method)
    values = {}
    for name, text in _pairs(parameters, "--param", "NAME=VALUE"):
        if name not in solver.parameters:
            raise UnknownNameError(f"parameter of {solver.name!r}", name, solver.parameters)
        try:
            values[name] = json.loads(text)
        except (ValueError, RecursionError):
            values[name] = text
    return make_solver(solver, **values)


def _pairs(texts: Iterable[str] | None, option: str, form: str) -> list[tuple[str, str]]:
    pairs: dict[str, str] = {}
    for text in texts or ():
        name, equals, value = text.partition("=")
        if not (name and equals and value):
            raise CommandError(f"{option} takes {form}; got {text!r}")
        if name in pairs:
            raise CommandError(f"{option} {name} is given twice")
        pairs[name] = value
    return list(pairs.items())
