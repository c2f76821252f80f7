"""`pinik fk`: the positions and orientations of frames."""

from __future__ import annotations

from typing import Annotated, Any

import pinocchio
import typer

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
from ..terminal.units import Units, length, roll_pitch_yaw

__all__ = ["fk"]


def fk(
    robot: RobotSource,
    frame: Annotated[
        list[str] | None,
        typer.Option(metavar="F", help="A frame; repeatable. Default: all frames."),
    ] = None,
    joint_angles: JointAngles = None,
    pose: PoseName = None,
    relative_to: RelativeTo = None,
    degrees: Degrees = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Show the position and orientation of frames.

    Positions are in metres; orientations are fixed-axis roll, pitch, yaw.

    Example:

      pinik fk arm --frame tip --set bone1_x=-30 --set bone2_z=15 --deg
    """
    units = Units(degrees)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    q = configuration(machine, pose, joint_angles, "--set", units)
    placements = {name: machine.placement(name, q, relative_to) for name in frame or machine.frame_names}
    if as_json:
        output.emit_json(
            {
                "schema": 1,
                "robot": machine.name,
                "relative_to": relative_to,
                "frames": [_fields(name, placement) for name, placement in placements.items()],
                **configuration_fields(machine, q),
            }
        )
        return ExitStatus.ANSWERED
    angle = units.angle
    titles = ("frame", "x m", "y m", "z m", f"roll {angle}", f"pitch {angle}", f"yaw {angle}")
    rows = [
        (name, *map(length, M.translation), *map(units.show_angle, roll_pitch_yaw(M))) for name, M in placements.items()
    ]
    emit_table(titles, rows, numeric=titles[1:])
    return ExitStatus.ANSWERED


def _fields(name: str, placement: pinocchio.SE3) -> dict[str, Any]:
    return {
        "frame": name,
        "position": placement.translation.tolist(),
        "quat_xyzw": pinocchio.SE3ToXYZQUAT(placement)[3:].tolist(),
        "rpy": roll_pitch_yaw(placement),
    }
