"""The attacker on solves: random robots and questions, and what must hold of every answer.

An answer must be finite, inside the limits, honest by plain Pinocchio and by the judge, the same when asked again, and
must leave alone the joints that cannot move a target. `tools/attack_solves.py` runs it for as many solves as wanted.
"""

from __future__ import annotations

import collections
import functools
import math
import operator
import warnings
from collections.abc import Sequence

import numpy as np

import pinik
from judge import judge, outside_rows
from pinik.errors import PinikError
from plain_certificate import ErrorRows, plain_error_rows, plain_errors, rounding, turn_rounding
from random_questions import Question, random_question
from random_trees import random_tree

ROOTS = ("fixed", "fixed", "fixed", "free_flyer", "planar")
QUESTIONS = 4  # to a robot
ALONE = 2  # so many starts of a question are also solved one by one
JUDGED = 2  # so many answers of a question that come from `solve_many` are judged one by one


class FaultyAnswerError(AssertionError):
    """An answer that must not be."""


def attack(seed: int, number: int) -> collections.Counter[str]:
    """Make robot `number`, ask it QUESTIONS questions from many starts each, and count what came of them.

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
                asked = question and (question.method, question.parameters, question.options, question.sets[0])
                raise FaultyAnswerError(f"{where}: {type(error).__name__}: {error}; {asked}") from error
    return counts


def answers(question: Question) -> collections.Counter[str]:
    """Solve from every start, check each answer, and count."""
    robot, sets, method, parameters, options, starts = question
    prepared = pinik.prepare(robot, sets[0], method, **parameters, **options)
    alone = [prepared(question.row(i), starts[i]) for i in range(ALONE)]
    for i, solution in enumerate(alone):
        check(question, solution, i)
    str(alone[0])  # looks for what of a missed pose can be reached
    again = pinik.prepare(robot, sets[-1], method, **parameters, **options)(sets[0], starts[0])
    if again.q.tobytes() != alone[0].q.tobytes() or again.status is not alone[0].status:
        raise FaultyAnswerError(f"asked again, it answers {again!r} instead of {alone[0]!r}")
    asked, q0 = [question.row(i) for i in range(len(starts))], np.array(starts)
    many = pinik.solve_many(robot, asked, method=method, q0=q0, threads=1, **parameters, **options)
    check_many(question, many)
    for i in range(ALONE if options["restarts"] == 0 else 1):  # the number of a row seeds its restarts
        if many.q[i].tobytes() != alone[i].q.tobytes() or many.status[i] is not alone[i].status:
            raise FaultyAnswerError(f"solve_many answers {many.q[i]}, {many.status[i]} instead of {alone[i]!r}")
    ends = [*(solution.status for solution in [*alone, again]), *many.status]
    counts = collections.Counter(f"{method} {many.engine} {status.name.lower()}" for status in ends)
    return counts + collections.Counter(solves=len(ends))


def check(question: Question, solution: pinik.Solution, start: int) -> None:
    """Raise a FaultyAnswerError unless the answer from one of the starts is as it must be."""
    targets = question.row(start)
    check_numbers(question, solution.q[np.newaxis], [start])
    check_claim(question, targets, solution.q, solution.status)
    check_by_the_judge(question, targets, solution)


def check_many(question: Question, many: pinik.Solutions) -> None:
    """Raise a FaultyAnswerError unless the answers from all starts are as they must be.

    Plain Pinocchio measures all of them in arrays. Where rounding may decide, and where it finds something else than is
    claimed, it measures once more one by one.
    """
    rows = range(len(question.starts))
    check_numbers(question, many.q, rows)
    asked = [question.row(i) for i in rows]
    found = plain_error_rows(question.robot, asked, many.q)
    within, doubtful = verdicts(question, found)
    for i in np.flatnonzero(doubtful | (within != many.success)):
        check_claim(question, asked[i], many.q[i], many.status[i])
    check_said(many.position_error, [(errors.metres, errors.blur) for errors in found])
    check_said(many.orientation_error, [(errors.radians, errors.turn_blur) for errors in found])
    for i in rows[ALONE : ALONE + JUDGED]:
        check_by_the_judge(question, asked[i], many[i])


def verdicts(question: Question, found: list[ErrorRows]) -> tuple[np.ndarray, np.ndarray]:
    """(whether all targets are within tolerance (n,), whether rounding may decide that (n,))."""
    count = len(question.starts)
    within, doubtful = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    for target, errors in zip(question.sets[0], found, strict=True):
        metres, radians = target.tolerance or question.options["tolerance"]
        compared = [(errors.radians, radians, errors.turn_blur)]
        if np.ndim(metres) == 0:
            compared.append((errors.metres, metres, errors.blur))
        elif errors.offsets is not None:
            compared += [(np.abs(errors.offsets[:, k]), metres[k], errors.blur) for k in range(3)]
        for error, most, blur in compared:
            if error is not None:
                within &= error <= most
                doubtful |= np.abs(error - most) <= blur
    return within, doubtful


def check_said(said: np.ndarray, found: list[tuple[np.ndarray | None, np.ndarray]]) -> None:
    """Compare the largest errors that are said (n,) with those of each target."""
    known = [(errors, blur) for errors, blur in found if errors is not None]
    if not known:
        if not np.isnan(said).all():
            raise FaultyAnswerError(f"errors {said} are said where nothing was asked")
        return
    largest, blur = (np.max(each, axis=0) for each in zip(*known, strict=True))
    wrong = ~(np.abs(said - largest) <= blur + 1e-9 * largest)
    if wrong.any():
        raise FaultyAnswerError(f"it says {said[wrong]}, plain Pinocchio finds {largest[wrong]}")


def check_numbers(question: Question, q: np.ndarray, rows: Sequence[int]) -> None:
    """What must be true of the configurations (n, nq) from these starts, whatever the targets are."""
    robot, options = question.robot, question.options
    if q.shape != (len(rows), robot.model.nq) or not np.isfinite(q).all():
        raise FaultyAnswerError(f"not finite: {q}")
    outside, off = outside_rows(robot, q)
    if options["limits"] and outside:
        raise FaultyAnswerError(f"outside the limits: {outside}")
    if off:
        raise FaultyAnswerError(f"not of unit length: {off}")
    starts = np.array([question.starts[i] for i in rows])
    still = [entry for joint in still_joints(question) for entry in range(joint.idx_q, joint.idx_q + joint.nq)]
    moved = q != starts
    if options["limits"]:  # a start outside them is moved inside
        moved &= (robot.lower_q <= starts) & (starts <= robot.upper_q)
    for i in np.flatnonzero(moved[:, still].any(axis=1)):
        raise FaultyAnswerError(f"entries {still} of q must stay at {starts[i, still]}, and are {q[i, still]}")


def still_joints(question: Question) -> list[pinik.Joint]:
    """The joints that are locked, or that, like all that follow them, move no target's frame against its reference."""
    robot, model = question.robot, question.robot.model
    moving: set[int] = set()
    for target in question.sets[0]:
        frames = [model.frames[robot.frame_id(name)] for name in (target.frame, target.relative_to) if name]
        supports = [set(model.supports[frame.parentJoint]) for frame in frames]
        moving |= functools.reduce(operator.xor, supports)
    leading = {joint.leader or joint.name for joint in robot.joints if joint.id in moving}
    own = {joint.name for joint in robot.joints if joint.id in moving}
    movable = (leading | own) - set(question.options["locked"])
    return [joint for joint in robot.joints if joint.nq and joint.name not in movable]


