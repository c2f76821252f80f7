"""The present pose and question of an instance as text: Python, commands, JSON and YAML."""

from __future__ import annotations

import json
import shlex
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...problem.tolerance import Tolerance
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import known_methods
from ..simulation.session import Session
from .parameters import changed_parameters
from .robot_words import is_named, robot_words, source_of

__all__ = ["texts_to_copy"]

Array = NDArray[np.float64]


def texts_to_copy(session: Session, instance: int) -> list[dict[str, str]]:
    """The texts for a visible instance: each has a `name`, a `title` and its `text`.

    The question is what its method is asked now: to reach the balls from the present pose, without restarts. Numbers
    are written in full, so that the Python and the command give the same answer.

    Raises:
        InputError: There is no such visible instance.
    """
    robot, q = session.robot, session.instances.visible(instance).q
    angles = {name: float(robot.angles(q)[name]) for name in robot.joint_names}
    pose = [
        ("pose.py", "The pose as Python", _loaded(robot) + _configuration("q", robot, q, angles)),
        ("pose.sh", "The pose as a command", _left_out(robot, q) + _pose_command(robot, angles)),
        ("pose.json", "The pose as JSON", json.dumps({"angles": angles, **_root(robot, q)}, indent=2) + "\n"),
        ("pose.yaml", "The pose as YAML", _left_out(robot, q) + _pose_yaml(angles)),
    ]
    question = []
    if session.balls.targets:
        targets = {"schema": 1, "targets": [target.to_dict() for target in session.balls.targets]}
        question = [
            ("question.py", "The question as Python", _python(session, instance, angles)),
            ("question.sh", "The question as a command", _command(session, instance, angles)),
            ("question.json", "The targets as JSON", json.dumps(targets, indent=2) + "\n"),
        ]
    return [{"name": name, "title": title, "text": text} for name, title, text in (*question, *pose)]


def _loaded(robot: Robot) -> str:
    options = "" if robot.root == "fixed" else f", root={robot.root!r}"
    if robot.package_dirs and not is_named(robot):
        options += f", package_dirs={[str(folder) for folder in robot.package_dirs]!r}"
    if robot.allow_outside:
        options += ", allow_outside=True"
    return f"import pinik\n\nrobot = pinik.load({source_of(robot)!r}{options})\n"


def _root(robot: Robot, q: Array) -> dict[str, Any]:
    """The placements of floating and planar joints, in the JSON form of a configuration; nothing if there are none."""
    placements = {name: place.homogeneous.tolist() for name, place in robot.joint_placements(q).items()}
    return {"joint_placements": placements} if placements else {}


def _configuration(name: str, robot: Robot, q: Array, angles: dict[str, float]) -> str:
    parts = [f"{angles!r}", *(f"{value!r}" for value in _root(robot, q).values())]
    return f"{name} = robot.configuration({', '.join(parts)})\n"


def _python(session: Session, instance: int, angles: dict[str, float]) -> str:
    solver, settings = session.instances[instance].solver, session.settings
    targets = [f"    pinik.Target({_keywords(target.to_dict())}),\n" for target in session.balls.targets]
    options = [_keywords(changed)] if (changed := changed_parameters(solver)) else []
    if settings.tolerance != Tolerance():
        options.append(f"tolerance={(settings.tolerance.farthest, settings.tolerance.orientation)!r}")
    options += [] if settings.limits else ["limits=False"]
    options += ["restarts=0"] + ([] if settings.polish else ["polish=False"])
    module, name = _import_of(solver)
    text = f"from {module} import {name}\n" if module else ""
    text += _loaded(session.robot) + _configuration("q0", session.robot, session.instances[instance].q, angles)
    text += f"targets = [\n{''.join(targets)}]\n"
    method = name if module else repr(solver.name)
    text += f"solution = robot.solve(targets, method={method}, q0=q0, {', '.join(options)})\n"
    return text + "print(solution.message)\nprint(solution.angles)\n"


def _keywords(values: dict[str, Any]) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in values.items())


def _import_of(solver: Solver) -> tuple[str, str]:
    """Where a method of one's own is defined; nothing for pinik's own methods, which have short names."""
    own = type(solver)
    return ("", "") if known_methods().get(solver.name) is own else (own.__module__, own.__qualname__)


def _command(session: Session, instance: int, angles: dict[str, float]) -> str:
    solver, settings = session.instances[instance].solver, session.settings
    module, name = _import_of(solver)
    words = ["pinik", "solve", *robot_words(session.robot), "--targets", "-"]
    words += ["--method", f"{module}:{name}" if module else solver.name]
    for parameter, value in changed_parameters(solver).items():
        words += ["--param", f"{parameter}={json.dumps(value)}"]
    if settings.tolerance != Tolerance():
        words += ["--tolerance", repr(settings.tolerance.farthest), repr(settings.tolerance.orientation)]
    words += [] if settings.limits else ["--no-limits"]
    words += ["--restarts", "0"] + ([] if settings.polish else ["--no-polish"])
    for joint, angle in angles.items():
        words += ["--start", f"{joint}={angle!r}"]
    targets = json.dumps([target.to_dict() for target in session.balls.targets])
    note = _left_out(session.robot, session.instances[instance].q)
    return f"{note}{shlex.join(words)} <<'END'\n{targets}\nEND\n"


def _pose_command(robot: Robot, angles: dict[str, float]) -> str:
    words = ["pinik", "fk", *robot_words(robot)]
    for joint, angle in angles.items():
        words += ["--set", f"{joint}={angle!r}"]
    return shlex.join(words) + "\n"


def _pose_yaml(angles: dict[str, float]) -> str:
    """The angles as YAML. All names are in quotes, because `no` would be a truth value."""
    return "".join(f"{json.dumps(name, ensure_ascii=False)}: {angle!r}\n" for name, angle in angles.items())


def _left_out(robot: Robot, q: Array) -> str:
    """A comment for the forms that have angles alone; nothing if the robot has no floating or planar joint."""
    names = ", ".join(map(json.dumps, robot.joint_placements(q)))
    return f"# left out here: the placement of {names}, which the Python has\n" if names else ""
