"""`pinik solve`: joint angles for targets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from ...errors import InputError, PinikError
from ...solvers.registry import CLOSED_FORMS, SOLVERS
from ...solving.front import solve as solve_targets
from ..inputs import goals
from ..inputs.assignments import configuration, solver_with
from ..inputs.loading import load_robot
from ..inputs.options import AsJson, Degrees, PackageDirs, RobotSource, Root
from ..reports.solution_report import emit_solution
from ..reports.solver_help import method_names, solvers_help
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus, in_words
from ..terminal.units import Units

__all__ = ["EPILOG", "solve"]

EPILOG = solvers_help()

_TARGET = "The target"
_START = "Start and limits"
_SOLVER = "The solver"

Vector = tuple[float, float, float]


def solve(
    robot: RobotSource,
    frame: Annotated[
        str | None, typer.Option(metavar="F", help="The frame that should move.", rich_help_panel=_TARGET)
    ] = None,
    position: Annotated[
        Vector | None,
        typer.Option(metavar="X Y Z", help="Where it should be, in metres.", rich_help_panel=_TARGET),
    ] = None,
    rpy: Annotated[
        Vector | None,
        typer.Option(metavar="R P Y", help="Its orientation: fixed-axis roll, pitch, yaw.", rich_help_panel=_TARGET),
    ] = None,
    quat_xyzw: Annotated[
        tuple[float, float, float, float] | None,
        typer.Option(metavar="X Y Z W", help="Its orientation: a quaternion, scalar last.", rich_help_panel=_TARGET),
    ] = None,
    axis: Annotated[
        str | None,
        typer.Option(
            metavar="x|y|z",
            help="Let this axis (-x, -y, -z too) point along --direction or at --at; the spin is free.",
            rich_help_panel=_TARGET,
        ),
    ] = None,
    direction: Annotated[
        Vector | None,
        typer.Option(metavar="X Y Z", help="For --axis to point along.", rich_help_panel=_TARGET),
    ] = None,
    at: Annotated[
        Vector | None,
        typer.Option(metavar="X Y Z", help="A point for --axis to point at.", rich_help_panel=_TARGET),
    ] = None,
    tool: Annotated[
        Vector | None,
        typer.Option(metavar="X Y Z", help="The point meant, in the frame, in metres.", rich_help_panel=_TARGET),
    ] = None,
    relative_to: Annotated[
        str | None,
        typer.Option(metavar="FRAME", help="Express the target in this frame, moving or not.", rich_help_panel=_TARGET),
    ] = None,
    targets: Annotated[
        str | None,
        typer.Option(
            metavar="FILE.json",
            help="Several targets instead: a JSON list, in metres and radians (docs/json.md); - is stdin.",
            rich_help_panel=_TARGET,
        ),
    ] = None,
    degrees: Degrees = False,
    method: Annotated[
        str,
        typer.Option(metavar=method_names(), help="The method; module:Class finds yours.", rich_help_panel=_SOLVER),
    ] = "dls",
    param: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="A parameter of the method, see below; the value is read as JSON or as a word; repeatable.",
            rich_help_panel=_SOLVER,
        ),
    ] = None,
    tolerance: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="M RAD",
            help="Errors that count as reached: metres, radians.",
            show_default="0.0001 0.001",
            rich_help_panel=_SOLVER,
        ),
    ] = None,
    max_iterations: Annotated[
        int | None,
        typer.Option(metavar="N", help="Iterations of one attempt at most.", rich_help_panel=_SOLVER),
    ] = None,
    time_limit: Annotated[
        float | None, typer.Option(metavar="S", help="Seconds at most.", rich_help_panel=_SOLVER)
    ] = None,
    restarts: Annotated[
        int | None,
        typer.Option(metavar="N", help="Fresh starts at most; 0 is the bare method.", rich_help_panel=_SOLVER),
    ] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="Of the fresh starts.", rich_help_panel=_SOLVER)] = 0,
    engine: Annotated[
        str,
        typer.Option(metavar="auto|python|native", help="Which engine computes.", rich_help_panel=_SOLVER),
    ] = "auto",
    start: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT=ANGLE",
            help="Start from this value (rad, or m where it slides); repeatable. The rest starts at 0.",
            rich_help_panel=_START,
        ),
    ] = None,
    pose: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Start from this named pose ('pinik info' lists them).",
            rich_help_panel=_START,
        ),
    ] = None,
    lock: Annotated[
        list[str] | None,
        typer.Option(metavar="JOINT", help="Hold this joint where it starts; repeatable.", rich_help_panel=_START),
    ] = None,
    no_limits: Annotated[
        bool, typer.Option("--no-limits", help="Let joints leave their limits.", rich_help_panel=_START)
    ] = False,
    root: Root = "fixed",
    package_dir: PackageDirs = None,
    as_json: AsJson = False,
) -> ExitStatus:
    """Find the joint angles that put a frame where it should be.

    Exit status 1 says that the target was missed; the best answer is printed all the same.

    Examples:

      pinik solve arm --frame tip --position 0.3 0.1 0.8
      pinik solve ur5 --frame tool0 --position -0.3 0.2 0.5 --rpy 180 0 90 --deg
      pinik solve lion --frame nose --axis x --at 2 0.5 0.3 --pose relaxed
      echo '\\[{"frame":"tip","position":\\[0,0.3,1]}]' | pinik solve arm --targets -
    """
    units = Units(degrees)
    wanted = {
        "position": position,
        "rpy": rpy and tuple(map(units.radians, rpy)),
        "quat_xyzw": quat_xyzw,
        "axis": axis,
        "direction": direction,
        "at": at,
        "tool": tool,
        "relative_to": relative_to,
    }
    if targets is None:
        goal = [goals.target_from_options(frame, wanted)]
    else:
        _refuse_options_beside_file(frame, wanted)
        goal = goals.targets_from_file(targets)
    solver = solver_with(method, param)
    machine = load_robot(robot, root=root, package_dirs=package_dir)
    if targets is not None:
        goals.check_frames(machine, goal, targets)
    options: dict[str, Any] = {
        "restarts": restarts,
        "seed": seed,
        "max_iterations": max_iterations,
        "tolerance": tolerance,
        "time_limit": time_limit,
    }
    q0 = configuration(machine, pose, start, "--start", units, None if no_limits else "moved inside")
    try:
        solution = solve_targets(
            machine, goal, solver, q0=q0, limits=not no_limits, locked=lock or (), engine=engine, **options
        )
    except InputError as error:
        raise CommandError(goals.as_options(str(error), options)) from None
    except PinikError:
        raise
    except (Exception, SystemExit) as error:
        if method in SOLVERS or method in CLOSED_FORMS:
            raise
        # The solver is the user's, and may raise whatever it likes.
        raise CommandError(f"--method {method}: the solver failed: {in_words(error)}") from None
    if as_json:
        output.emit_json(solution.to_dict())
    else:
        emit_solution(solution, units)
    return ExitStatus.ANSWERED if solution.success else ExitStatus.MISSED


def _refuse_options_beside_file(frame: str | None, wanted: Mapping[str, object]) -> None:
    given = [name for name, value in {"frame": frame, **wanted}.items() if value is not None]
    if given:
        option = "--" + given[0].replace("_", "-")
        raise CommandError(f"with --targets the targets come from the file; {option} belongs into it")
