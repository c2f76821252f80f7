"""Welman's figs. 4.4 and 4.5: what each digit of accuracy costs, well within reach and at its edge."""

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
_SLOW = 0.2  # seconds: what takes longer is solved once
_HALFWAY = 0.5  # of the chain's length: where a near target lies
_FIRST_BEND = 0.3  # of each joint [rad], in the problem that pictures show
_FIRST_DIRECTION = 0.5  # of its target, seen from the base [rad]
_BENDS = 0.6  # the largest in the others [rad]


class Problem(NamedTuple):
    """A position asked of the chain's tip.

    Attributes:
        case: "near", well within reach, or "edge"; "drag", from where the tip is to a place beside it.
        start: Configuration (nq,).
        place: Where the tip should be (3,) [m].
    """

    case: str
    start: Array
    place: Array


class Cost(NamedTuple):
    """What a method spent on a number of digits; medians over the problems that it solved, None where it solved none.

    Attributes:
        case: "near" or "edge".
        method: The solver's short name.
        digits: d, for a tip within 10⁻ᵈ of the chain's length.
        engine: Which one computed.
        solved: Share of the problems, from 0 to 1.
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

    The first, which pictures show, starts from a gentle arc; the others start from random bends and ask for random
    directions.

    Args:
        chain: From `planar_chain`.
        case: "near": half the chain's length away from its base; "edge": the part `edge` of it.
        count: How many.
        edge: From 0 to 1.
        seed: Of the random ones.
    """
    if not 0.0 < edge <= 1.0:
        raise InputError(f"the edge is a part of the chain's reach, above 0 and at most 1; got {edge!r}")
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
    """A configuration (nq,) with every joint bent a little, either way."""
    return np.asarray(rng.uniform(-_BENDS, _BENDS, chain.model.nq))


def asked_of(
    chain: Robot,
    solver: Solver,
    *,
    tolerance: float = 1e-4,
    max_iterations: int = _MOST_ITERATIONS,
    engine: str = "auto",
) -> Prepared:
    """The bare method on the chain's tip: no restarts, no limits, as many iterations as it gets on with.

    Args:
        chain: From `planar_chain`.
        solver: The method.
        tolerance: What counts as reached [m].
        max_iterations: Iterations at most.
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
    """What every method spends on every number of digits.

    Args:
        chain: From `planar_chain`.
        solvers: Short name → method.
        asked: Case → problems.
        digits: Numbers of digits.
        repeats: Times that each is solved, slow ones once; the quickest counts.
        engine: As for `pinik.solve`.
        progress: Called for each cost.
    """
    scale = length_of(chain)
    for case, own in asked.items():
        for method, solver in solvers.items():
            solves = {
                number: asked_of(chain, solver, tolerance=scale * 10.0**-number, engine=engine) for number in digits
            }
            runs: dict[int, list[list[Solution]]] = {number: [[] for _ in own] for number in solves}
            for repeat in range(repeats):  # all numbers in turn: a slow moment must not fall on one of them alone
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
