"""`pinik accuracy`: Welman's figures 4.2, 4.4 and 4.5, and how evenly the methods spread the motion."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import InputError
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.registry import SOLVERS
from ...solving.options import as_count
from ...solving.solution import Solution
from ...studies.accuracy import CASES, Cost, Problem, asked_of, problems
from ...studies.accuracy import accuracy as run_accuracy
from ...studies.chain import TIP, length_of, planar_chain
from ...studies.spread import FIRMEST, Spread, drags, firmer_towards_the_tip, spread
from ...studies.straight_arm import Pull, pull_inwards
from ..inputs.assignments import solvers_with
from ..inputs.options import AsJson, MethodParameters
from ..reports.accuracy_plots import draw_accuracy, draw_spread, draw_straight_arm
from ..reports.plots import check_plot, save_plot
from ..terminal import output
from ..terminal.exits import ExitStatus
from ..terminal.progress import progress
from ..terminal.tables import emit_table

__all__ = ["accuracy"]

_MOST_JOINTS = 50
_MOST_DIGITS = 10
_REPEATS = 3
_DRAGS = 200


def accuracy(
    joints: Annotated[int, typer.Option(metavar="N", help="Hinges of the chain, and equal links.")] = 7,
    digits: Annotated[int, typer.Option(metavar="N", help="The most digits asked for; from 1 on.")] = 8,
    edge: Annotated[
        float, typer.Option(metavar="PART", help="How far out the target at the edge lies, of the chain's length.")
    ] = 0.999,
    count: Annotated[
        int, typer.Option("--problems", metavar="N", help="Problems near and at the edge; the medians are told.")
    ] = 11,
    seed: Annotated[int, typer.Option(metavar="N", help="Of the random problems.")] = 0,
    param: MethodParameters = None,
    engine: Annotated[str, typer.Option(metavar="auto|python|native", help="Which engine computes.")] = "auto",
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
    """Measure what every digit of accuracy costs, as Welman's figures 4.4 and 4.5 do.

    A chain of equal links in a plane, without limits; bare methods, without restarts. Its tip is asked for a place
    half the chain's length away (near) and for one at the edge of reach, to 1, 2, … digits of that length. Then a
    straight arm is pulled inwards (fig. 4.2), and each joint's share of the motion is measured (§4.3).

    Examples:

      pinik accuracy --digits 4 --problems 3
      pinik accuracy --problems 2 --joints 4 --edge 0.99 --json
      pinik accuracy --problems 1 --digits 3 --param jt.alpha=0.1
    """
    solvers = solvers_with({name: solver() for name, solver in SOLVERS.items()}, param)
    as_count(joints, "--joints", least=2)
    as_count(digits, "--digits")
    if joints > _MOST_JOINTS or digits > _MOST_DIGITS:
        raise InputError(f"--joints is at most {_MOST_JOINTS}, --digits at most {_MOST_DIGITS}")
    as_count(count, "--problems")
    as_count(seed, "--seed", least=0)
    drawings = (
        ("--plot", plot, draw_accuracy),
        ("--plot-straight", plot_straight, draw_straight_arm),
        ("--plot-spread", plot_spread, draw_spread),
    )
    asked_for = [path.resolve() for _, path, _ in drawings if path is not None]
    if len(set(asked_for)) < len(asked_for):
        raise InputError("two pictures cannot be written to one file")
    for option, path, _ in drawings:
        if path is not None:
            check_plot(path, option)
    for name, solver in solvers.items():
        if solver.parameters["stiffness"]:
            raise InputError(f"--param {name}.stiffness: here the weights are what is compared; the command sets them")
    chain = planar_chain(joints)
    asked = {case: problems(chain, case, count, edge=edge, seed=seed) for case in CASES}
    with progress(f"{chain.name}, {digits} digits", len(CASES) * len(solvers) * digits) as tick:
        costs = list(
            run_accuracy(chain, solvers, asked, range(1, digits + 1), repeats=_REPEATS, engine=engine, progress=tick)
        )
    dragged = drags(chain, _DRAGS, seed)
    answer = {
        "schema": 1,
        "robot": chain.name,
        "joints": joints,
        "length_m": length_of(chain),
        "edge": edge,
        "problems": count,
        "seed": seed,
        "parameters": {name: dict(solver.parameters) for name, solver in solvers.items()},
        "rows": [_cost_fields(cost, length_of(chain)) for cost in costs],
        "examples": [_example(chain, solvers, own[0], engine) for own in asked.values()],
        "straight": [_pull_fields(chain, pull) for pull in pull_inwards(chain, solvers, engine)],
        "spread": [
            _spread_fields(spread(chain, solver, dragged, weights, engine))
            for weights in ({}, firmer_towards_the_tip(chain))
            for solver in solvers.values()
        ],
    }
    if as_json:
        output.emit_json(answer)
    else:
        _emit(answer)
    for option, path, draw in drawings:
        if path is not None:
            save_plot(draw(answer), path, option)
    return ExitStatus.ANSWERED


def _cost_fields(cost: Cost, length: float) -> dict[str, Any]:
    return {
        "case": cost.case,
        "method": cost.method,
        "engine": cost.engine,
        "digits": cost.digits,
        "tolerance_m": length * 10.0**-cost.digits,
        "solved": cost.solved,
        "time_s": cost.time,
        "iterations": cost.iterations,
        "joint_updates": cost.joint_updates,
        "most_iterations": cost.most_iterations,
    }


def _example(chain: Robot, solvers: Mapping[str, Solver], problem: Problem, engine: str) -> dict[str, Any]:
    answers = {
        name: asked_of(chain, solver, engine=engine)(problem.place, problem.start) for name, solver in solvers.items()
    }
    return {
        "case": problem.case,
        "position": problem.place.tolist(),
        "start": _outline(chain, problem.start),
        "answers": {name: _outline(chain, answer.q) for name, answer in answers.items()},
    }


def _outline(chain: Robot, q: Any) -> list[list[float]]:
    """The chain's joints and its tip in the plane."""
    frames = [*(f"link{number}" for number in range(1, len(chain.joint_names) + 1)), TIP]
    return [chain.placement(frame, q).translation[:2].tolist() for frame in frames]