def check_claim(question: Question, targets: list[pinik.Target], q: np.ndarray, status: pinik.Status) -> None:
    """Whether all targets are within tolerance is what plain Pinocchio finds, to the last digit."""
    tolerance = question.options["tolerance"]
    found = [pinik.TargetError(*error) for error in plain_errors(question.robot, targets, q, tolerance)]
    pairs = zip(found, targets, strict=True)
    within = all(error.within(target.tolerance or pinik.Tolerance.of(tolerance)) for error, target in pairs)
    if within is not (status is pinik.Status.CONVERGED):
        raise FaultyAnswerError(f"it says {status.name}, plain Pinocchio finds {found}")


def check_by_the_judge(question: Question, targets: list[pinik.Target], solution: pinik.Solution) -> None:
    """The errors that the judge finds, who reads the file himself."""
    found = judge(question.robot, targets, solution.q)
    blur = float(rounding(question.robot, solution.q[np.newaxis])[0])
    for said, miss, target in zip(solution.errors, found.each, targets, strict=True):
        if miss.position is not None and not math.isclose(said.position, miss.position, rel_tol=1e-9, abs_tol=blur):
            raise FaultyAnswerError(f"it says {said}, the judge {miss}")
        if miss.orientation is not None and not abs(said.orientation - miss.orientation) <= turn_rounding(target, blur):
            raise FaultyAnswerError(f"it says {said}, the judge {miss}")
