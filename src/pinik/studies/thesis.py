"""Table 4.1 of the thesis (Šimunić 2012): its figures, and contests under its parameters or pinik's own."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError
from ..problem.tolerance import Tolerance
from ..robot import Robot
from ..solvers.base import Solver
from ..solvers.ccd import CCD
from ..solvers.damped_least_squares import DampedLeastSquares
from ..solvers.pseudo_inverse import PseudoInverse
from ..solvers.registry import SOLVERS
from ..solvers.transpose import JacobianTranspose
from .ball_chain import METHODS, BallChain, ProgramChase
from .comparison import Comparison, Row, bones, chain_length
from .readings import PRESETS, SEGMENTS, THESIS, Reading
from .steps import Chase, Rules, chase_with

__all__ = [
    "METHODS",
    "PRESETS",
    "TABLE",
    "Contest",
    "Mismatch",
    "Published",
    "contest",
    "mismatch",
    "published",
]

Array = NDArray[np.float64]

ITERATIONS = 100
TOLERANCE = 0.05  # in the thesis's units
DAMPING = 1.1
SWING = math.pi / 4


class Published(NamedTuple):
    """One cell of the table.

    Attributes:
        time: Seconds per step.
        iterations: Iterations per step; turned bones for CCD.
        efficiency: The share of solved steps, from 0 to 1.
    """

    time: float
    iterations: float
    efficiency: float


def _cells(*figures: tuple[float, float, float]) -> dict[str, Published]:
    return {str(k): Published(ms / 1000.0, n, share / 100.0) for k, (ms, n, share) in enumerate(figures, start=1)}


TABLE: Mapping[str, Mapping[str, Published]] = {
    "ccd": _cells((1.1, 20, 99), (5.0, 210, 75), (5.0, 83, 92), (16.7, 232, 74)),
    "jt": _cells((5.0, 28, 78), (15.4, 92, 15), (45.6, 93, 8), (47.8, 99, 3)),
    "pinv": _cells((7.0, 25, 96), (21.8, 79, 47), (23.8, 40, 81), (51.9, 88, 29)),
    "dls": _cells((3.5, 18, 100), (19.0, 100, 0), (27.8, 55, 69), (50.0, 99, 2)),
}
"""Method → number of the comparison → figures."""


def published(row: Row) -> Published | None:
    """The thesis's figures for a row's method and comparison; None for methods that it does not have.

    Rows with places from a box get the figures of the random places, as the thesis does not say which of the two it
    used.
    """
    cells = TABLE.get(row.method)
    return None if cells is None else cells[row.comparison.name.removesuffix("b")]


@dataclass(frozen=True, eq=False)
class Contest:
    """Methods and rules, ready for comparisons on one robot.

    Attributes:
        preset, reading: The names of the preset and its reading.
        robot: The robot.
        frame: The frame that chases the ball.
        unit: The length of one unit of the thesis [m].
        chain_length: The length of the chain that moves the frame [m].
        bones, joints: The numbers of bones and joints that move the frame.
        rules: The rules for all methods.
        solvers: Short name → solver with its parameters, in metres; empty for the thesis's own program.
    """

    preset: str
    reading: str
    robot: Robot
    frame: str
    unit: float
    chain_length: float
    bones: int
    joints: int
    rules: Rules
    solvers: Mapping[str, Solver]

    @property
    def methods(self) -> tuple[str, ...]:
        """Short names of the methods: the thesis's four, or every registered solver with the preset "tuned"."""
        return tuple(self.solvers) or METHODS

    def begin(self, method: str, comparison: Comparison, start: Array, engine: str = "auto") -> Chase:
        """Start a chase by a method from `start` (nq,).

        Raises:
            UnknownNameError: The contest does not have this method.
        """
        if method not in self.methods:
            raise UnknownNameError("method", method, self.methods)
        if self.solvers:
            return chase_with(
                self.robot,
                self.frame,
                self.solvers[method],
                limits=comparison.limits,
                rules=self.rules,
                start=start,
                engine=engine,
            )
        reading = THESIS[self.reading]
        swing = SWING if comparison.limits else math.inf
        return ProgramChase(
            method,
            BallChain.of(self.robot, self.frame, start, self.unit, swing),
            unit=self.unit,
            tolerance=TOLERANCE,
            alpha=reading.alpha,
            damping=DAMPING,
            max_angle=reading.max_angle,
            max_iterations=ITERATIONS,
            unit_axes=reading.unit_axes,
        )


