"""A race: all methods begin in the same pose, and solve for the same targets under the same rules."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...motion.tracks import random_configuration
from ...problem.targets import Target
from ...robot import Robot
from ...solvers.base import Solver
from ...solvers.distinctions import called, distinctions
from ...solving.options import Options
from ...solving.prepared import Prepared
from .ball import Ball
from .step_settings import StepSettings

__all__ = ["LONGEST", "MOST_PLACES", "Race", "Runner", "enter", "run_race"]

Array = NDArray[np.float64]

MOST_PLACES = 10
LONGEST = 1000
"""The maximum number of iterations, the same for every method, unless the session sets one."""
_ROUNDS = 5  # solves of each target by each method; the median of their times counts


class Entry(NamedTuple):
    """What a race is about, ready to be run in another thread.

    Attributes:
        robot: The robot.
        solvers: The methods; each runs once, even if two are alike.
        settings: Limits and tolerance; `at_most` counts if `until_reached` is False.
        start: The pose in which every method begins at every target (nq,).
        frame: The frame whose ball is moved from place to place.
        places: The places of that ball (n, 3) [m].
        targets: The targets at each place.
        random: Whether the places are random.
    """

    robot: Robot
    solvers: tuple[Solver, ...]
    settings: StepSettings
    start: Array
    frame: str
    places: Array
    targets: tuple[tuple[Target, ...], ...]
    random: bool


class Finish(NamedTuple):
    """One method at one place.

    Attributes:
        reached: Whether every target was reached.
        iterations, joint_updates: How many it took; iterations are sweeps for CCD.
        time: The median of five solves, each measured apart [s].
        error: The largest position error at the end [m]; None if no target has a position.
    """

    reached: bool
    iterations: int
    joint_updates: int
    time: float
    error: float | None


class Runner(NamedTuple):
    """One method's race.

    Attributes:
        method: Its short name.
        distinction: What tells it from others of that name, such as "λ = 0.05", or "".
        engine: "native" or "python".
        finishes: One for each place; none if the method cannot solve for these targets.
        refusal: The reason why it cannot, or "".
        wins: At how many places it arrived first.
        shortest: At how many places no method that arrived took fewer iterations.
    """

    method: str
    distinction: str
    engine: str
    finishes: tuple[Finish, ...]
    refusal: str
    wins: int
    shortest: int

    @property
    def called(self) -> str:
        """Its name, with what tells it from others of that name."""
        return called(self.method, self.distinction)

    @property
    def arrived(self) -> tuple[Finish, ...]:
        """The finishes that reached every target."""
        return tuple(finish for finish in self.finishes if finish.reached)


class Race(NamedTuple):
    """The result: what it was about, and each method's race in the order of the instances."""

    entry: Entry
    most: int
    runners: tuple[Runner, ...]


def enter(
    robot: Robot,
    solvers: Sequence[Solver],
    settings: StepSettings,
    start: Array,
    balls: Sequence[Ball],
    count: int,
    seed: int,
) -> Entry:
    """Enter methods for a race.

    Args:
        robot: The robot.
        solvers: The methods.
        settings: The session's settings.
        start: The pose in which all begin (nq,).
        balls: The balls; the first one that is on is moved, and the others stay where they are.
        count: The number of random places, all within reach; 0 for the balls as they are.
        seed: The seed of the random places.

    Raises:
        InputError: No ball is on.
    """
    asked = [ball for ball in balls if ball.mode != "off"]
    moved = next((ball for ball in asked if ball.mode == "on"), None)
    if moved is None:
        raise InputError("a race needs a ball that is on")
    rng = np.random.default_rng(seed)
    places = [
        robot.placement(moved.frame, random_configuration(robot, start, rng)).translation.copy() for _ in range(count)
    ] or [moved.position]
    number = asked.index(moved)
    fixed = [ball.target for ball in asked]
    rotation = fixed[number].rotation
    turned: Array = np.eye(3) if rotation is None else rotation
    targets = []
    for place in places:
        own = fixed[number].with_numbers(place, turned)
        targets.append(tuple(own if k == number else target for k, target in enumerate(fixed)))
    unlike = {repr(solver): solver for solver in solvers}
    return Entry(
        robot, tuple(unlike.values()), settings, start, moved.frame, np.array(places), tuple(targets), count > 0
    )


def run_race(entry: Entry, rounds: int = _ROUNDS) -> Race:
    """Run a race. The methods take turns, in another order in each round, and no restarts are used."""
    settings = entry.settings
    most = LONGEST if settings.until_reached else settings.at_most
    prepared: list[Prepared | str] = []
    for solver in entry.solvers:
        options = Options(
            solver,
            limits=settings.limits,
            tolerance=settings.tolerance,
            restarts=0,
            max_iterations=most,
            polish=settings.polish,
        )
        try:
            prepared.append(Prepared(entry.robot, entry.targets[0], options))
        except InputError as error:
            prepared.append(str(error))
    heats = [_heat(prepared, targets, entry.start, rounds) for targets in entry.targets]
    wins, shortest = [0] * len(prepared), [0] * len(prepared)
    for heat in heats:
        there = [k for k, finish in enumerate(heat) if finish is not None and finish.reached]
        if there:
            wins[min(there, key=lambda k: _sure(heat[k]).time)] += 1
            least = min(_sure(heat[k]).iterations for k in there)
            for k in there:
                shortest[k] += _sure(heat[k]).iterations == least
    runners = []
    told_apart = distinctions(entry.solvers)
    for k, (solver, own) in enumerate(zip(entry.solvers, prepared, strict=True)):
        refused = isinstance(own, str)
        runners.append(
            Runner(
                solver.name,
                told_apart[k],
                "" if isinstance(own, str) else own.engine,
                () if refused else tuple(_sure(heat[k]) for heat in heats),
                own if isinstance(own, str) else "",
                wins[k],
                shortest[k],
            )
        )
    return Race(entry, most, tuple(runners))


def _sure(finish: Finish | None) -> Finish:
    assert finish is not None
    return finish


def _heat(
    prepared: Sequence[Prepared | str], targets: tuple[Target, ...], start: Array, rounds: int
) -> list[Finish | None]:
    """Each method's finish at one place; None for those that cannot solve for it."""
    able = [k for k, own in enumerate(prepared) if isinstance(own, Prepared)]
    times: dict[int, list[float]] = {k: [] for k in able}
    last: list[Finish | None] = [None] * len(prepared)
    for turn in range(rounds):
        for k in (*able[turn % len(able) :], *able[: turn % len(able)]) if able else ():
            own = prepared[k]
            assert isinstance(own, Prepared)
            solution = own.answer(targets, start)
            times[k].append(solution.time)
            last[k] = Finish(
                solution.success,
                solution.iterations,
                solution.joint_updates,
                statistics.median(times[k]),
                solution.position_error,
            )
    return last
