"""`pinik reach`: what a robot can reach, of all of space or of a list of places."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pinocchio

from ...errors import UnknownNameError
from ...problem.targets import Target
from ...robot import Robot
from ...solvers.base import Solver
from ...workspace.drawing import QUANTITIES
from ...workspace.files import check_suffix
from ...workspace.front import MAX_ITERATIONS, RESTARTS, WAYS
from ...workspace.front import reach as reach_all
from ...workspace.listed import reach_targets
from ...workspace.reach_map import ReachMap
from ..inputs import reach_options as asked
from ..inputs import solve_options as given
from ..inputs.assignments import failures_in_words, origin, solver_with
from ..inputs.files import check_file
from ..inputs.loading import load_robot
from ..inputs.obstacles import AvoidSelf, WorldFile, avoided
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..inputs.paths import read_path
from ..inputs.targets import named_by_option
from ..reports.plots import check_plot, save_plot
from ..reports.reach_plot import draw_slices
from ..reports.reach_report import (
    bases_fields,
    emit_bases,
    emit_map,
    emit_targets,
    map_fields,
    targets_fields,
)
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus
from ..terminal.progress import JobProgress
from ..terminal.units import Units

__all__ = ["reach"]

_BOTH = (*WAYS, "both")


def reach(
    robot: RobotSource,
    targets: asked.Targets = None,
    frame: given.Frame = None,
    by: asked.By = "sampling",
    cell: asked.Cell = None,
    box: asked.Box = None,
    samples: asked.Samples = None,
    directions: asked.DirectionCount = None,
    rolls: asked.RollCount = None,
    approach: asked.Approach = "z",
    branches: asked.Branches = False,
    tool: given.Tool = None,
    relative_to: given.RelativeTo = None,
    bases: asked.Bases = None,
    map_file: asked.MapFile = None,
    to_file: asked.Output = None,
    picture: asked.PictureFile = None,
    slices: asked.SlicesFile = None,
    page: asked.PageFile = None,
    quantity: asked.Quantity = "share",
    workspace: asked.Workspace = "any",
    resume: asked.Resume = False,
    workers: asked.Workers = None,
    scheduler: asked.Scheduler = None,
    degrees: Degrees = False,
    method: given.Method = "dls",
    param: given.MethodParameter = None,
    tolerance: given.Tolerances = None,
    tolerance_box: given.ToleranceBox = None,
    max_iterations: given.MaxIterations = None,
    restarts: given.Restarts = None,
    seed: given.Seed = 0,
    engine: given.Engine = "auto",
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
    """Map what a frame of a robot can reach, or say which places of a list it reaches.

    A map tells for each cell of space in which orientations it is reached, how
    well, and how near the joint limits. With a list of places, the exit status
    is 1 if one of them is missed.

    Examples:

      pinik reach panda --frame panda_hand_tcp --page panda.html --slices panda.png
      pinik reach panda examples/circle.csv --frame panda_hand_tcp
      pinik reach panda examples/circle.csv --frame panda_hand_tcp --bases 3
    """
    units = Units(degrees)
    _check(frame, by, targets, bases, map_file, (to_file, slices, page, picture))
    making = {
        "--by": by if by != "sampling" else None, "--cell": cell, "--box": box, "--samples": samples,
        "--directions": directions, "--rolls": rolls, "--approach": approach if approach != "z" else None,
        "--branches": branches or None, "--resume": resume or None, "--workers": workers, "--scheduler": scheduler,
    }  # fmt: skip
    _check_making([name for name, value in making.items() if value is not None], targets, bases, map_file)
    with named_by_option({"workspace": workspace}):
        shown = asked.workspace_of(workspace)
    if quantity not in QUANTITIES:
        raise UnknownNameError("quantity", quantity, QUANTITIES)
    solver = solver_with(method, param)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    common: dict[str, Any] = {
        "tolerance": given.tolerance_of(tolerance, tolerance_box),
        "seed": seed,
        "engine": engine,
        "limits": not no_limits,
        "locked": lock or (),
        "avoid": avoided(avoid_self, world, package_dir),
        "q0": origin(machine, pose, start, "--start", units, None if no_limits else "moved inside"),
    }
    began = time.perf_counter()
    if targets is not None and bases is None:
        places = _places(targets, frame, {"tool": tool, "relative_to": relative_to}, units, machine)
        options = common | {"restarts": restarts, "max_iterations": max_iterations}
        with failures_in_words(solver, method), named_by_option(options):
            answer = reach_targets(machine, places, method=solver, **options)
        if as_json:
            output.emit_json(targets_fields(machine, places, answer, time.perf_counter() - began))
        else:
            emit_targets(places, answer)
        return ExitStatus.ANSWERED if answer.success else ExitStatus.MISSED
    found, agreement = None, None
    if map_file is not None:
        found = ReachMap.load(map_file, machine)
        if to_file is not None:
            found.save(to_file)
    else:
        options = common | {
            "restarts": RESTARTS if restarts is None else restarts,
            "max_iterations": MAX_ITERATIONS if max_iterations is None else max_iterations,
            "cell": cell,
            "box": None if box is None else (box[:3], box[3:]),
            "samples": samples,
            "directions": directions,
            "rolls": rolls,
            "axis": approach,
            "branches": branches,
            "tool": tool,
            "relative_to": relative_to,
            "workers": workers,
            "scheduler": scheduler,
        }
        files = {"output": to_file, "resume": resume}
        with failures_in_words(solver, method), named_by_option(options | files):
            if by == "both":
                drawn = _mapped(machine, frame, solver, "sampling", options | {"branches": False})
                found = _mapped(machine, frame, solver, "solving", options | files | {"samples": None})
                agreement = found.agreement(drawn)
            else:
                found = _mapped(machine, frame, solver, by, options | files)
    if bases is not None:
        places = _places(targets, found.frame, {}, units, machine)
        options = common | {"restarts": restarts, "max_iterations": max_iterations}
        with failures_in_words(solver, method), named_by_option(options):
            chosen = found.bases([_placed(place) for place in places], most=bases, method=solver, **options)
        if as_json:
            output.emit_json(bases_fields(found, chosen, time.perf_counter() - began))
        else:
            emit_bases(chosen, units)
        return ExitStatus.ANSWERED if len(chosen) else ExitStatus.MISSED
    seconds = time.perf_counter() - began
    if picture is not None:
        found.draw(quantity=quantity, workspace=shown).save(picture)
    if slices is not None:
        save_plot(draw_slices(found, quantity, shown), slices, "--slices")
    if page is not None:
        found.save_page(page)
    if as_json:
        output.emit_json(map_fields(found, seconds, agreement))
    else:
        emit_map(found, agreement)
    return ExitStatus.ANSWERED


def _check(
    frame: str | None,
    by: str,
    targets: str | None,
    bases: int | None,
    map_file: Path | None,
    files: tuple[Path | None, ...],
) -> None:
    """Check what can be checked before the robot is loaded."""
    if by not in _BOTH:
        raise UnknownNameError("way", by, _BOTH)
    if bases is not None and targets is None:
        raise CommandError("--bases needs the list of places for which the base is chosen")
    if frame is None and targets is None and map_file is None:
        raise CommandError("give the frame that reaches by --frame F")
    if frame is None and bases is not None and map_file is None:
        raise CommandError("--bases needs --frame F, to map the robot")
    if targets is not None and bases is None and any(path is not None for path in (map_file, files[0])):
        raise CommandError("--map and --output are for maps; leave out the list of places, or ask for --bases")
    to_file, slices, page, picture = files
    if targets is not None and any(path is not None for path in (slices, page, picture)):
        raise CommandError("pictures and pages show maps; leave out the list of places")
    for path, option in zip(files, ("--output", "--slices", "--page", "--picture"), strict=True):
        if path is not None:
            check_file(path, option)
    if to_file is not None:
        check_suffix(to_file)
    if slices is not None:
        check_plot(slices, "--slices")


def _check_making(options: list[str], targets: str | None, bases: int | None, map_file: Path | None) -> None:
    """Check that nothing is said of how to make a map where none is made."""
    if not options:
        return
    if map_file is not None:
        raise CommandError(f"{options[0]} is for making a map; --map reads one that was made")
    if targets is not None and bases is None:
        raise CommandError(f"{options[0]} is for maps; leave out the list of places, or ask for --bases")


def _places(
    targets: str | None, frame: str | None, common: Mapping[str, Any], units: Units, robot: Robot
) -> list[Target]:
    """The targets of a list, one of each line."""
    points = read_path(targets or "-", frame, common, units, robot).targets
    if any(len(point) != 1 for point in points):
        raise CommandError(f"{targets}: each line must be a target for one frame")
    return [target for (target,) in points]


def _placed(target: Target) -> Any:
    """A target as a place: a homogeneous matrix, or a position if any orientation will do."""
    if target.position is None or not all(target.along) or target.axis is not None:
        raise CommandError("--bases needs places with x, y and z, and either an orientation or none")
    if target.rotation is None:
        return target.position
    return pinocchio.SE3(target.rotation, target.position)


def _mapped(robot: Robot, frame: str | None, solver: Solver, by: str, options: Mapping[str, Any]) -> ReachMap:
    """Make a map, and report how far it is."""
    with JobProgress(f"reach by {by}: ") as tell:
        return reach_all(robot, frame or "", solver, by=by, on_progress=tell, **options)
