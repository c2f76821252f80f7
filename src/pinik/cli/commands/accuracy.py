"""`pinik accuracy`: Welman's figures 4.2, 4.4 and 4.5, and how evenly the methods spread the motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from ...checks import as_count
from ...errors import InputError
from ...solvers.base import Solver
from ...solvers.registry import SOLVERS
from ...studies.accuracy import CASES, problems
from ...studies.accuracy import accuracy as run_accuracy
from ...studies.chain import planar_chain
from ...studies.spread import drags, firmer_towards_the_tip, spread
from ...studies.straight_arm import pull_inwards
from ..inputs.assignments import solvers_with
from ..inputs.options import AsJson, Engine, MethodParameters
from ..reports.accuracy_plots import draw_accuracy, draw_spread, draw_straight_arm
from ..reports.accuracy_report import accuracy_fields, emit_accuracy
from ..reports.plots import check_plot, save_plot
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.progress import progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["accuracy"]

_MOST_JOINTS = 50
_MOST_DIGITS = 10
_REPEATS = 3
_DRAGS = 200


class _Plot(NamedTuple):
    option: str
    path: Path
    draw: Callable[[Mapping[str, Any]], Figure]


def accuracy(
    joints: Annotated[int, typer.Option(metavar="N", help="Number of hinges, and of equal links.")] = 7,
    digits: Annotated[int, typer.Option(metavar="N", help="Measure from 1 to this number of digits.")] = 8,
    edge: Annotated[
        float, typer.Option(metavar="PART", help="Distance of the far target, as a part of the chain's length.")
    ] = 0.999,
    count: Annotated[
        int, typer.Option("--problems", metavar="N", help="Number of near and of far problems; medians are shown.")
    ] = 11,
    seed: Annotated[int, typer.Option(metavar="N", help="The seed of the random problems.")] = 0,
    param: MethodParameters = None,
    engine: Engine = "auto",
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw figs. 4.4 and 4.5 into this file (.png, .svg, .pdf).")
    ] = None,
    plot_straight: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw fig. 4.2, the straight arm pulled inwards.")
    ] = None,
    plot_spread: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw how evenly the methods spread the motion.")
    ] = None,
    as_json: AsJson = False,
) -> ExitStatus:
    """Measure what each digit of accuracy costs, as in Welman's figures 4.4 and 4.5.

    The robot is a planar chain of equal links without joint limits, and the
    methods run without restarts. Targets lie half the chain's length away (near)
    or at the edge of reach, and must be met to 1, 2, … digits of that length.

    The command also pulls a straight arm inwards (fig. 4.2) and measures each
    joint's share of the motion (§4.3).

    Examples:

      pinik accuracy --digits 4 --problems 3
      pinik accuracy --problems 2 --joints 4 --edge 0.99 --json
      pinik accuracy --problems 1 --digits 3 --param jt.alpha=0.1
    """
    solvers = _solvers(param)
    as_count(joints, "--joints", least=2, most=_MOST_JOINTS)
    as_count(digits, "--digits", most=_MOST_DIGITS)
    as_count(count, "--problems")
    as_count(seed, "--seed", least=0)
    plots = _checked_plots(plot, plot_straight, plot_spread)
    answer = _measured(solvers, joints, digits, edge, count, seed, engine)
    if as_json:
        output.emit_json(answer)
    else:
        emit_accuracy(answer)
    for option, path, draw in plots:
        save_plot(draw(answer), path, option)
    return ExitStatus.ANSWERED


def _solvers(param: list[str] | None) -> dict[str, Solver]:
    """Every registered method that fits any robot, with the parameters given."""
    solvers = solvers_with({name: solver() for name, solver in SOLVERS.items()}, param)
    for name, solver in solvers.items():
        if solver.parameters.get("stiffness"):
            raise InputError(
                f"--param {name}.stiffness cannot be set, as the command compares methods with weights of its own"
            )
    return solvers


def _checked_plots(accuracy: Path | None, straight: Path | None, spread: Path | None) -> list[_Plot]:
    """The pictures to draw; an error now is better than after minutes of computing."""
    drawings = (
        ("--plot", accuracy, draw_accuracy),
        ("--plot-straight", straight, draw_straight_arm),
        ("--plot-spread", spread, draw_spread),
    )
    plots = [_Plot(option, path, draw) for option, path, draw in drawings if path is not None]
    if len({plot.path.resolve() for plot in plots}) < len(plots):
        raise InputError("each picture needs a file of its own")
    for plot in plots:
        check_plot(plot.path, plot.option)
    return plots


def _measured(
    solvers: Mapping[str, Solver], joints: int, digits: int, edge: float, count: int, seed: int, engine: str
) -> dict[str, Any]:
    """All measurements, as `--json` prints them."""
    chain = planar_chain(joints)
    asked = {case: problems(chain, case, count, edge=edge, seed=seed) for case in CASES}
    with progress(f"{chain.name}, {digits} digits", len(CASES) * len(solvers) * digits) as tick:
        numbers = range(1, digits + 1)
        costs = list(run_accuracy(chain, solvers, asked, numbers, repeats=_REPEATS, engine=engine, progress=tick))
    dragged = drags(chain, _DRAGS, seed)
    spreads = [
        spread(chain, solver, dragged, weights, engine)
        for weights in ({}, firmer_towards_the_tip(chain))
        for solver in solvers.values()
        if not weights or "stiffness" in solver.parameters
    ]
    settings = {"edge": edge, "problems": count, "seed": seed}
    return accuracy_fields(
        chain, solvers, settings, asked, costs, pull_inwards(chain, solvers, engine), spreads, engine
    )
