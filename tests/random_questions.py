"""Random questions to a robot: targets of every kind, methods, parameters, options and starts."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pinocchio

import pinik
from judge import AXES
from pinik.solvers.parameter import Parameter, parameters_of

__all__ = ["METHODS", "Question", "random_question"]

METHODS = ("dls", "pinv", "jt", "ccd")
KINDS = ("position", "pose", "rotation", "axis", "look", "partial", "axis+position", "look+position")
PLACES = 8  # where each target may be
STARTS = 48
PYTHON_SHARE = 0.06  # of the questions; the Python engine is slow, and gets fewer starts
PYTHON_STARTS = 4


class Question(NamedTuple):
    """What is asked of a robot.

    Attributes:
        robot: The robot.
        sets: Targets of the same kinds at several places.
        method: The method.
        parameters: Its parameters.
        options: The options of the solve.
        starts: The configurations (nq,) to start from; start i is for the targets of `row(i)`.
    """

    robot: pinik.Robot
    sets: list[list[pinik.Target]]
    method: str
    parameters: dict[str, Any]
    options: dict[str, Any]
    starts: list[np.ndarray]

    def row(self, number: int) -> list[pinik.Target]:
        """The targets that are asked for from this start."""
        return self.sets[number % len(self.sets)]


def random_question(robot: pinik.Robot, rng: np.random.Generator) -> Question:
    """Targets, method, parameters, options and starts; usually something that the robot can do."""
    method = str(rng.choice(METHODS))
    wishes = [random_wish(robot, rng) for _ in range(rng.choice([1, 1, 1, 2, 3, 5]))]
    poses = [robot.random(rng) for _ in range(PLACES)]
    sets = [[placed(wish, robot, posed, rng) for wish in wishes] for posed in poses]
    names = list(robot.joint_names)
    locked = [str(name) for name in rng.choice(names, min(len(names), 2), replace=False)] if names else []
    tiny = rng.random() < 0.2
    options = {
        "limits": bool(rng.random() < 0.7),
        "locked": tuple(locked) if rng.random() < 0.2 else (),
        "restarts": int(rng.choice([0, 0, 0, 1, 3])),
        "seed": int(rng.integers(0, 2**63)),
        "max_iterations": int(rng.integers(1, 45)),
        "tolerance": (10.0 ** rng.uniform(-17, -12), 10.0 ** rng.uniform(-17, -12)) if tiny else (1e-4, 1e-3),
        "choose": "nearest" if rng.random() < 0.1 else "first",
        "polish": bool(rng.random() < 0.9),
        "engine": "python" if rng.random() < PYTHON_SHARE else "auto",
    }
    starts = [random_start(robot, rng) for _ in range(PYTHON_STARTS if options["engine"] == "python" else STARTS)]
    return Question(robot, sets, method, random_parameters(robot, method, rng), options, starts)


def random_start(robot: pinik.Robot, rng: np.random.Generator) -> np.ndarray:
    """A configuration inside the limits, with some joints at a limit, beyond it, or far away."""
    q = robot.random(rng) if rng.random() < 0.8 else np.clip(robot.neutral(), robot.lower_q, robot.upper_q)
    for joint in robot.joints:
        if joint.nq == 1 and rng.random() < 0.1:
            low, high = float(robot.lower_q[joint.idx_q]), float(robot.upper_q[joint.idx_q])
            ends = [end for end in (low, high) if abs(end) < 1e3]
            if ends:
                q[joint.idx_q] = rng.choice(ends)
            q[joint.idx_q] += rng.choice([0.0, 0.0, 0.0, 1e-9, 7.0, -1e3])
    return q


class Wish(NamedTuple):
    """What is asked of a frame, without the numbers that say where it should be."""

    frame: str
    kind: str
    free: tuple[int, ...]  # the coordinates of a partial position that do not matter
    about: dict[str, Any]


def random_wish(robot: pinik.Robot, rng: np.random.Generator) -> Wish:
    frame, other = (str(name) for name in rng.choice(robot.frame_names, 2))
    kind = str(rng.choice(KINDS))
    about: dict[str, Any] = {"weight": float(10.0 ** rng.uniform(-3.0, 3.0)) if rng.random() < 0.3 else 1.0}
    about["tolerance"] = [None, None, None, (1e-3, 0.3), ((0.1, 1e-4, 1e-3), 0.02)][rng.integers(0, 5)]
    if rng.random() < 0.25 and other != frame:
        about["relative_to"] = other
    if rng.random() < 0.25:
        about["tool"] = pinocchio.SE3(pinocchio.exp3(rng.normal(size=3)), 0.3 * rng.normal(size=3))
    if kind.startswith(("axis", "look")):
        about["axis"] = str(rng.choice(list(AXES)))
    return Wish(frame, kind, tuple(rng.permutation(3)[: rng.integers(1, 3)].tolist()), about)


def placed(wish: Wish, robot: pinik.Robot, posed: np.ndarray, rng: np.random.Generator) -> pinik.Target:
    """A target that the posed robot fulfils, one near that, or one far away."""
    kind, about = wish.kind, dict(wish.about)
    placement = robot.placement(wish.frame, posed, about.get("relative_to"))
    placement = placement * about.get("tool", pinocchio.SE3.Identity())
    off = float(rng.choice([0.0, 0.0, 0.0, 0.1, 1.0, 30.0]))
    position = placement.translation + off * rng.normal(size=3)
    if "position" in kind:
        about["position"] = position
    if kind == "pose":
        about["placement"] = pinocchio.SE3(placement.rotation, position)
    elif kind == "partial":
        about["position"] = [None if k in wish.free else x for k, x in enumerate(position.tolist())]
    elif kind == "rotation":
        about["rotation"] = placement.rotation if rng.random() < 0.8 else placement.rotation @ np.diag([1.0, -1, -1])
    elif kind.startswith("axis"):
        about["direction"] = rng.normal(size=3)
        if rng.random() < 0.3:
            sign, axis = rng.choice([1.0, -1.0]), np.array(AXES[about["axis"]], dtype=float)
            about["direction"] = sign * placement.rotation @ axis
    elif kind.startswith("look"):
        near = 10.0 ** rng.uniform(-12.0, 1.0)
        about["at"] = placement.translation + near * rng.normal(size=3)
    return pinik.Target(wish.frame, **about)


def random_parameters(robot: pinik.Robot, method: str, rng: np.random.Generator) -> dict[str, Any]:
    """Some of a method's parameters, drawn from all of their ranges."""
    drawn = {}
    for own in parameters_of(pinik.SOLVERS[method]):
        if rng.random() < 0.15:
            drawn[own.name] = random_value(own, robot, rng)
    return drawn


def random_value(own: Parameter, robot: pinik.Robot, rng: np.random.Generator) -> Any:
    if own.kind == "choice":
        return str(rng.choice(own.choices))
    if own.kind == "truth":
        return bool(rng.random() < 0.5)
    if own.kind == "joints":
        names = [j.name for j in robot.joints if j.has_one_axis and j.nv and rng.random() < 0.4]
        return {name: float(rng.choice([0.0, 0.1, 1.0]) if own.high else rng.normal()) for name in names}
    if (own.optional or own.unbounded) and rng.random() < 0.3:
        return None
    low, high = own.low or 1e-13, own.high or 1e3
    return min(max(float(10.0 ** rng.uniform(math.log10(low), math.log10(high))), own.low or 0.0), high)
