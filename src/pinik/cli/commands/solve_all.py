"""`pinik solve-all`: all distinct answers for targets."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ...solving.solve_all import solve_all as solve_targets
from ..inputs import solve_options as given
from ..inputs.assignments import failures_in_words, origin, solver_with
from ..inputs.loading import load_robot
from ..inputs.obstacles import AvoidSelf, WorldFile, avoided
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..inputs.targets import asked_targets, check_frames, named_by_option, read_position
from ..reports.branches_report import emit_branches
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.units import Units

__all__ = ["solve_all"]

Restarts = Annotated[
    int | None,
    typer.Option(
        "--restarts",
        metavar="N",
        help="The most starts after the first; at most 128, as without this option.",
        rich_help_panel="The solver",
    ),
]
Families = Annotated[
    bool,
    typer.Option(
        "--families",
        help="Trace the curves on which the answers lie, if they have one dimension.",
        rich_help_panel="The solver",
    ),
]


def solve_all(
    robot: RobotSource,
    frame: given.Frame = None,
    position: given.Position = None,
    rpy: given.Rpy = None,
    quat_xyzw: given.QuatXyzw = None,
    axis: given.Axis = None,
    direction: given.Direction = None,
    at: given.At = None,
    tool: given.Tool = None,
    relative_to: given.RelativeTo = None,
    targets: given.TargetsFile = None,
    degrees: Degrees = False,
    method: given.Method = "dls",
    param: given.MethodParameter = None,
    tolerance: given.Tolerances = None,
    tolerance_box: given.ToleranceBox = None,
    max_iterations: given.MaxIterations = None,
    time_limit: given.TimeLimit = None,
    restarts: Restarts = None,
    seed: given.Seed = 0,
    engine: given.Engine = "auto",
    start: given.Start = None,
    pose: given.StartPose = None,
    lock: given.Lock = None,
    no_limits: given.NoLimits = False,
    avoid_self: AvoidSelf = False,
    world: WorldFile = None,
    families: Families = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Find all distinct joint angles that put a frame where you want it, nearest to the start first.

    The search is numerical: docs/solve_all.md says how complete it is. Without an answer the exit status is 1.

    Examples:

      pinik solve-all ur5 --frame tool0 --position 0.4 0.1 0.4 --rpy 3.14 0 1.57
      pinik solve-all two_link --frame tip --position 0.4 0.3 0 --method two_bone
    """
    units = Units(degrees)
    rpy = rpy and tuple(map(units.radians, rpy))  # type: ignore[assignment]
    wanted: dict[str, Any] = {"position": read_position(position), "rpy": rpy, "quat_xyzw": quat_xyzw}
    wanted |= {"axis": axis, "direction": direction, "at": at, "tool": tool, "relative_to": relative_to}
    asked = asked_targets(frame, wanted, targets)
    solver = solver_with(method, param)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    if targets is not None:
        check_frames(machine, asked, targets)
    options: dict[str, Any] = {"restarts": restarts, "max_iterations": max_iterations, "time_limit": time_limit}
    options |= {
        "tolerance": given.tolerance_of(tolerance, tolerance_box),
        "seed": seed,
        "engine": engine,
        "limits": not no_limits,
        "locked": lock or (),
        "avoid": avoided(avoid_self, world, package_dir),
        "q0": origin(machine, pose, start, "--start", units, None if no_limits else "moved inside"),
    }
    with failures_in_words(solver, method), named_by_option(options):
        branches = solve_targets(machine, asked, solver, **options)
    if as_json:
        output.emit_json(branches.to_dict(families))
    else:
        emit_branches(branches, units, families)
    return ExitStatus.ANSWERED if branches.success else ExitStatus.MISSED
