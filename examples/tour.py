"""A short tour: four problems on three robots, each solved by all four methods, and what each method answers."""

from __future__ import annotations

import itertools
import math
import sys
import time
from dataclasses import dataclass

import numpy as np
import pinocchio
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

import pinik

# Title → width: fits into 80 columns, and all tables line up.
COLUMNS = {
    "method": 6,
    "verdict": 14,
    "left [mm]": 9,
    "left [°]": 8,
    "iterations": 10,
    "restarts": 8,
    "time [ms]": 9,
}


@dataclass(frozen=True)
class Question:
    """A problem for a robot, in words and as targets."""

    words: str
    robot: pinik.Robot
    targets: list[pinik.Target]
    start: np.ndarray


def questions() -> list[Question]:
    """The four questions of the tour."""
    arm = pinik.load("arm")
    lion = pinik.load("lion", root="free_flyer")
    panda = pinik.load("panda")

    relaxed = lion.poses["relaxed"]
    ball = [1.2, 0.3, -0.4]
    standing = [
        pinik.Target(paw, lion.placement(paw, relaxed).translation)
        for paw in ("right_fore_paw", "left_hind_paw", "right_hind_paw")
    ]
    reaching = [pinik.Target("left_fore_paw", ball), pinik.Target("nose", axis="x", at=ball), *standing]

    return [
        Question("the tip to (0.6, 0.3, 0.7)", arm, [pinik.Target("tip", [0.6, 0.3, 0.7])], arm.poses["relaxed"]),
        Question(
            "left fore paw on a ball, nose pointing at the ball, the other paws in place", lion, reaching, relaxed
        ),
        Question(
            "the hand to (0.4, -0.3, 0.35), pointing straight down, rotated by 34°",
            panda,
            [pinik.Target("panda_hand_tcp", [0.4, -0.3, 0.35], rpy=[math.pi, 0.0, 0.6])],
            panda.poses["default"],
        ),
        Question(
            "the tip to (0.9, 0.9, 0.9), farther than the arm can reach",
            arm,
            [pinik.Target("tip", [0.9, 0.9, 0.9])],
            arm.poses["relaxed"],
        ),
    ]


def answers(question: Question) -> list[pinik.Solution]:
    """The answer of every method."""
    return [question.robot.solve(question.targets, method=name, q0=question.start) for name in pinik.SOLVERS]


def show(question: Question, solutions: list[pinik.Solution], console: Console) -> None:
    """Print a problem and its answers."""
    console.print(Text.assemble((question.robot.name, "bold cyan"), ": ", question.words))
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for title, width in COLUMNS.items():
        table.add_column(title, justify="left" if title in ("method", "verdict") else "right", min_width=width)
    for solution in solutions:
        verdict = Text(solution.status.name.lower().replace("_", " "), style="green" if solution else "yellow")
        table.add_row(
            solution.method,
            verdict,
            "" if solution.position_error is None else f"{1e3 * solution.position_error:.3f}",
            "" if solution.orientation_error is None else f"{math.degrees(solution.orientation_error):.3f}",
            str(solution.iterations),
            str(solution.restarts),
            f"{1e3 * solution.time:.3f}",
        )
    console.print(Padding.indent(table, 2))
    missed = [solution for solution in solutions if not solution]
    for message, same in itertools.groupby(missed, key=lambda solution: solution.message):
        names = ", ".join(solution.method for solution in same)
        console.print(Padding.indent(Text.assemble((f"{names}: ", "yellow"), message), 2))
    console.print()


def main() -> None:
    """Run the tour."""
    sys.stdout.reconfigure(errors="replace")
    console = Console(highlight=False, markup=False)
    if not console.is_terminal:
        console.width = 240  # keeps each row on one line for a program that reads it
    began = time.perf_counter()
    console.print(f"pinik {pinik.__version__} on Pinocchio {pinocchio.__version__}\n")
    asked = questions()
    for question in asked:
        show(question, answers(question), console)
    console.print(
        f"{len(asked)} problems, {len(pinik.SOLVERS)} methods, {time.perf_counter() - began:.1f} s including loading."
    )


if __name__ == "__main__":
    main()
