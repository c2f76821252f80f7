"""`pinik solve`: joint angles for targets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...errors import PinikError
from ...problem.targets import Target
from ...robot import Robot
from ...solvers.base import Solver
from ...solving.front import solve as solve_targets
from ...solving.solution import Solution
from ..inputs import solve_options as given
from ..inputs.assignments import numbers_by_joint, origin, solver_with
from ..inputs.loading import load_robot
from ..inputs.obstacles import AvoidSelf, WorldFile, avoided
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..inputs.targets import (
    check_frames,
    named_by_option,
    option_of,
    read_position,
    target_from_options,
    targets_from_file,
)
from ..reports.solution_report import emit_solution
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus, in_words
from ..terminal.units import Units

__all__ = ["solve"]


def solve(
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
    restarts: given.Restarts = None,
    seed: given.Seed = 0,
    engine: given.Engine = "auto",
    no_polish: given.NoPolish = False,
    choose: given.Choose = "first",
    choose_weight: given.ChooseWeight = None,
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
    """Find joint angles that put a frame where you want it.

    If the target is missed, the exit status is 1 and the best answer is still printed.

    Examples:

      pinik solve arm --frame tip --position 0.3 0.1 0.8
      pinik solve ur5 --frame tool0 --position -0.3 0.2 0.5 --rpy 180 0 90 --deg
      pinik solve lion --frame nose --axis x --at 2 0.5 0.3 --pose relaxed
      echo '\\[{"frame":"tip","position":\\[0,0.3,1]}]' | pinik solve arm --targets -
    """
    units = Units(degrees)
    rpy = rpy and tuple(map(units.radians, rpy))  # type: ignore[assignment]
    wanted: dict[str, Any] = {"position": read_position(position), "rpy": rpy, "quat_xyzw": quat_xyzw}
    wanted |= {"axis": axis, "direction": direction, "at": at, "tool": tool, "relative_to": relative_to}
    asked = _asked(frame, wanted, targets)
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
        "polish": not no_polish,
        "choose": choose,
        "choose_weights": numbers_by_joint(choose_weight, "--choose-weight", "JOINT=W"),
        "q0": origin(machine, pose, start, "--start", units, None if no_limits else "moved inside"),
    }
    solution = _solved(machine, asked, solver, method, options)
    _emit(solution, units, as_json)
    return ExitStatus.ANSWERED if solution.success else ExitStatus.MISSED


def _asked(frame: str | None, wanted: Mapping[str, Any], file: str | None) -> list[Target]:
    """The targets, from the options or from the file."""
    if file is None:
        return [target_from_options(frame, wanted)]
    for name, value in {"frame": frame, **wanted}.items():
        if value is not None:
            raise CommandError(f"--targets reads all targets from the file; put {option_of(name)} into it")
    return targets_from_file(file)


def _solved(robot: Robot, asked: list[Target], solver: Solver, method: str, options: Mapping[str, Any]) -> Solution:
    """`pinik.solve`; its errors name the option, and a failure inside the user's own solver becomes one sentence."""
    try:
        with named_by_option(options):
            return solve_targets(robot, asked, solver, **options)
    except (PinikError, CommandError):
        raise
    except (Exception, SystemExit) as error:
        if type(solver).__module__.startswith("pinik."):
            raise
        raise CommandError(f"--method {method}: the solver failed: {in_words(error)}") from None


def _emit(solution: Solution, units: Units, as_json: bool) -> None:
    if as_json:
        output.emit_json(solution.to_dict())
    else:
        emit_solution(solution, units)
