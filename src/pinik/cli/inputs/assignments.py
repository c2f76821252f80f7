"""NAME=VALUE options: joint angles and solver parameters."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Mapping
from typing import Any

from ...errors import PinikError, UnknownNameError
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import SOLVERS, make_solver
from ..terminal.exits import CommandError, in_words
from ..terminal.output import say
from ..terminal.units import Units

__all__ = ["configuration", "solver_with", "solvers_with"]


def configuration(
    robot: Robot,
    pose: str | None,
    settings: Iterable[str] | None,
    option: str,
    units: Units,
    beyond_limits: str | None = "taken as it is",
) -> Any:
    """The configuration (nq,) of a named pose, or neutral, with some joints set.

    A value outside its joint's limits has a line on stderr.

    Args:
        robot: The robot.
        pose: The pose's name.
        settings: "JOINT=ANGLE" texts.
        option: The option that they came from, for errors.
        units: In which angles were given.
        beyond_limits: What happens to a value outside its joint's limits, in words; None where nobody cares.

    Raises:
        UnknownNameError: No such pose or joint.
        CommandError, InputError: A text or value that cannot be used.
    """
    q = robot.neutral()
    if pose is not None:
        poses = robot.poses
        if pose not in poses:
            raise UnknownNameError("pose", pose, poses)
        q = poses[pose].copy()
    for name, text in _pairs(settings, option, "JOINT=ANGLE", split_at_last=True):
        joint = robot.settable_joint(name)
        if not joint.has_one_axis:
            raise CommandError(f"{option} sets joints that turn or slide about one axis; {name!r} is {joint.kind}")
        try:
            angle = units.scalar(float(text), joint)
            robot.configuration({name: angle})  # refuses what is not finite
        except ValueError:
            raise CommandError(f"{option} {name}: the value is a finite number; got {text!r}") from None
        joint.set_angle(q, angle)
        index = robot.joint_names.index(name)
        lower, upper = float(robot.lower[index]), float(robot.upper[index])
        if beyond_limits and not lower <= angle <= upper:
            low, high = units.show_limits(lower, upper, joint)
            say(
                f"note: {option} {name}={text} lies outside its limits {low} … {high} {units.of(joint)}; "
                f"{beyond_limits}"
            )
    return q


def solver_with(method: str, parameters: Iterable[str] | None) -> Solver:
    """The solver of that name with "NAME=VALUE" parameters, each JSON where it reads as such, else text.

    Raises:
        UnknownNameError: No such method or parameter.
        CommandError, InputError: A text or value that cannot be used.
    """
    return _changed(_solver(method), parameters)


def solvers_with(solvers: Mapping[str, Solver], parameters: Iterable[str] | None) -> dict[str, Solver]:
    """Several solvers, by their short names, with "METHOD.NAME=VALUE" parameters in place of their own.

    Raises:
        UnknownNameError: No such method or parameter.
        CommandError, InputError: A text or value that cannot be used.
    """
    own: dict[str, list[str]] = {name: [] for name in solvers}
    for text in parameters or ():
        method, dot, rest = text.partition(".")
        if not dot or "=" in method:
            raise CommandError(f"--param takes METHOD.NAME=VALUE; got {text!r}")
        if method not in own:
            raise UnknownNameError("method", method, own)
        own[method].append(rest)
    return {name: _changed(solver, own[name]) for name, solver in solvers.items()}


def _changed(solver: Solver, parameters: Iterable[str] | None) -> Solver:
    values = {}
    for name, text in _pairs(parameters, "--param", "NAME=VALUE"):
        if name not in solver.parameters:
            raise UnknownNameError(f"parameter of {solver.name!r}", name, solver.parameters)
        try:
            values[name] = json.loads(text)
        except (ValueError, RecursionError):
            values[name] = text
    return make_solver(solver, **values)


def _solver(method: str) -> Solver:
    if method in SOLVERS or ":" not in method:
        return make_solver(method)
    if os.getcwd() not in sys.path:  # where "python -m pinik" looks as well
        sys.path.insert(0, os.getcwd())
    try:
        return make_solver(method)
    except PinikError:
        raise
    except (Exception, SystemExit) as error:  # the module is the user's, and may raise whatever it likes
        raise CommandError(f"--method {method}: its module cannot be imported: {in_words(error)}") from None


def _pairs(
    texts: Iterable[str] | None, option: str, form: str, *, split_at_last: bool = False
) -> list[tuple[str, str]]:
    pairs: dict[str, str] = {}
    for text in texts or ():
        name, equals, value = text.rpartition("=") if split_at_last else text.partition("=")
        if not (name and equals and value):
            raise CommandError(f"{option} takes {form}; got {text!r}")
        if name in pairs:
            raise CommandError(f"{option} {name} is given twice")
        pairs[name] = value
    return list(pairs.items())
