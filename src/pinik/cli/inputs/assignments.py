"""NAME=VALUE options: joint angles and solver parameters."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ...errors import PinikError, UnknownNameError
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import SOLVERS, make_solver
from ...solving.origin import Origin
from ..terminal.exits import CommandError, in_words
from ..terminal.output import say
from ..terminal.units import Units

__all__ = ["configuration", "failures_in_words", "numbers_by_joint", "origin", "solver_with", "solvers_with"]


def configuration(
    robot: Robot,
    pose: str | None,
    assignments: Iterable[str] | None,
    option: str,
    units: Units,
    beyond_limits: str | None = "used as given",
) -> Any:
    """The configuration (nq,) of a named pose, or the neutral one, with some joints set.

    A value outside the joint's limits prints a note to stderr.

    Args:
        robot: The robot.
        pose: The pose's name.
        assignments: "JOINT=ANGLE" texts.
        option: The option that they come from, for errors.
        units: The unit of the angles.
        beyond_limits: What happens to a value outside the joint's limits, for the note; None for no note.

    Raises:
        UnknownNameError: No such pose or joint.
        CommandError, InputError: A text or value that cannot be used.
    """
    q = robot.neutral()
    if pose is not None:
        q = robot.poses[pose].copy()
    for name, text in _pairs(assignments, option, "JOINT=ANGLE", split_at_last=True):
        joint = robot.settable_joint(name)
        if not joint.has_one_axis:
            raise CommandError(f"{option} needs a joint that turns or slides about one axis; {name!r} is {joint.kind}")
        try:
            angle = units.scalar(float(text), joint)
            robot.configuration({name: angle})  # refuses what is not finite
        except ValueError:
            raise CommandError(f"{option} {name} must be a finite number; got {text!r}") from None
        joint.set_angle(q, angle)
        index = robot.joint_names.index(name)
        lower, upper = float(robot.lower[index]), float(robot.upper[index])
        if beyond_limits and not lower <= angle <= upper:
            low, high = units.show_limits(lower, upper, joint)
            say(f"note: {option} {name}={text} is outside the limits {low} … {high} {units.of(joint)}; {beyond_limits}")
    return q


def origin(
    robot: Robot,
    pose: str | None,
    assignments: Iterable[str] | None,
    option: str,
    units: Units,
    beyond_limits: str | None,
) -> Origin:
    """The start of a solve, in which continuous joints keep their turns; otherwise as `configuration`."""
    q = configuration(robot, pose, assignments, option, units, beyond_limits)
    given = dict(_pairs(assignments, option, "JOINT=ANGLE", split_at_last=True))
    turning = [robot.joint(name) for name in given if robot.joint(name).nq == 2]
    return Origin(q, turned={joint.name: units.scalar(float(given[joint.name]), joint) for joint in turning})


def numbers_by_joint(assignments: Iterable[str] | None, option: str, form: str) -> dict[str, float]:
    """The numbers of joints, from "JOINT=NUMBER" texts.

    Raises:
        CommandError: A text that cannot be used.
    """
    numbers = {}
    for name, text in _pairs(assignments, option, form, split_at_last=True):
        try:
            numbers[name] = float(text)
        except ValueError:
            raise CommandError(f"{option} {name} must be a number; got {text!r}") from None
    return numbers


def solver_with(method: str, parameters: Iterable[str] | None) -> Solver:
    """The solver of that name with "NAME=VALUE" parameters; a value that is not JSON is taken as text.

    Raises:
        UnknownNameError: No such method or parameter.
        CommandError, InputError: A text or value that cannot be used.
    """
    return _changed(_solver(method), parameters)


@contextmanager
def failures_in_words(solver: Solver, method: str) -> Iterator[None]:
    """Let a failure inside the user's own solver, which `--method` named so, become one sentence.

    Raises:
        CommandError: In place of what that solver raised.
    """
    try:
        yield
    except (PinikError, CommandError):
        raise
    except (Exception, SystemExit) as error:
        if type(solver).__module__.startswith("pinik."):
            raise
        raise CommandError(f"--method {method}: the solver failed: {in_words(error)}") from None


def solvers_with(solvers: Mapping[str, Solver], parameters: Iterable[str] | None) -> dict[str, Solver]:
    """Several solvers, by short name, with their parameters changed by "METHOD.NAME=VALUE".

    Raises:
        UnknownNameError: No such method or parameter.
        CommandError, InputError: A text or value that cannot be used.
    """
    own: dict[str, list[str]] = {name: [] for name in solvers}
    for text in parameters or ():
        method, dot, rest = text.partition(".")
        if not dot or "=" in method:
            raise CommandError(f"--param must be METHOD.NAME=VALUE; got {text!r}")
        if method not in own:
            raise UnknownNameError("method", method, own)
        own[method].append(rest)
    return {name: _changed(solver, own[name]) for name, solver in solvers.items()}


def _changed(solver: Solver, parameters: Iterable[str] | None) -> Solver:
    values = {}
    for name, text in _pairs(parameters, "--param", "NAME=VALUE"):
        if name not in solver.parameters:
            raise UnknownNameError("parameter", name, solver.parameters, f"the method is {solver.name!r}")
        try:
            values[name] = json.loads(text)
        except (ValueError, RecursionError):
            values[name] = text
    return make_solver(solver, **values)


def _solver(method: str) -> Solver:
    if method in SOLVERS or ":" not in method:
        return make_solver(method)
    if os.getcwd() not in sys.path:  # as with "python -m pinik"
        sys.path.insert(0, os.getcwd())
    try:
        return make_solver(method)
    except PinikError:
        raise
    except (Exception, SystemExit) as error:  # the user's module may raise anything
        raise CommandError(f"--method {method}: cannot import its module: {in_words(error)}") from None


def _pairs(
    texts: Iterable[str] | None, option: str, form: str, *, split_at_last: bool = False
) -> list[tuple[str, str]]:
    pairs: dict[str, str] = {}
    for text in texts or ():
        name, equals, value = text.rpartition("=") if split_at_last else text.partition("=")
        if not (name and equals and value):
            raise CommandError(f"{option} must be {form}; got {text!r}")
        if name in pairs:
            raise CommandError(f"{option} {name} is given twice")
        pairs[name] = value
    return list(pairs.items())
