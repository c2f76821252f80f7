"""Welman's figures 4.4 and 4.5: what each digit of accuracy costs, well within reach and at the edge of reach."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..problem.targets import Target
from ..robot import Robot
from ..solvers.base import Solver
from ..solving.front import prepare
from ..solving.prepared import Prepared
from ..solving.solution import Solution
from .chain import TIP, length_of

__all__ = ["CASES", "EDGE", "NEAR", "Cost", "Problem", "accuracy", "asked_of", "problems", "random_bends"]

Array = NDArray[np.float64]

NEAR, EDGE = "near", "edge"
CASES = (NEAR, EDGE)

_MOST_ITERATIONS = 1_000_000
_SLOW = 0.2  # seconds: problems that take longer are solved only once
_HALFWAY = 0.5  # of the chain's length: the distance of a near target
_FIRST_BEND = 0.3  # of each joint [rad], in the first problem, which the pictures show
_FIRST_DIRECTION = 0.5  # of the first target, seen from the base [rad]
_BENDS = 0.6  # the largest bend in the other problems [rad]


class Problem(NamedTuple):
    """A target position for the tip of the chain.

    Attributes:
        case: "near", well within reach, or "edge"; or "drag", a place next to the tip.
        start: The start configuration (nq,).
        place: The target position (3,) [m].
    """

    case: str
    start: Array
    place: Array


class Cost(NamedTuple):
    """The cost of a number of digits by one method: medians over the solved problems; None if it solved none.

    Attributes:
        case: "near" or "edge".
        method: The solver's short name.
        digits: d, for a tolerance of 10⁻ᵈ of the chain's length.
        engine: The engine used.
        solved: The share of solved problems, from 0 to 1.
        time: Seconds.
        iterations: Iterations; sweeps for CCD.
        joint_updates: Single joints updated, for CCD.
        most_iterations: The largest number of iterations.
    """

    case: str
    method: str
    digits: int
    engine: str
    solved: float
    time: float | None
    iterations: float | None
    joint_updates: float | None
    most_iterations: int | None


def problems(chain: Robot, case: str, count: int, *, edge: float = 0.999, seed: int = 0) -> list[Problem]:
    """Problems on a planar chain.

    The first, which the pictures show, starts from a gentle arc. The others start from random bends and have targets in
    random directions.

    Args:
        chain: From `planar_chain`.
        case: "near" for targets at half the chain's length from its base, "edge" for targets at the part `edge` of it.
        count: Number of problems.
        edge: From 0 to 1.
        seed: The seed of the random problems.
    """
    if not 0.0 < edge <= 1.0:
        raise InputError(f"must be above 0 and at most 1, a part of the chain's length; got {edge!r}", argument="edge")
    rng = np.random.default_rng([seed, CASES.index(case)])
    away = length_of(chain) * (_HALFWAY if case == NEAR else edge)
    made = []
    for number in range(count):
        start, angle = np.full(chain.model.nq, _FIRST_BEND), _FIRST_DIRECTION
        if number:
            start, angle = random_bends(chain, rng), rng.uniform(-np.pi, np.pi)
        made.append(Problem(case, start, away * np.array([np.cos(angle), np.sin(angle), 0.0])))
    return made


def random_bends(chain: Robot, rng: np.random.Generator) -> Array:
    """A random configuration (nq,) with small bends in both directions."""
    return np.asarray(rng.uniform(-_BENDS, _BENDS, chain.model.nq))


def asked_of(
    chain: Robot,
    solver: Solver,
    *,
    tolerance: float = 1e-4,
    max_iterations: int = _MOST_ITERATIONS,
    engine: str = "auto",
) -> Prepared:
    """The bare method for positions of the chain's tip: no restarts, no limits, iterations until it stalls.

    Args:
        chain: From `planar_chain`.
        solver: The method.
        tolerance: The largest error that counts as reached [m].
        max_iterations: The most iterations.
        engine: As for `pinik.solve`.
    """
    return prepare(
        chain,
        Target(TIP, np.zeros(3)),
        solver,
        limits=False,
        restarts=0,
        max_iterations=max_iterations,
        tolerance=(tolerance, 1.0),
        engine=engine,
        polish=False,
    )


def accuracy(
    chain: Robot,
    solvers: Mapping[str, Solver],
    asked: Mapping[str, Sequence[Problem]],
    digits: Sequence[int],
    *,
    repeats: int = 3,
    engine: str = "auto",
    progress: Callable[[], None] = lambda: None,
) -> Iterator[Cost]:
    """Measure the cost of every number of digits by every method.

    Args:
        chain: From `planar_chain`.
        solvers: Short name → method.
        asked: Case → problems.
        digits: The numbers of digits.
        repeats: How often each problem is solved; the fastest time counts. Slow problems are solved only once.
        engine: As for `pinik.solve`.
        progress: Called once for each cost.
    """
    scale = length_of(chain)
    for case, own in asked.items():
        for method, solver in solvers.items():
            solves = {
                number: asked_of(chain, solver, tolerance=scale * 10.0**-number, engine=engine) for number in digits
            }
            runs: dict[int, list[list[Solution]]] = {number: [[] for _ in own] for number in solves}
            for repeat in range(repeats):  # in turn, so that a slow moment of the machine affects all numbers of digits
                for number, solve in solves.items():
                    for problem, done in zip(own, runs[number], strict=True):
                        if repeat == 0 or done[0].time < _SLOW:
                            done.append(solve(problem.place, problem.start))
                    if repeat == 0:
                        progress()
            for number, solve in solves.items():
                yield _cost(case, method, number, solve.engine, runs[number])


def _cost(case: str, method: str, digits: int, engine: str, runs: Sequence[Sequence[Solution]]) -> Cost:
    solved = [run for run in runs if run[0].success]

    def median(of: Callable[[Sequence[Solution]], float]) -> float | None:
        return statistics.median(map(of, solved)) if solved else None

    return Cost(
        case,
        method,
        digits,
        engine,
        solved=len(solved) / len(runs),
        time=median(lambda run: min(solution.time for solution in run)),
        iterations=median(lambda run: run[0].iterations),
        joint_updates=median(lambda run: run[0].joint_updates),
        most_iterations=max((run[0].iterations for run in solved), default=None),
    )
