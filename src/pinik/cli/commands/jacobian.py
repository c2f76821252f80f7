"""`pinik jacobian`: the Jacobian of a frame."""

from __future__ import annotations

from typing import Annotated

import typer

from ...robot import Robot
from ..inputs.assignments import configuration
from ..inputs.loading import load_robot
from ..inputs.options import (
    AllowOutside,
    AsJson,
    Degrees,
    JointAngles,
    PackageDirs,
    PoseName,
    RelativeTo,
    RobotSource,
    Root,
    XacroArgs,
)
from ..reports.configuration_json import configuration_fields
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.tables import emit_table
from ..terminal.units import Units

__all__ = ["jacobian"]

_ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")
_COORDINATES = {"floating": _ROWS, "planar": ("vx", "vy", "wz")}


def jacobian(
    robot: RobotSource,
    frame: Annotated[str, typer.Option(metavar="F", help="The frame.", show_default=False)],
    joint_angles: JointAngles = None,
    pose: PoseName = None,
    axes: Annotated[
        str,
        typer.Option(
            metavar="local_world_aligned|local|world",
            help="The velocity's point and axes: the frame's origin with world axes, the frame's own, or the world's.",
        ),
    ] = "local_world_aligned",
    relative_to: RelativeTo = None,
    degrees: Degrees = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Show the Jacobian of a frame: its linear, then its angular velocity per joint velocity, in metres and radians.

    Each line of the table is a column of the Jacobian.

    Example:

      pinik jacobian arm --frame tip --set bone1_x=0.3
    """
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    q = configuration(machine, pose, joint_angles, "--set", Units(degrees))
    matrix = machine.jacobian(frame, q, axes, relative_to)
    columns = _column_names(machine)
    if as_json:
        output.emit_json(
            {
                "schema": 1,
                "robot": machine.name,
                "frame": frame,
                "axes": axes,
                "relative_to": relative_to,
                "rows": list(_ROWS),
                "columns": columns,
                "jacobian": matrix.tolist(),
                **configuration_fields(machine, q),
            }
        )
    else:
        rows = [(name, *(f"{value:z.5f}" for value in column)) for name, column in zip(columns, matrix.T, strict=True)]
        emit_table(("joint", *_ROWS), rows, numeric=_ROWS)
    return ExitStatus.ANSWERED


def _column_names(robot: Robot) -> list[str]:
    """The name of each tangent coordinate: its joint, or JOINT.MOTION if the joint has several."""
    names = [""] * robot.model.nv
    for joint in robot.joints:
        if joint.leader is not None:
            continue
        if joint.has_one_axis:
            names[joint.idx_v] = joint.name
            continue
        for offset, motion in enumerate(_COORDINATES[joint.kind]):
            names[joint.idx_v + offset] = f"{joint.name}.{motion}"
    return names