def _pull_fields(chain: Robot, pull: Pull) -> dict[str, Any]:
    return {
        "method": pull.method,
        "place": pull.place,
        "alone": _answer_fields(chain, pull.alone),
        "restarted": _answer_fields(chain, pull.restarted),
    }


def _answer_fields(chain: Robot, solution: Solution) -> dict[str, Any]:
    return {
        "status": solution.status.name,
        "position_error_m": solution.position_error,
        "iterations": solution.iterations,
        "restarts": solution.restarts,
        "outline": _outline(chain, solution.q),
    }


def _spread_fields(own: Spread) -> dict[str, Any]:
    return {
        "method": own.method,
        "stiffness": own.stiffness,
        "solved": own.solved,
        "shares": None if own.shares is None else own.shares.tolist(),
        "moving_joints": own.moving_joints,
        "turned_rad": own.turned,
    }


def _emit(answer: Mapping[str, Any]) -> None:
    told = "one problem" if answer["problems"] == 1 else f"medians of {answer['problems']} problems"
    output.emit(
        f"{answer['robot']}: {answer['joints']} hinges in a plane, {answer['length_m']:g} m, no limits, no restarts; "
        f"{told}"
    )
    digits = sorted({row["digits"] for row in answer["rows"]})
    titles = ("target", "method", "", *(f"10^-{number}" for number in digits))
    lines = []
    for case in CASES:
        for method in answer["parameters"]:
            own = [row for row in answer["rows"] if (row["case"], row["method"]) == (case, method)]
            lines.append((case, method, "sweeps" if method == "ccd" else "steps", *map(_count, own)))
            lines.append(("", "", "µs", *map(_microseconds, own)))
            if any(row["solved"] < 1.0 for row in own):
                lines.append(("", "", "solved", *(f"{100.0 * row['solved']:.0f} %" for row in own)))
    output.emit("")
    emit_table(titles, lines, numeric=set(titles[3:]))
    _emit_paragraph(
        f"near: half the chain's length away; edge: {100.0 * answer['edge']:g} % of it. 10^-d: reached within 10^-d of "
        "the chain's length. A dash: none was solved."
    )
    emit_table(
        ("target on the arm's line", "method", "alone", "off by m", "steps", "with restarts", "off by m", "restarts"),
        [_pull_texts(pull) for pull in answer["straight"]],
        numeric={"off by m", "steps", "restarts"},
    )
    _emit_paragraph(
        "The straight arm pulled inwards (fig. 4.2): alone a method starts from it and sees Jᵀe = 0; pinik.solve "
        "begins anew elsewhere."
    )
    names = tuple(f"joint{number}" for number in range(1, answer["joints"] + 1))
    emit_table(
        ("method", "stiffness", "solved", *names, "moving joints", "turned rad"),
        [_spread_texts(own, answer["joints"]) for own in answer["spread"]],
        numeric={"solved", *names, "moving joints", "turned rad"},
    )
    _emit_paragraph(
        f"Each joint's share of the motion in %, base first, when the tip is dragged a fifth of the chain's length "
        f"aside; mean of {_DRAGS}. weighted: w from 1 at the base to {FIRMEST:g} at the tip. moving joints: how many "
        "turn, 1 / sum of squared shares.",
        last=True,
    )


def _emit_paragraph(words: str, *, last: bool = False) -> None:
    output.emit("")
    output.emit(textwrap.fill(words, 100))
    if not last:
        output.emit("")


def _count(row: Mapping[str, Any]) -> str:
    return "-" if row["iterations"] is None else f"{row['iterations']:.0f}"


def _microseconds(row: Mapping[str, Any]) -> str:
    return "-" if row["time_s"] is None else f"{1e6 * row['time_s']:.1f}"


def _pull_texts(pull: Mapping[str, Any]) -> Sequence[str]:
    alone, restarted = pull["alone"], pull["restarted"]
    return (
        f"{100.0 * pull['place']:.0f} % of its length",
        pull["method"],
        alone["status"],
        f"{alone['position_error_m']:.1e}",
        str(alone["iterations"]),
        restarted["status"],
        f"{restarted['position_error_m']:.1e}",
        str(restarted["restarts"]),
    )


def _spread_texts(own: Mapping[str, Any], joints: int) -> Sequence[str]:
    start = (own["method"], "weighted" if own["stiffness"] else "none", f"{100.0 * own['solved']:.0f} %")
    if own["shares"] is None:
        return (*start, *["-"] * (joints + 2))
    shares = [f"{100.0 * share:.0f}" for share in own["shares"]]
    return (*start, *shares, f"{own['moving_joints']:.1f}", f"{own['turned_rad']:.2f}")
