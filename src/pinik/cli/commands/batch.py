"""`pinik batch`: a table of targets to a table of answers."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any, BinaryIO

import typer

from ...errors import InputError
from ..inputs import solve_options as given
from ..inputs.assignments import failures_in_words, numbers_by_joint, origin, solver_with
from ..inputs.files import check_file
from ..inputs.loading import load_robot
from ..inputs.obstacles import AvoidSelf, WorldFile, avoided
from ..inputs.options import AllowOutside, AsJson, Degrees, PackageDirs, RobotSource, Root, XacroArgs
from ..inputs.targets import named_by_option
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus
from ..terminal.progress import JobProgress
from ..terminal.units import Units

__all__ = ["batch"]


def _files(help: str, name: str, metavar: str, **more: Any) -> Any:
    return typer.Option(name, metavar=metavar, help=help, rich_help_panel="Files", **more)


def _work(help: str, name: str, metavar: str | None = None) -> Any:
    return typer.Option(name, metavar=metavar, help=help, rich_help_panel="The work")


Table = Annotated[
    str,
    typer.Argument(
        metavar="TARGETS",
        help="A table of targets: .csv, .jsonl, .ndjson, .npz or .parquet, with columns x,y,z and more (see "
        "docs/scale.md); - is stdin.",
        show_default=False,
    ),
]
Output = Annotated[str, _files("The table of answers, in any of these formats; - is stdout.", "--output", "FILE")]
Format = Annotated[
    str | None,
    _files("The format of the answers; by the name of FILE, else csv.", "--format", "csv|jsonl|npz|parquet"),
]
TargetsFormat = Annotated[
    str | None,
    _files("The format of the targets; by their name, or by how stdin begins.", "--targets-format", "FORMAT"),
]
Times = Annotated[
    bool,
    typer.Option(
        "--times",
        help="Add a column with the seconds of each solve, which differ from run to run.",
        rich_help_panel="Files",
    ),
]
SkipBad = Annotated[
    bool,
    typer.Option("--skip-bad", help="List faulty rows on stderr, and answer all others.", rich_help_panel="Files"),
]
Resume = Annotated[
    bool,
    typer.Option("--resume", help="Go on with an earlier run that did not end.", rich_help_panel="The work"),
]
Chunk = Annotated[int, _work("The number of rows in a chunk, which is solved and kept as a whole.", "--chunk", "N")]
Threads = Annotated[int | None, _work("The number of threads; all processors by default.", "--threads", "N")]
Workers = Annotated[
    int | None, _work("Work in N processes of a Dask cluster on this machine instead.", "--workers", "N")
]
Scheduler = Annotated[
    str | None, _work("Work on the Dask cluster with this scheduler instead.", "--scheduler", "ADDRESS")
]
TimeLimit = Annotated[
    float | None,
    typer.Option("--time-limit", metavar="S", help="The most seconds for each row.", rich_help_panel="The solver"),
]


def batch(
    robot: RobotSource,
    targets: Table,
    to_file: Output,
    frame: given.Frame = None,
    tool: given.Tool = None,
    relative_to: given.RelativeTo = None,
    form: Format = None,
    targets_form: TargetsFormat = None,
    times: Times = False,
    skip_bad: SkipBad = False,
    resume: Resume = False,
    chunk: Chunk = 8192,
    threads: Threads = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
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
    """Answer every row of a table of targets, and write a table of answers.

    Each row is answered on its own, as 'pinik solve' answers it. A run that was
    killed goes on with --resume. If a row is missed or left out, the exit status is 1.

    Examples:

      pinik batch arm examples/poses.csv --frame tip --output -
      echo '{"x":0.2,"y":0.2,"z":0.9}' | pinik batch arm - --frame tip --output - --format jsonl
    """
    from ...batch import run

    _check_streams(robot, targets, to_file, as_json)
    units = Units(degrees)
    solver = solver_with(method, param)
    machine = load_robot(robot, root=root, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    sink: str | BinaryIO = sys.stdout.buffer if to_file == "-" else to_file
    options: dict[str, Any] = {"restarts": restarts, "max_iterations": max_iterations, "time_limit": time_limit}
    options |= {
        "output": sink,
        "tool": tool,
        "relative_to": relative_to,
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
        "skip_bad": skip_bad,
        "resume": resume,
        "chunk": chunk,
        "threads": threads,
        "workers": workers,
        "scheduler": scheduler,
    }
    files: dict[str, Any] = {"form": form, "targets_form": targets_form, "times": times, "degrees": degrees}
    source: str | BinaryIO = sys.stdin.buffer if targets == "-" else targets
    try:
        with failures_in_words(solver, method), named_by_option(options), JobProgress() as progress:
            summary = run(
                machine,
                source,
                frame,
                solver,
                on_bad=output.warn,
                on_progress=progress,
                **files,
                **options,
            )
    except BaseException as error:
        if not isinstance(error, (InputError, CommandError)):  # these come before any work
            _say_what_is_kept(to_file)
        if isinstance(error, OSError):
            return _lost(to_file, error)
        raise
    if as_json:
        output.emit_json({"robot": machine.name, **summary.to_dict()})
    output.say(str(summary))
    return ExitStatus.ANSWERED if summary.success else ExitStatus.MISSED


def _check_streams(robot: str, targets: str, to_file: str, as_json: bool) -> None:
    """Check the files, before a robot is loaded for them."""
    if robot == targets == "-":
        raise CommandError("the robot and the targets cannot both come from stdin")
    if to_file == "-" and as_json:
        raise CommandError("--json prints the summary to stdout, which --output - needs for the answers")
    if to_file != "-":
        check_file(Path(to_file).expanduser(), "--output")
    if targets != "-":
        try:
            if not Path(targets).expanduser().is_fifo():
                Path(targets).expanduser().open("rb").close()
        except OSError as error:
            raise CommandError(f"{targets}: cannot read the file: {output.reason_of(error)}") from None


def _say_what_is_kept(to_file: str) -> None:
    from ...scale.jobs.parts import parts_folder

    folder = parts_folder(Path(to_file).expanduser())
    if to_file != "-" and any(folder.glob("*.part")):
        output.say(f"finished chunks are kept in {folder}; the same command with --resume goes on with them")


def _lost(to_file: str, error: OSError) -> ExitStatus:
    """What follows when the answers cannot be written."""
    if to_file != "-":
        raise CommandError(f"--output {to_file}: cannot write it: {output.reason_of(error)}") from None
    output.stop_writing(error)
    return ExitStatus.ANSWERED  # nobody wanted to read the rest
