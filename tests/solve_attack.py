"""The attacker on solves: random robots, targets, starts and options, and what must hold of every answer.

An answer must be finite, inside the limits, honest by plain Pinocchio and by the judge, the same when asked again, and
must leave alone the joints that cannot move a target. `tools/attack_solves.py` runs it for as many solves as wanted.
"""

from __future__ import annotations

import collections
import math
import warnings
from typing import Any, NamedTuple

import numpy as np
import pinocchio

import pinik
from judge import AXES, judge
from pinik.errors import PinikError
from pinik.solvers.parameter import Parameter, parameters_of
from plain_certificate import plain_errors
from random_trees import random_tree

METHODS = ("dls", "pinv", "jt", "ccd")
KINDS = ("position", "pose", "rotation", "axis", "look", "partial", "axis+position", "look+position")
ROOTS = ("fixed", "fixed", "fixed", "free_flyer", "planar")
QUESTIONS = 4  # to a robot
SOLVES = 6  # of a question
PYTHON_SHARE = 0.06  # of the questions; the Python engine is slow
FARTHEST = 1e6  # [m]: beyond, rounding is as large as tolerances, and the judge's own


class Question(NamedTuple):
    """What is asked of a robot, from which starts."""

    robot: pinik.Robot
    targets: list[pinik.Target]
    method: str
    parameters: dict[str, Any]
    options: dict[str, Any]
    starts: list[np.ndarray]


class FaultyAnswerError(AssertionError):
    """An answer that must not be."""


def attack(seed: int, number: int) -> collections.Counter[str]:
    """Make robot `number` and ask it QUESTIONS questions, each SOLVES times; count what came of them.

    Raises:
        FaultyAnswerError: An answer is not as it must be, or something but an answer came back.
    """
    rng = np.random.default_rng([seed, number])
    counts: collections.Counter[str] = collections.Counter()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        robot = pinik.load(random_tree(rng), root=str(rng.choice(ROOTS)))
        for k in range(QUESTIONS):
            where = f"robot {number} of seed {seed}, question {k}"
            question = None
            try:
                question = random_question(robot, rng)
                counts += answers(question)
            except PinikError as error:
                raise FaultyAnswerError(f"{where}: {type(error).__name__}: {error}; {question}") from error
            except Exception as error:
                raise FaultyAnswerError(
                    f"{where}: {type(error).__name__}: {error}; {question and question[1:5]}"
                ) from error
    return counts


def answers(question: Question) -> collections.Counter[str]:
    """Solve from every start, check each answer, and count."""
    robot, targets, method, parameters, options, starts = question
    counts: collections.Counter[str] = collections.Counter()
    prepared = pinik.prepare(robot, targets, method, **parameters, **options)
    for start in starts:
        solution = prepared(targets, start)
        check(question, solution, start)
        counts.update([f"{method} {solution.engine} {'solved' if solution.success else 'missed'}", "solves"])
    again = pinik.prepare(robot, targets, method, **parameters, **options)(targets, starts[-1])
    if again.q.tobytes() != solution.q.tobytes() or again.status is not solution.status:
        raise FaultyAnswerError(f"asked again, it answers {again!r} instead of {solution!r}")
    many = pinik.solve_many(robot, [targets], method=method, q0=starts[-1], threads=1, **parameters, **options)
    if many.q[0].tobytes() != solution.q.tobytes() or many.status[0] is not solution.status:
        raise FaultyAnswerError(f"solve_many answers {many.q[0]}, {many.status[0]} instead of {solution!r}")
    counts["solves"] += 2
    return counts


def check(question: Question, solution: pinik.Solution, start: np.ndarray) -> None:
    """Raise a FaultyAnswerError unless the answer is as it must be."""
    robot, targets, *_, options, _ = question
    q = solution.q
    if q.shape != (robot.model.nq,) or not np.isfinite(q).all():
        raise FaultyAnswerError(f"not finite: {q}")
    tolerance = options["tolerance"]
    claimed = [pinik.TargetError(*error) for error in plain_errors(robot, targets, q, tolerance)]
    within = all(e.within(t.tolerance or pinik.Tolerance.of(tolerance)) for e, t in zip(claimed, targets, strict=True))
    if within is not solution.success:
        raise FaultyAnswerError(
            f"it says {solution.status}, plain Pinocchio finds {claimed}, and {solution.errors} is said"
        )
    check_by_the_judge(question, solution)
    untouched = [i for joint in robot.joints if joint.nq and not may_move(question, joint) for i in entries(joint)]
    if options["limits"]:  # a start outside them is moved inside
        untouched = [i for i in untouched if robot.lower_q[i] <= start[i] <= robot.upper_q[i]]
    moved = [i for i in untouched if q[i] != start[i]]
    if moved:
        raise FaultyAnswerError(f"entries {moved} of q must stay at {start[moved]}, and are {q[moved]}")
    str(solution)


