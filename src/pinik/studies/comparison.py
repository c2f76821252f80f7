"""Methods side by side in the thesis's four comparisons: a ball on a curve or at random, limits off or on."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.home import home_configuration
from ..motion.tracks import lay_track, random_configuration
from ..robot import Robot
from .steps import LAP, PROGRAM, Chase, Rules, Step, in_pieces

__all__ = ["COMPARISONS", "CURVE", "LAP", "Comparison", "Row", "bones", "chain_length", "compare", "places"]

Array = NDArray[np.float64]

CURVE = "eight"
"""The curve of comparisons 1 and 3; the thesis does not describe its own."""
_HOME_PHASE = 0.25  # where the eight crosses itself, in the frame's home
_BOX_OF = 1000  # reachable places that the box is laid about


class Comparison(NamedTuple):
    """One comparison.

    Attributes:
        name: The thesis's number, and "2b", "4b" for random places of which some lie out of reach.
        motion: "curve", "random" (reachable places) or "box" (any place in the box about them).
        limits: Whether joint limits hold.
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
    """What one method did in one comparison; means are over the steps.

    Attributes:
        comparison: The comparison.
        method: The solver's short name.
        engine: Which one computed.
        steps: How many.
        time: Seconds a step.
        iterations: Iterations a step; sweeps for CCD.
        joint_updates: Single joints updated a step, for CCD.
        counted: Iterations a step as the thesis counts: bones tried by CCD, steps of the others, one a step at least.
        efficiency: Share of the steps that ended with the ball reached, from 0 to 1.
        error: Metres left at a step's end.
        largest_error: The largest of them.
        jump: A step's largest change of one joint [rad or m].
        largest_jump: The largest of them.
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
    """(bones, joints) of the chain that moves a frame; joints about one point are one bone."""
    model = robot.model
    chain = [joint for joint in model.supports[model.frames[robot.frame_id(frame)].parentJoint] if joint > 0]
    apart = [joint for joint in chain[1:] if np.linalg.norm(model.jointPlacements[joint].translation) > 1e-9]
    return len(apart) + bool(chain), len(chain)


def chain_length(robot: Robot, frame: str) -> float:
    """From the first joint that moves a frame, joint by joint, to the frame [m]."""
    model = robot.model
    at = model.frames[robot.frame_id(frame)]
    chain = [joint for joint in model.supports[at.parentJoint] if joint > 0]
    offsets = [*(model.jointPlacements[joint].translation for joint in chain[1:]), at.placement.translation]
    return sum(float(np.linalg.norm(offset)) for offset in offsets)


def places(robot: Robot, frame: str, motion: str, steps: int, seed: int, lap: int = LAP) -> Array:
    """Where the ball is at each step (steps, 3) [m], the same for the same seed; a curve takes `lap` steps."""
    home = home_configuration(robot)
    if motion == "curve":
        track = lay_track(robot, frame, CURVE, robot.placement(frame, home).translation)
        return np.array([track.at((_HOME_PHASE + step / lap) % 1.0) for step in range(1, steps + 1)])
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
    """Run the comparisons, one row after the other.

    Args:
        robot: The robot.
        frame: The frame that chases the ball.
        methods: Their short names.
        begin: Puts a method of that name to work in a comparison, from a configuration (nq,).
        rules: Of them, `lap`, `rest` and `pieces` count here.
        steps: Steps of each row.
        seed: Of the random places.
        comparisons: Which.
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


def _row(comparison: Comparison, method: str, engine: str, steps: Sequence[Step], joints_of_a_bone: float) -> Row:
    updates_of_a_bone = 1.0 if engine == PROGRAM else joints_of_a_bone

    def mean(of: Callable[[Step], float]) -> float:
        return math.fsum(map(of, steps)) / len(steps)

    return Row(
        comparison,
        method,
        engine,
        len(steps),
        time=mean(lambda step: step.time),
        iterations=mean(lambda step: step.iterations),
        joint_updates=mean(lambda step: step.joint_updates),
        counted=mean(
            lambda step: max(1.0, step.joint_updates / updates_of_a_bone if method == "ccd" else step.iterations)
        ),
        efficiency=mean(lambda step: step.reached),
        error=mean(lambda step: step.error),
        largest_error=max(step.error for step in steps),
        jump=mean(lambda step: step.jump),
        largest_jump=max(step.jump for step in steps),
    )
