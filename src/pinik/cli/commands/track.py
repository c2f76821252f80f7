"""`pinik track`: a path of a frame as joint angles."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ...solving.track import track as follow
from ..inputs import solve_options as given
from ..inputs.assignments import origin, solver_with
from ..inputs.loading import load_robot
from ..inputs.obstacles import AvoidSelf, WorldFile, avoided
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..inputs.paths import read_path
from ..inputs.targets import named_by_option
from ..reports.track_report import check_output, emit_track
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.units import Units

__all__ = ["track"]

PathFile = Annotated[
    str,
    typer.Argument(
        metavar="PATH",
        help="A CSV file with the header x,y,z[,qx,qy,qz,qw | ,roll,pitch,yaw][,t], where an empty x, y or z leaves "
        "that axis free, or JSON Lines with one target per line (see docs/tracks.md); - is stdin.",
        show_default=False,
    ),
]
TimeLimit = Annotated[
    float | None,
    typer.Option("--time-limit", metavar="S", help="The most seconds for each point.", rich_help_panel="The solver"),
]
OnMiss = Annotated[
    str,
    typer.Option(
        "--on-miss",
        metavar="hold|nearest|stop",
        help="At a point that is missed: hold the last configuration, take the nearest one, or stop the path.",
    ),
]
Output = Annotated[
    Path | None, typer.Option("--output", metavar="FILE", help="Write the joint angles here instead of to stdout.")
]
Format = Annotated[
    str | None,
    typer.Option("--format", metavar="csv|jsonl", help="The format of the angles; by the name of FILE, else csv."),
]


def track(
    robot: RobotSource,
    path: PathFile,
    frame: given.Frame = None,
    tool: given.Tool = None,
    relative_to: given.RelativeTo = None,
    on_miss: OnMiss = "hold",
    to_file: Output = None,
    form: Format = None,
    degrees: Degrees = False,
    method: given.Method = "dls",
    param: given.MethodParameter = None,
    tolerance: given.Tolerances = None,
    tolerance_box: given.ToleranceBox = None,
    max_iterations: given.MaxIterations = None,
    time_limit: TimeLimit = None,
    restarts: given.Restarts = None,
    seed: given.Seed = 0,
    engine: given.Engine = "auto",
    no_polish: given.NoPolish = False,
    start: given.Start = None,
    pose: given.StartPose = None,
    lock: given.Lock = None,
    no_limits: given.NoLimits = False,
    avoid_self: AvoidSelf = False,
    world: WorldFile = None,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Follow a path with a frame, and write the joint angles of every point.

    Each point is solved from the answer to the last one. If a point is missed or if
    joints jump, the exit status is 1, and stderr says where and why.

    Examples:

      echo '{"position":\\[0.2,0.2,0.9]}' | pinik track arm - --frame tip
      pinik track panda examples/circle.csv --frame panda_hand_tcp --pose default
    """
    units = Units(degrees)
    form = check_output(to_file, form)
    solver = solver_with(method, param)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    points = read_path(path, frame, {"tool": tool, "relative_to": relative_to}, units, machine)
    options: dict[str, Any] = {"restarts": restarts, "max_iterations": max_iterations, "time_limit": time_limit}
    options |= {
        "tolerance": given.tolerance_of(tolerance, tolerance_box),
        "seed": seed,
        "engine": engine,
        "limits": not no_limits,
        "locked": lock or (),
        "avoid": avoided(avoid_self, world, package_dir),
        "polish": not no_polish,
        "on_miss": on_miss,
        "q0": origin(machine, pose, start, "--start", units, None if no_limits else "moved inside"),
    }
    with named_by_option(options):
        answer = follow(machine, points.targets, method=solver, times=points.times or None, **options)
    if as_json:
        output.emit_json(answer.to_dict())
    if to_file is not None or not as_json:
        emit_track(answer, form, to_file, units)
    output.say(str(answer))
    return ExitStatus.ANSWERED if answer.success else ExitStatus.MISSED