def check_by_the_judge(question: Question, solution: pinik.Solution) -> None:
    """Errors and limits by the judge, who reads the file himself."""
    robot, targets, *_, options, _ = question
    found = judge(robot, targets, solution.q)
    if options["limits"] and found.outside:
        raise FaultyAnswerError(f"outside the limits: {found.outside}")
    circles = {name: off for name, off in found.outside.items() if name not in robot.joint_names}
    if circles:
        raise FaultyAnswerError(f"not of unit length: {circles}")
    blur = 1e-12 * max(1.0, *(float(np.abs(M.translation).max()) for M in placements(robot, solution.q)))
    for said, miss, target in zip(solution.errors, found.each, targets, strict=True):
        if miss.position is not None and not math.isclose(said.position, miss.position, rel_tol=1e-9, abs_tol=blur):
            raise FaultyAnswerError(f"it says {said}, the judge {miss}")
        near = 1e-7 if target.at is None else 1e-7 + 100.0 * blur / 1e-6
        if miss.orientation is not None and not abs(said.orientation - miss.orientation) <= near:
            raise FaultyAnswerError(f"it says {said}, the judge {miss}")


def placements(robot: pinik.Robot, q: np.ndarray) -> list[pinocchio.SE3]:
    data = robot.model.createData()
    pinocchio.forwardKinematics(robot.model, data, q)
    return list(data.oMi)


def entries(joint: pinik.Joint) -> range:
    return range(joint.idx_q, joint.idx_q + joint.nq)


def may_move(question: Question, joint: pinik.Joint) -> bool:
    """Whether a joint, or one that follows it, moves a target's frame with respect to its reference."""
    robot, model = question.robot, question.robot.model
    if joint.name in question.options["locked"]:
        return False
    ids = [other.id for other in robot.joints if joint.name in (other.name, other.leader)]
    for target in question.targets:
        supports = [
            set(model.supports[model.frames[robot.frame_id(name)].parentJoint]) if name else set()
            for name in (target.frame, target.relative_to)
        ]
        if (supports[0] ^ supports[1]) & set(ids):
            return True
    return False


def random_question(robot: pinik.Robot, rng: np.random.Generator) -> Question:
    """Targets, method, parameters, options and starts; usually something that the robot can do."""
    method = str(rng.choice(METHODS))
    posed = robot.random(rng)
    targets = [random_target(robot, posed, rng) for _ in range(rng.choice([1, 1, 1, 2, 3, 5]))]
    names = list(robot.joint_names)
    locked = [str(name) for name in rng.choice(names, min(len(names), 2), replace=False)] if names else []
    tiny = rng.random() < 0.2
    options = {
        "limits": bool(rng.random() < 0.7),
        "locked": tuple(locked) if rng.random() < 0.2 else (),
        "restarts": int(rng.choice([0, 0, 1, 3])),
        "seed": int(rng.integers(0, 2**63)),
        "max_iterations": int(rng.integers(1, 60)),
        "tolerance": (10.0 ** rng.uniform(-17, -12), 10.0 ** rng.uniform(-17, -12)) if tiny else (1e-4, 1e-3),
        "choose": "nearest" if rng.random() < 0.1 else "first",
        "polish": bool(rng.random() < 0.9),
        "engine": "python" if rng.random() < PYTHON_SHARE else "auto",
    }
    starts = [random_start(robot, rng) for _ in range(SOLVES)]
    return Question(robot, targets, method, random_parameters(robot, method, rng), options, starts)


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


def random_target(robot: pinik.Robot, posed: np.ndarray, rng: np.random.Generator) -> pinik.Target:
    """One that the posed robot fulfils, one near that, or one far away."""
    frame, other = (str(name) for name in rng.choice(robot.frame_names, 2))
    kind = str(rng.choice(KINDS))
    about: dict[str, Any] = {"weight": float(10.0 ** rng.uniform(-3.0, 3.0)) if rng.random() < 0.3 else 1.0}
    if rng.random() < 0.25 and other != frame:
        about["relative_to"] = other
    placement = robot.placement(frame, posed, about.get("relative_to"))
    if rng.random() < 0.25:
        about["tool"] = pinocchio.SE3(pinocchio.exp3(rng.normal(size=3)), 0.3 * rng.normal(size=3))
        placement = placement * about["tool"]
    off = float(rng.choice([0.0, 0.0, 0.0, 0.1, 1.0, 30.0]))
    position = placement.translation + off * rng.normal(size=3)
    about["tolerance"] = [None, None, None, (1e-3, 0.3), ((0.1, 1e-4, 1e-3), 0.02)][rng.integers(0, 5)]
    if "position" in kind:
        about["position"] = position
    if kind == "pose":
        about["placement"] = pinocchio.SE3(placement.rotation, position)
    elif kind == "partial":
        free = rng.permutation(3)[: rng.integers(1, 3)]
        about["position"] = [None if k in free else x for k, x in enumerate(position.tolist())]
    elif kind == "rotation":
        about["rotation"] = placement.rotation if rng.random() < 0.8 else placement.rotation @ np.diag([1.0, -1, -1])
    elif kind.startswith("axis"):
        name = str(rng.choice(list(AXES)))
        about |= {"axis": name, "direction": rng.normal(size=3)}
        if rng.random() < 0.3:
            about["direction"] = rng.choice([1.0, -1.0]) * placement.rotation @ np.array(AXES[name], dtype=float)
    elif kind.startswith("look"):
        near = 10.0 ** rng.uniform(-12.0, 1.0)
        about |= {"axis": str(rng.choice(list(AXES))), "at": placement.translation + near * rng.normal(size=3)}
    return pinik.Target(frame, **about)


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
