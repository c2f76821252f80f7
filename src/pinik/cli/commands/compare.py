"""`pinik compare`: the thesis's Table 4.1 on any robot."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated

import typer

from ...checks import as_count
from ...errors import EngineError, InputError, UnknownNameError
from ...motion.effectors import principal_frames
from ...solving.options import ENGINES
from ...studies.comparison import COMPARISONS, Row
from ...studies.comparison import compare as run_comparisons
from ...studies.thesis import PRESETS, Contest, contest
from ..inputs.assignments import solvers_with
from ..inputs.loading import load_robot
from ..inputs.options import AllowOutside, AsJson, MethodParameters, PackageDirs, XacroArgs
from ..reports.comparison_plot import draw_comparison
from ..reports.comparison_report import comparison_fields, emit_comparison
from ..reports.plots import check_plot, save_plot
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.progress import progress

__all__ = ["EPILOG", "compare"]

EPILOG = "\n\n".join(
    ["[bold]Readings[/bold]"]
    + [f"{preset}, {name}: {about}" for preset, readings in PRESETS.items() for name, about in readings.items()]
)


def compare(
    preset: Annotated[
        str,
        typer.Option(metavar="thesis|tuned", help="Use the parameters of the thesis, or pinik's defaults."),
    ] = "tuned",
    reading: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="How to read the preset; see the list below.", show_default="literal, or defaults"
        ),
    ] = None,
    robot: Annotated[
        str, typer.Option(metavar="ROBOT", help="A robot of the catalogue, or the path of a URDF file.")
    ] = "arm",
    frame: Annotated[
        str | None,
        typer.Option(metavar="F", help="The frame that chases the ball.", show_default="the robot's main end effector"),
    ] = None,
    steps: Annotated[int, typer.Option(metavar="N", help="Steps of each method in each comparison.")] = 1000,
    pieces: Annotated[
        int, typer.Option(metavar="N", help="Divide each move of the ball into N equal moves and solve each of them.")
    ] = 1,
    seed: Annotated[int, typer.Option(metavar="N", help="The seed of the random places.")] = 0,
    param: MethodParameters = None,
    engine: Annotated[
        str, typer.Option(metavar="auto|python|native", help="The engine to use; preset thesis needs Python.")
    ] = "auto",
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw grouped bars into this file (.png, .svg, .pdf).")
    ] = None,
    package_dir: PackageDirs = None,
    xacro_arg: XacroArgs = None,
    allow_outside: AllowOutside = False,
    as_json: AsJson = False,
) -> ExitStatus:
    """Compare the methods as Table 4.1 of the thesis does, next to the figures of the thesis.

    All methods chase the same ball, on a curve (1, 3) or at random places
    (2, 4), with joint limits off (1, 2) or on (3, 4). Each step starts where the
    last one ended. In 2b and 4b the places come from a box, partly out of reach.

    Examples:

      pinik compare --steps 20
      pinik compare --preset thesis --reading bones --steps 3
      pinik compare --robot panda --steps 5 --json
    """
    _check_options(steps, pieces, seed, plot)
    machine = load_robot(robot, package_dirs=package_dir, xacro_args=xacro_arg, allow_outside=allow_outside)
    chosen = contest(machine, frame or principal_frames(machine)[0], preset, reading, pieces)
    _check_engine(engine, chosen)
    chosen = _with_parameters(chosen, param)
    answer = comparison_fields(machine, chosen, _rows(chosen, engine, steps, seed), steps, seed)
    emit = output.emit_json if as_json else emit_comparison
    emit(answer)
    if plot is not None:
        save_plot(draw_comparison(answer), plot)
    return ExitStatus.ANSWERED


def _check_options(steps: int, pieces: int, seed: int, plot: Path | None) -> None:
    as_count(steps, "--steps")
    as_count(pieces, "--pieces")
    as_count(seed, "--seed", least=0)
    if plot is not None:
        check_plot(plot)


def _check_engine(engine: str, chosen: Contest) -> None:
    if engine not in ENGINES:
        raise UnknownNameError("engine", engine, ENGINES)
    if chosen.rules.bare and engine == "native":
        raise EngineError("preset thesis runs the thesis's own loop, which is in Python; use --preset tuned for native")


def _with_parameters(chosen: Contest, param: list[str] | None) -> Contest:
    if param and not chosen.solvers:
        raise InputError(f"--param cannot be used with reading {chosen.reading!r}, which runs the thesis's own program")
    return dataclasses.replace(chosen, solvers=solvers_with(chosen.solvers, param))


def _rows(chosen: Contest, engine: str, steps: int, seed: int) -> list[Row]:
    """All comparisons, with a progress bar."""
    total = steps * len(chosen.methods) * len(COMPARISONS)
    with progress(f"{chosen.preset}, {chosen.reading}", total) as tick:
        return list(
            run_comparisons(
                chosen.robot,
                chosen.frame,
                chosen.methods,
                lambda method, comparison, start: chosen.begin(method, comparison, start, engine),
                chosen.rules,
                steps=steps,
                seed=seed,
                progress=tick,
            )
        )
