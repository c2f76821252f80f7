"""`pinik compare`: the thesis's Table 4.1 on any robot."""

from __future__ import annotations

import dataclasses
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import EngineError, InputError, UnknownNameError
from ...motion.effectors import principal_frames
from ...robot import Robot
from ...solving.options import ENGINES, as_count
from ...studies.comparison import COMPARISONS, CURVE, Row
from ...studies.comparison import compare as run_comparisons
from ...studies.thesis import METHODS, PRESETS, Contest, Mismatch, contest, mismatch, published
from ..inputs.assignments import solvers_with
from ..inputs.loading import load_robot
from ..inputs.options import AsJson, MethodParameters, PackageDirs
from ..reports.comparison_plot import draw_comparison
from ..reports.plots import check_plot, save_plot
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.progress import progress
from ..terminal.tables import emit_table

__all__ = ["EPILOG", "compare"]

EPILOG = "\n\n".join(
    ["[bold]Readings[/bold]"]
    + [f"{preset}, {name}: {about}" for preset, readings in PRESETS.items() for name, about in readings.items()]
)


def compare(
    preset: Annotated[
        str,
        typer.Option(metavar="thesis|tuned", help="The thesis's parameters, or pinik's."),
    ] = "tuned",
    reading: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="How they are read, see below.", show_default="literal, or defaults"),
    ] = None,
    robot: Annotated[
        str, typer.Option(metavar="ROBOT", help="A name of the catalogue or the path of a URDF file.")
    ] = "arm",
    frame: Annotated[
        str | None,
        typer.Option(metavar="F", help="The frame that chases the ball.", show_default="the robot's foremost end"),
    ] = None,
    steps: Annotated[int, typer.Option(metavar="N", help="Steps of each method in each comparison.")] = 1000,
    pieces: Annotated[
        int, typer.Option(metavar="N", help="Move the ball from place to place in so many pieces, each solved.")
    ] = 1,
    seed: Annotated[int, typer.Option(metavar="N", help="Of the random places.")] = 0,
    param: MethodParameters = None,
    engine: Annotated[
        str, typer.Option(metavar="auto|python|native", help="Which engine computes; preset thesis is Python.")
    ] = "auto",
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw grouped bars into this file (.png, .svg, .pdf).")
    ] = None,
    package_dir: PackageDirs = None,
    as_json: AsJson = False,
) -> ExitStatus:
    """Compare the four methods as Table 4.1 of the thesis does, with its own figures beside.

    One ball for all, on a curve (1, 3) or at random places (2, 4), joint limits off (1, 2) or on (3, 4). Each method
    starts each step where its last one ended. 2b and 4b draw from a box, of which a part lies out of reach.

    Examples:

      pinik compare --steps 20
      pinik compare --preset thesis --reading bones --steps 3
      pinik compare --robot panda --steps 5 --json
    """
    count, pieces = as_count(steps, "--steps"), as_count(pieces, "--pieces")
    as_count(seed, "--seed", least=0)
    if plot is not None:
        check_plot(plot)
    machine = load_robot(robot, package_dirs=package_dir)
    chosen = contest(machine, frame or principal_frames(machine)[0], preset, reading, pieces)
    _check_engine(engine, chosen)
    if param and not chosen.solvers:
        raise InputError(f"the reading {chosen.reading!r} is the thesis's own program; --param changes pinik's methods")
    chosen = dataclasses.replace(chosen, solvers=solvers_with(chosen.solvers, param))
    with progress(f"{preset}, {chosen.reading}", count * len(METHODS) * len(COMPARISONS)) as tick:
        rows = list(
            run_comparisons(
                machine,
                chosen.frame,
                METHODS,
                lambda method, comparison, start: chosen.begin(method, comparison, start, engine),
                chosen.rules,
                steps=count,
                seed=seed,
                progress=tick,
            )
        )
    answer = _fields(machine, chosen, rows, count, seed)
    if as_json:
        output.emit_json(answer)
    else:
        _emit(answer)
    if plot is not None:
        save_plot(draw_comparison(answer), plot)
    return ExitStatus.ANSWERED


def _check_engine(engine: str, chosen: Contest) -> None:
    if engine not in ENGINES:
        raise UnknownNameError("engine", engine, ENGINES)
    if chosen.rules.bare and engine == "native":
        raise EngineError("preset thesis runs the thesis's own loop, which is Python; --preset tuned can be native")


