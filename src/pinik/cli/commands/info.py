"""`pinik info`: what a robot has."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...echoes import shortened
from ...errors import RobotLoadError
from ...model.joint import Joint
from ...robot import Robot
from ...solving.native.module import why_not
from ...version import __version__
from ..inputs.loading import load_robot
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.tables import emit_table
from ..terminal.units import Units, counted

__all__ = ["info"]

_LONGEST_NAME = 100


def info(
    robot: RobotSource,
    degrees: Degrees = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Show a robot's joints with their limits, its frames and its named poses.

    Angles are radians, or degrees with --deg.

    Example:

      pinik info panda
    """
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    if as_json:
        output.emit_json(_fields(machine))
    else:
        _emit(machine, Units(degrees))
    return ExitStatus.ANSWERED


def _fields(robot: Robot) -> dict[str, Any]:
    return {
        "schema": 1,
        "robot": robot.name,
        "source": robot.description.source,
        "root": robot.root,
        "root_link": robot.description.root,
        "nq": robot.model.nq,
        "nv": robot.model.nv,
        "joints": [_joint_fields(robot, joint) for joint in robot.joints],
        "mimics": {
            follower: {"leader": leader, "multiplier": multiplier, "offset": offset}
            for follower, (leader, multiplier, offset) in robot.mimics.items()
        },
        "frames": list(robot.frame_names),
        "poses": {name: {"angles": robot.angles(q), "q": q.tolist()} for name, q in _poses(robot).items()},
        "warnings": list(robot.warnings),
        "engine": _engine(),
        "why_not_native": why_not(),
        "version": __version__,
        "pinocchio": pinocchio.__version__,
    }


def _poses(robot: Robot) -> Mapping[str, NDArray[np.float64]]:
    """The named configurations; none if the SRDF has a fault, which is a warning here."""
    try:
        return robot.poses
    except RobotLoadError as error:
        output.warn(str(error))
        return {}


def _engine() -> str:
    """The engine that `engine="auto"` takes for pinik's own methods."""
    return "python" if why_not() else "native"


def _joint_fields(robot: Robot, joint: Joint) -> dict[str, Any]:
    lower, upper = _limits(robot, joint)
    unit = Units().of(joint) if joint.has_one_axis else None
    axis = list(joint.axis) if joint.has_one_axis else None
    return {
        "name": joint.name,
        "kind": joint.kind,
        "unit": unit,
        "lower": lower,
        "upper": upper,
        "axis": axis,
        "mimics": joint.leader,
    }


def _limits(robot: Robot, joint: Joint) -> tuple[float | None, float | None]:
    """A joint's limits as they hold: its leader's where it follows; None where there are none."""
    if not joint.has_one_axis:
        return None, None
    index = robot.joint_names.index(joint.leader or joint.name)
    return joint.angle_range(float(robot.lower[index]), float(robot.upper[index]))


def _emit(robot: Robot, units: Units) -> None:
    description, model = robot.description, robot.model
    output.emit(f"{_shown(robot.name)}  {description.source}")
    output.emit(f"root      {_shown(description.root)}, {robot.root}")
    output.emit(
        f"size      {counted(len(robot.joint_names), 'joint')} to set, {counted(len(robot.frame_names), 'frame')}, "
        f"nq {model.nq}, nv {model.nv}"
    )
    output.emit(f"engine    {_engine()}, pinik {__version__}, Pinocchio {pinocchio.__version__}")
    why = why_not()
    if why:
        output.emit(textwrap.fill(why, _width(), initial_indent=" " * 10, subsequent_indent=" " * 10))
    output.emit("")
    if robot.joints:
        rows = [_row(robot, joint, units) for joint in robot.joints]
        emit_table(("joint", "kind", "lower", "upper", "unit", ""), rows, numeric=("lower", "upper"))
        output.emit("")
    output.emit(_wrapped("frames", robot.frame_names))
    poses = tuple(_poses(robot))
    output.emit(_wrapped("poses", poses or ("none",)))


def _row(robot: Robot, joint: Joint, units: Units) -> tuple[str, ...]:
    if not joint.has_one_axis:
        return _shown(joint.name), joint.kind, "", "", "", ""
    lower, upper = _limits(robot, joint)
    assert lower is not None
    assert upper is not None
    note = _following(joint, joint.leader) if joint.leader else ""
    return _shown(joint.name), joint.kind, *units.show_limits(lower, upper, joint), units.of(joint), note


def _following(joint: Joint, leader: str) -> str:
    factor = "" if joint.multiplier == 1.0 else f" × {joint.multiplier:g}"
    offset = "" if joint.offset == 0.0 else f" + {joint.offset:g}"
    return f"follows {_shown(leader)}{factor}{offset}"


def _shown(name: str) -> str:
    """A name for people to read; programs get the whole one in JSON."""
    return shortened(name, _LONGEST_NAME)


def _width() -> int:
    return shutil.get_terminal_size().columns if output.is_terminal(sys.stdout) else 100


def _wrapped(title: str, names: tuple[str, ...]) -> str:
    text = f"{title:8}  " + ", ".join(map(_shown, names))
    return textwrap.fill(text, _width(), subsequent_indent=" " * 10, break_long_words=False, break_on_hyphens=False)
