"""Table 4.1 of the thesis (Šimunić 2012): its figures, and its parameters by several readings."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownNameError
from ..problem.targets import Tolerance
from ..robot import Robot
from ..solvers.base import Solver
from ..solvers.ccd import CCD
from ..solvers.damped_least_squares import DampedLeastSquares
from ..solvers.pseudo_inverse import PseudoInverse
from ..solvers.registry import SOLVERS
from ..solvers.transpose import JacobianTranspose
from .ball_chain import BallChain, ProgramChase
from .comparison import Comparison, Row, bones, chain_length
from .steps import LAP, Chase, Rules, chase_with

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

METHODS = tuple(SOLVERS)

ITERATIONS = 100
TOLERANCE = 0.05  # in its units, as all lengths below
ALPHA = 0.01
DAMPING = 1.1
MAX_ANGLE = math.pi / 16
SWING = math.pi / 4
SEGMENTS = 7


class Published(NamedTuple):
    """One cell of the table.

    Attributes:
        time: Seconds a step.
        iterations: Iterations a step; bones turned for CCD.
        efficiency: Share of the steps solved, from 0 to 1.
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
    """The thesis's figures for a row's method and comparison.

    It does not say whether its random places can be reached, so a row in a box has those of the random one too.
    """
    cells = TABLE.get(row.method)
    return None if cells is None else cells[row.comparison.name.removesuffix("b")]


@dataclass(frozen=True)
class _Reading:
    """One way to read the parameters.

    Attributes:
        about: What it means, in one line.
        alpha: The factor on the steps of pseudo-inverse and DLS.
        transpose_alpha: The transpose's factor on Jᵀe [1/units²].
        max_angle: The clamp on a DLS step, before α [rad].
        units: How many of its units the chain is long; None where a unit is a metre.
        lap: Steps once round the curve.
        rest: Steps that a random ball stays where it is.
        program: Whether the bones are ball joints, moved by its own pseudo-code.
        unit_axes: Whether these turn about axes of length one.
    """

    about: str
    alpha: float = ALPHA
    transpose_alpha: float = ALPHA
    max_angle: float = MAX_ANGLE
    units: float | None = SEGMENTS
    lap: int = LAP
    rest: int = 1
    program: bool = False
    unit_axes: bool = True


_IN_DEGREES = ALPHA * 180.0 / math.pi
_AT_60_HZ = ALPHA * 60.0

_THESIS = {
    "literal": _Reading("the stated parameters on hinges, α after the clamp in every iteration"),
    "bones": _Reading("the same by the pseudo-code: bones are ball joints, a column each, unit axes", program=True),
    "printed-axes": _Reading(
        "the same with the axes as printed, cross products of any length", program=True, unit_axes=False
    ),
    "degrees": _Reading("α on angles in degrees that are then taken for radians: 0.573", _IN_DEGREES, _IN_DEGREES),
    "sixty-hertz": _Reading("α counted per frame at 60 frames a second: 0.6", _AT_60_HZ, _AT_60_HZ),
    "whole-steps": _Reading("α is the transpose's alone; pseudo-inverse and DLS take whole steps", 1.0),
    "late-clamp": _Reading("the clamp after α instead of before it", max_angle=MAX_ANGLE / ALPHA),
    "metres": _Reading("a unit is a metre of pinik's arm", units=None),
    "fast-ball": _Reading("the ball is round its curve in a second instead of eight", lap=60),
    "resting": _Reading("a random ball stays at a place for ten frames, each of which counts", rest=10),
}

_TUNED = {
    "defaults": "pinik's defaults: restarts, 0.1 mm",
    "no-restarts": "pinik's defaults without restarts",
    "thesis-tolerance": "pinik's defaults with the thesis's tolerance",
}

PRESETS: Mapping[str, Mapping[str, str]] = {
    "thesis": {name: reading.about for name, reading in _THESIS.items()},
    "tuned": _TUNED,
}
"""Preset → its readings, the first the usual one → what they mean."""


@dataclass(frozen=True, eq=False)
class Contest:
    """Methods with their settings, ready to be compared on one robot.

    Attributes:
        preset, reading: Their names.
        unit: The length of one of the thesis's units [m].
        chain_length: The length of the chain that moves the frame [m].
        bones, joints: How many move the frame.
        rules: How the methods are run.
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

    def begin(self, method: str, comparison: Comparison, start: Array, engine: str = "auto") -> Chase:
        """Put a method to work from `start` (nq,)."""
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
        reading = _THESIS[self.reading]
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
    """The four methods by a preset and one of its readings, scaled to a robot.

    Raises:
        UnknownNameError: No such preset, reading or frame.
        InputError: No chain that has a length moves the frame.
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
            f"{frame} of {robot.name} is moved by no chain of joints that has a length, so nothing can chase a ball; "
            "name another frame"
        )
    units = _THESIS[chosen].units if preset == "thesis" else SEGMENTS
    unit = 1.0 if units is None else length / units
    if preset == "thesis":
        rules, solvers = _by_the_thesis(_THESIS[chosen], unit)
    else:
        rules, solvers = _tuned(chosen, unit)
    rules = dataclasses.replace(rules, pieces=pieces)
    return Contest(preset, chosen, robot, frame, unit, length, *bones(robot, frame), rules, solvers)


def _by_the_thesis(reading: _Reading, unit: float) -> tuple[Rules, dict[str, Solver]]:
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
    """How far rows lie from the table, on average over the cells.

    Attributes:
        efficiency: Points of efficiency, from 0 to 100.
        iterations: Factor of iterations, either way; 1 where they agree.
    """

    efficiency: float
    iterations: float


def mismatch(rows: Iterable[Row], *, box: bool = False) -> Mismatch | None:
    """How far comparisons 1 to 4 lie from the table, or 1, 2b, 3, 4b with `box`; None without such rows."""
    points, logs = [], []
    for row in rows:
        cell = published(row)
        if cell is not None and row.comparison.motion != ("random" if box else "box"):
            points.append(100.0 * abs(row.efficiency - cell.efficiency))
            logs.append(abs(math.log(row.counted / cell.iterations)))
    if not points:
        return None
    return Mismatch(sum(points) / len(points), math.exp(sum(logs) / len(logs)))
