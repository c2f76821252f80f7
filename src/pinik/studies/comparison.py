"""The four comparisons of the thesis: a ball on a curve or at random places, with limits off or on."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.chains import chain_of
from ..model.home import home_configuration
from ..motion.figures import StepFigures
from ..motion.tracks import lay_track, random_configuration
from ..robot import Robot
from .steps import LAP, PROGRAM, Chase, Rules, in_pieces

__all__ = [
    "COMPARISONS",
    "CURVE",
    "HOME_PHASE",
    "LAP",
    "Comparison",
    "Row",
    "bones",
    "chain_length",
    "compare",
    "places",
]

Array = NDArray[np.float64]

CURVE = "eight"
"""The curve of comparisons 1 and 3; the thesis does not describe its own curve."""
HOME_PHASE = 0.25
"""The part of the lap after which the curve crosses itself, at the frame's home position."""
_BOX_OF = 1000  # number of reachable places that the box encloses


class Comparison(NamedTuple):
    """One comparison.

    Attributes:
        name: The number in the thesis; "2b" and "4b" for random places of which some are out of reach.
        motion: "curve", "random" (reachable places) or "box" (any place in the box around them).
        limits: Whether joint limits apply.
    """

    name: str
    motion: str
    limits: bool


COMPARISONS = (
    Comparison("1", "curve", False),
    Comparison("2", "random", False),
    Comparison("3", "curve", True),
    Comparison("4", "random", True),
    Comparison("2b", "box", False),
    Comparison("4b", "box", True),
)


class Row(NamedTuple):
    """The results of one method in one comparison, as means over the steps.

    Attributes:
        comparison: The comparison.
        method: The solver's short name.
        engine: The engine used.
        steps: Number of steps.
        time: Seconds per step.
        iterations: Iterations per step; sweeps for CCD.
        joint_updates: Single joints updated per step, for methods that sweep.
        counted: Iterations per step as the thesis counts them, at least one: turned bones for methods that sweep.
        efficiency: The share of steps that reached the ball, from 0 to 1.
        error: The position error at the end of a step [m].
        largest_error: The largest of these errors [m].
        jump: The largest change of one joint in a step [rad or m].
        largest_jump: The largest of these changes.
    """

    comparison: Comparison
    method: str
    engine: str
    steps: int
    time: float
    iterations: float
    joint_updates: float
    counted: float
    efficiency: float
    error: float
    largest_error: float
    jump: float
    largest_jump: float


def bones(robot: Robot, frame: str) -> tuple[int, int]:
    """(bones, joints) of the chain that moves a frame; joints at the same point form one bone."""
    chain = chain_of(robot.model, robot.joints, robot.frame_id(frame))
    apart = [offset for offset in chain.offsets[:-1] if np.linalg.norm(offset) > 1e-9]
    return len(apart) + bool(chain.joints), len(chain.joints)


def chain_length(robot: Robot, frame: str) -> float:
    """The length of the chain from the first joint that moves a frame, joint by joint, to the frame [m].

    Sliding joints count as they are at zero, unlike in `Chain.length`.
    """
    chain = chain_of(robot.model, robot.joints, robot.frame_id(frame))
    return float(sum(np.linalg.norm(offset) for offset in chain.offsets))


def places(robot: Robot, frame: str, motion: str, steps: int, seed: int, lap: int = LAP) -> Array:
    """The ball's place at each step (steps, 3) [m], repeatable by seed; a lap of the curve takes `lap` steps."""
    home = home_configuration(robot)
    if motion == "curve":
        track = lay_track(robot, frame, CURVE, robot.placement(frame, home).translation)
        return np.array([track.at((HOME_PHASE + step / lap) % 1.0) for step in range(1, steps + 1)])
    rng = np.random.default_rng([seed, 0])

    def reachable() -> Array:
        return np.asarray(robot.placement(frame, random_configuration(robot, home, rng)).translation)

    if motion == "random":
        return np.array([reachable() for _ in range(steps)])
    corners = np.array([reachable() for _ in range(_BOX_OF)])
    return np.random.default_rng([seed, 1]).uniform(corners.min(axis=0), corners.max(axis=0), (steps, 3))


def compare(
    robot: Robot,
    frame: str,
    methods: Sequence[str],
    begin: Callable[[str, Comparison, Array], Chase],
    rules: Rules,
    *,
    steps: int,
    seed: int = 0,
    comparisons: Sequence[Comparison] = COMPARISONS,
    progress: Callable[[], None] = lambda: None,
) -> Iterator[Row]:
    """Run the comparisons and yield one row after the other.

    Args:
        robot: The robot.
        frame: The frame that chases the ball.
        methods: The short names of the methods.
        begin: Starts the chase of a method in a comparison, from a configuration (nq,).
        rules: The rules; `lap`, `rest` and `pieces` are used here.
        steps: Steps per row.
        seed: The seed of the random places.
        comparisons: The comparisons to run.
        progress: Called after every step.
    """
    home = home_configuration(robot)
    origin = robot.placement(frame, home).translation
    joints_of_a_bone = _joints_of_a_bone(robot, frame)
    for comparison in comparisons:
        rest = 1 if comparison.motion == "curve" else rules.rest
        balls = np.repeat(places(robot, frame, comparison.motion, -(-steps // rest), seed, rules.lap), rest, axis=0)[
            :steps
        ]
        for method in methods:
            chase = begin(method, comparison, home)
            done = []
            last = origin
            for place in balls:
                done.append(in_pieces(chase, place, last, rules.pieces))
                last = place
                progress()
            yield _row(comparison, method, chase.engine, done, joints_of_a_bone)


def _joints_of_a_bone(robot: Robot, frame: str) -> float:
    count, joints = bones(robot, frame)
    return joints / count if count else 1.0


def _row(
    comparison: Comparison, method: str, engine: str, steps: Sequence[StepFigures], joints_of_a_bone: float
) -> Row:
    updates_of_a_bone = 1.0 if engine == PROGRAM else joints_of_a_bone
    errors = [step.error for step in steps if step.error is not None]
    sweeps = any(step.joint_updates for step in steps)

    def mean(of: Callable[[StepFigures], float]) -> float:
        return math.fsum(map(of, steps)) / len(steps)

    return Row(
        comparison,
        method,
        engine,
        len(steps),
        time=mean(lambda step: step.time),
        iterations=mean(lambda step: step.iterations),
        joint_updates=mean(lambda step: step.joint_updates),
        counted=mean(lambda step: max(1.0, step.joint_updates / updates_of_a_bone if sweeps else step.iterations)),
        efficiency=mean(lambda step: step.reached),
        error=math.fsum(errors) / len(errors),
        largest_error=max(errors),
        jump=mean(lambda step: step.jump),
        largest_jump=max(step.jump for step in steps),
    )