def contest(robot: Robot, frame: str, preset: str = "thesis", reading: str | None = None, pieces: int = 1) -> Contest:
    """The methods of a preset and one of its readings, scaled to a robot.

    Raises:
        UnknownNameError: No such preset, reading or frame.
        InputError: The chain that moves the frame has no length.
    """
    if preset not in PRESETS:
        raise UnknownNameError("preset", preset, PRESETS)
    readings = PRESETS[preset]
    chosen = next(iter(readings)) if reading is None else reading
    if chosen not in readings:
        raise UnknownNameError(f"reading of preset {preset!r}", chosen, readings)
    length = chain_length(robot, frame)
    if length == 0.0:
        raise InputError(
            f"frame {frame!r} of {robot.name} cannot chase a ball, as the chain of joints that moves it has no length; "
            "choose another frame"
        )
    units = THESIS[chosen].units if preset == "thesis" else SEGMENTS
    unit = 1.0 if units is None else length / units
    if preset == "thesis":
        rules, solvers = _by_the_thesis(THESIS[chosen], unit)
    else:
        rules, solvers = _tuned(chosen, unit)
    rules = dataclasses.replace(rules, pieces=pieces)
    return Contest(preset, chosen, robot, frame, unit, length, *bones(robot, frame), rules, solvers)


def _by_the_thesis(reading: Reading, unit: float) -> tuple[Rules, dict[str, Solver]]:
    rules = Rules(tolerance=_reached_at(unit), max_iterations=ITERATIONS, bare=True, lap=reading.lap, rest=reading.rest)
    if reading.program:
        return rules, {}
    return rules, {
        "ccd": CCD(),
        "jt": JacobianTranspose(alpha=reading.transpose_alpha / unit**2, max_step=math.inf),
        "pinv": PseudoInverse(step_size=reading.alpha, max_step=math.inf, cutoff=0.0),
        "dls": DampedLeastSquares(
            rule="constant",
            damping=DAMPING * unit,
            step_size=reading.alpha,
            max_step=reading.max_angle,
            factorization="svd",
        ),
    }


def _tuned(reading: str, unit: float) -> tuple[Rules, dict[str, Solver]]:
    rules = Rules(
        tolerance=_reached_at(unit) if reading == "thesis-tolerance" else Tolerance(),
        restarts=0 if reading == "no-restarts" else None,
    )
    return rules, {name: solver() for name, solver in SOLVERS.items()}


def _reached_at(unit: float) -> Tolerance:
    return Tolerance(TOLERANCE * unit, Tolerance().orientation)


class Mismatch(NamedTuple):
    """The mean difference between rows and the table.

    Attributes:
        efficiency: In percentage points.
        iterations: As a factor of at least 1.
    """

    efficiency: float
    iterations: float


def mismatch(rows: Iterable[Row], *, box: bool = False) -> Mismatch | None:
    """The mean difference of comparisons 1 to 4, or of 1, 2b, 3, 4b with `box`; None without such rows."""
    points, logs = [], []
    for row in rows:
        cell = published(row)
        if cell is not None and row.comparison.motion != ("random" if box else "box"):
            points.append(100.0 * abs(row.efficiency - cell.efficiency))
            logs.append(abs(math.log(row.counted / cell.iterations)))
    if not points:
        return None
    return Mismatch(sum(points) / len(points), math.exp(sum(logs) / len(logs)))
