"""What `pinik accuracy` prints: its JSON object, and its tables."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ...robot import Robot
from ...solvers.base import Solver
from ...solving.solution import Solution
from ...studies.accuracy import CASES, Cost, Problem, asked_of
from ...studies.chain import TIP, length_of
from ...studies.spread import FIRMEST, Spread
from ...studies.straight_arm import Pull
from ..terminal import output
from ..terminal.tables import emit_table
from .method_style import iteration_word

__all__ = ["accuracy_fields", "emit_accuracy"]

Fields = Mapping[str, Any]


def accuracy_fields(
    chain: Robot,
    solvers: Mapping[str, Solver],
    settings: Fields,
    asked: Mapping[str, Sequence[Problem]],
    costs: Sequence[Cost],
    pulls: Sequence[Pull],
    spreads: Sequence[Spread],
    engine: str,
) -> dict[str, Any]:
    """The JSON object; docs/json.md explains its fields.

    Args:
        chain: The planar chain.
        solvers: Short name → method.
        settings: The fields "edge", "problems" and "seed".
        asked: Case → problems.
        costs: What each digit cost.
        pulls: The straight arm, by each method.
        spreads: How each method spreads the motion, without and with weights.
        engine: The engine that solves the examples.
    """
    return {
        "schema": 1,
        "robot": chain.name,
        "joints": len(chain.joint_names),
        "length_m": length_of(chain),
        **settings,
        "parameters": {name: dict(solver.parameters) for name, solver in solvers.items()},
        "rows": [_cost_fields(cost, length_of(chain)) for cost in costs],
        "examples": [_example(chain, solvers, own[0], engine) for own in asked.values()],
        "straight": [_pull_fields(chain, pull) for pull in pulls],
        "spread": [_spread_fields(own) for own in spreads],
    }


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
    """The positions of the chain's joints and its tip in the plane."""
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


def emit_accuracy(answer: Fields) -> None:
    """Write the tables to stdout.

    Args:
        answer: What `accuracy_fields` returned.
    """
    measured = "one problem" if answer["problems"] == 1 else f"medians of {answer['problems']} problems"
    output.emit(
        f"{answer['robot']}: {answer['joints']} hinges in a plane, {answer['length_m']:g} m, no limits, no restarts; "
        f"{measured}"
    )
    output.emit("")
    _emit_costs(answer)
    _emit_pulls(answer)
    _emit_spreads(answer)


def _emit_costs(answer: Fields) -> None:
    digits = sorted({row["digits"] for row in answer["rows"]})
    titles = ("target", "method", "", *(f"10^-{number}" for number in digits))
    lines = []
    for case in CASES:
        for method in answer["parameters"]:
            own = [row for row in answer["rows"] if (row["case"], row["method"]) == (case, method)]
            lines.append((case, method, iteration_word(method), *map(_count, own)))
            lines.append(("", "", "µs", *map(_microseconds, own)))
            if any(row["solved"] < 1.0 for row in own):
                lines.append(("", "", "solved", *(f"{100.0 * row['solved']:.0f} %" for row in own)))
    emit_table(titles, lines, numeric=set(titles[3:]))
    _emit_paragraph(
        f"near: half the chain's length from its base; edge: {100.0 * answer['edge']:g} % of it. 10^-d: the tip is "
        "within 10^-d of the chain's length. A dash: no problem was solved."
    )


def _emit_pulls(answer: Fields) -> None:
    emit_table(
        ("target on the arm's line", "method", "alone", "error m", "steps", "with restarts", "error m", "restarts"),
        [_pull_texts(pull) for pull in answer["straight"]],
        numeric={"error m", "steps", "restarts"},
    )
    _emit_paragraph(
        "The straight arm pulled inwards (fig. 4.2). Alone, a method starts from the straight arm, where Jᵀe = 0; "
        "pinik.solve restarts from other configurations."
    )


def _emit_spreads(answer: Fields) -> None:
    names = tuple(f"joint{number}" for number in range(1, answer["joints"] + 1))
    emit_table(
        ("method", "stiffness", "solved", *names, "moving joints", "turned rad"),
        [_spread_texts(own, answer["joints"]) for own in answer["spread"]],
        numeric={"solved", *names, "moving joints", "turned rad"},
    )
    _emit_paragraph(
        "Each joint's mean share of the motion in %, base first, when the tip is dragged aside by a fifth of the "
        f"chain's length. weighted: the stiffness weights fall from 1 at the base to {FIRMEST:g} at the tip. moving "
        "joints: how many joints move in effect, 1 / sum of squared shares.",
        last=True,
    )


def _emit_paragraph(words: str, *, last: bool = False) -> None:
    output.emit("")
    output.emit(textwrap.fill(words, 100))
    if not last:
        output.emit("")


def _count(row: Fields) -> str:
    return "-" if row["iterations"] is None else f"{row['iterations']:.0f}"


def _microseconds(row: Fields) -> str:
    return "-" if row["time_s"] is None else f"{1e6 * row['time_s']:.1f}"


def _pull_texts(pull: Fields) -> Sequence[str]:
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


def _spread_texts(own: Fields, joints: int) -> Sequence[str]:
    start = (own["method"], "weighted" if own["stiffness"] else "none", f"{100.0 * own['solved']:.0f} %")
    if own["shares"] is None:
        return (*start, *["-"] * (joints + 2))
    shares = [f"{100.0 * share:.0f}" for share in own["shares"]]
    return (*start, *shares, f"{own['moving_joints']:.1f}", f"{own['turned_rad']:.2f}")