def _fields(robot: Robot, chosen: Contest, rows: Sequence[Row], steps: int, seed: int) -> dict[str, Any]:
    return {
        "schema": 1,
        "robot": robot.name,
        "frame": chosen.frame,
        "preset": chosen.preset,
        "reading": chosen.reading,
        "about": PRESETS[chosen.preset][chosen.reading],
        "steps": steps,
        "seed": seed,
        "pieces": chosen.rules.pieces,
        "rest_steps": chosen.rules.rest,
        "curve": CURVE,
        "steps_a_lap": chosen.rules.lap,
        "bones": chosen.bones,
        "joints": chosen.joints,
        "chain_length_m": chosen.chain_length,
        "unit_m": chosen.unit,
        "tolerance_m": chosen.rules.tolerance.position,
        "max_iterations": chosen.rules.max_iterations,
        "restarts": chosen.rules.restarts,
        "parameters": {name: dict(solver.parameters) for name, solver in chosen.solvers.items()},
        "rows": [_row_fields(row) for row in rows],
        "mismatch": _mismatch_fields(mismatch(rows)),
        "mismatch_in_box": _mismatch_fields(mismatch(rows, box=True)),
    }


def _mismatch_fields(off: Mismatch | None) -> dict[str, float] | None:
    return None if off is None else {"efficiency_points": off.efficiency, "iterations_factor": off.iterations}


def _row_fields(row: Row) -> dict[str, Any]:
    cell = published(row)
    theirs = None
    if cell is not None:
        theirs = {"time_s": cell.time, "iterations": cell.iterations, "efficiency": cell.efficiency}
    return {
        "comparison": row.comparison.name,
        "motion": row.comparison.motion,
        "limits": row.comparison.limits,
        "method": row.method,
        "engine": row.engine,
        "time_s": row.time,
        "iterations": row.iterations,
        "joint_updates": row.joint_updates,
        "counted_iterations": row.counted,
        "efficiency": row.efficiency,
        "error_m": row.error,
        "largest_error_m": row.largest_error,
        "jump": row.jump,
        "largest_jump": row.largest_jump,
        "thesis": theirs,
        "time_of_thesis": None if cell is None else row.time / cell.time,
    }


_NOTES = (
    "Means over the steps. N counts as the thesis does: bones turned for ccd, whole steps for the others, 1 at "
    "least; steps are "
    "sweeps for ccd, joints its single joints. jump: a step's largest change of one joint (rad, or m where it slides). "
    "time %: of the thesis's time, on another machine. b: places in a box, some out of reach; the thesis says neither "
    "that its places can be reached nor that they cannot."
)
_TITLES = (
    "", "ball", "limits", "method", "ms", "N", "steps", "joints", "η %", "error mm", "jump", "largest",
    "thesis ms", "its N", "its η %", "time %",
)  # fmt: skip


def _emit(answer: dict[str, Any]) -> None:
    output.emit(
        f"{answer['robot']}, {answer['frame']}: preset {answer['preset']}, reading {answer['reading']}: "
        f"{answer['about']}"
    )
    output.emit(
        f"{answer['steps']} steps a row; reached at {1000 * answer['tolerance_m']:.3g} mm; "
        f"{answer['bones']} bones, {answer['joints']} joints, {answer['chain_length_m']:.3g} m; "
        f"one of the thesis's units is {answer['unit_m']:.3g} m"
    )
    output.emit("")
    numeric = {title for title in _TITLES if title not in ("", "ball", "limits", "method")}
    emit_table(_TITLES, [_texts(row) for row in answer["rows"]], numeric=numeric)
    output.emit("")
    output.emit(textwrap.fill(_NOTES, 100))
    if answer["preset"] == "thesis":
        for key, words in (("mismatch", "1 to 4"), ("mismatch_in_box", "1, 2b, 3, 4b")):
            if (off := answer[key]) is not None:
                output.emit(
                    f"Off the thesis's table with {words}: {off['efficiency_points']:.0f} points of efficiency, a "
                    f"factor {off['iterations_factor']:.1f} of iterations, on average."
                )


def _texts(row: dict[str, Any]) -> tuple[str, ...]:
    cell = row["thesis"]
    theirs = ("", "", "", "")
    if cell is not None:
        theirs = (
            f"{1000 * cell['time_s']:.1f}",
            f"{cell['iterations']:.0f}",
            f"{100 * cell['efficiency']:.0f}",
            f"{100 * row['time_of_thesis']:.2f}",
        )
    return (
        row["comparison"],
        row["motion"],
        "on" if row["limits"] else "off",
        row["method"],
        f"{1000 * row['time_s']:.4f}",
        f"{row['counted_iterations']:.1f}",
        f"{row['iterations']:.1f}",
        f"{row['joint_updates']:.1f}" if row["method"] == "ccd" else "",
        f"{100 * row['efficiency']:.1f}",
        f"{1000 * row['error_m']:.3f}",
        f"{row['jump']:.2f}",
        f"{row['largest_jump']:.2f}",
        *theirs,
    )
