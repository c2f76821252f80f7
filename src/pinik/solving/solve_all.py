"""The function `solve_all`: every distinct configuration that reaches the targets."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..closed_form.planar_arm import ROUNDING
from ..closed_form.robot_bones import TwoBone
from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.reach import shortfall
from ..problem.target_values import Position
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..shapes.avoid import Avoided
from ..solvers.registry import Method
from .answer import plainly_asked, prepared_for
from .branches import Branches
from .choice import SAME_ANSWER
from .findings import Findings
from .metric import largest_difference
from .native.codec import goals_of, targets_of
from .options import OPTION_NAMES
from .origin import Origin
from .prepared import Prepared
from .solution import Solution
from .spread import NEAREST
from .state import Status
from .verdict import all_within, measure_errors
from .words import UNWEIGHTED, asked_targets

__all__ = ["find_all", "solve_all"]

Array = NDArray[np.float64]

_FIXED = {"trace": False, "polish": True, "choose": "first", "choose_weights": None}
_OPTIONS = tuple(name for name in OPTION_NAMES if name not in _FIXED)


def solve_all(
    robot: RobotModel,
    targets: str | Target | Sequence[Target],
    method: Method = "dls",
    *,
    position: Position | None = None,
    rotation: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    quat_xyzw: ArrayLike | None = None,
    quat_wxyz: ArrayLike | None = None,
    placement: pinocchio.SE3 | ArrayLike | None = None,
    axis: str | ArrayLike | None = None,
    direction: ArrayLike | None = None,
    at: ArrayLike | None = None,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    weight: float = UNWEIGHTED,
    q0: ArrayLike | Mapping[str, float] | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    avoid: Avoided = None,
    **solver_parameters: Any,
) -> Branches:
    """Find all distinct configurations that move frames of the robot to their targets, inside the limits.

    The search is numerical and works for any robot, so it finds all branches in nearly every case, and proves nothing.
    It starts from `q0` and from configurations that are spread as far apart as their frames are near to the targets. A
    run ends as soon as it is heading for a known answer. After 56 starts the search ends if each answer was found at
    least twice, and if three starts for each answer have brought nothing new; after 128 at the latest. The same seed
    gives the same answers.

    If the robot has more joints than the targets need, the answers are infinitely many. Then `q` is a sample that is
    spread over them, and `pinik.self_motion` follows them from there.

    Where answers are usually isolated, a singular target may have both isolated ones and others on curves: so has a UR5
    whose wrist has parallel axes. Then `q` has the isolated ones that were found and a sample of the others,
    `Branches.dimension` tells which is which, and `Branches.redundancy` is the largest dimension.

    If no configuration meets the targets exactly, as with an arm of five joints and a whole pose, the one answer is
    that of `pinik.solve`, inside the tolerance.

    Args:
        robot: The robot.
        targets: The name of a frame, with its target in the keywords from `position` to `weight`; or one or several
            Target objects.
        method: The method, as for `pinik.solve`. "two_bone" knows both answers in closed form, and so all of them.
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight: As for
            `Target`.
        q0: The first start, as for `pinik.solve`, from which the distance of the answers is measured.
        limits: Whether to enforce the joint limits.
        locked: Names of joints that must not move.
        restarts: The maximum number of starts after the first; None means 128, which is also the most.
        seed: The seed of the starts.
        max_iterations: The maximum number of iterations per start.
        tolerance: The errors that count as reached. Answers are exact to 1e-9 rad, and 1e-9 of the chain's length,
            unless no such answer exists.
        time_limit: Time limit of the whole call [s]; a search that it ends keeps what was found.
        engine: "auto", "python" or "native".
        avoid: What the answers must not touch, as for `pinik.solve`. Those that do are left out; `Branches.colliding`
            counts them.
        **solver_parameters: Parameters of the solver.

    Returns:
        The answers, ordered by their distance from `q0`, with what is known of their completeness.

    Raises:
        UnknownNameError, InputError, EngineError: As for `pinik.solve`.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    wanted = (
        position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at, tool, relative_to, weight,
    )  # fmt: skip
    given = (
        limits, locked, NEAREST if restarts is None else restarts, seed, max_iterations, tolerance, time_limit, engine,
        *_FIXED.values(), avoid,
    )  # fmt: skip
    origin = Origin.of(robot, q0, searches=False)
    plain = plainly_asked(robot, targets, method, wanted, given, solver_parameters)
    prepared, quick = plain.prepared, None
    if prepared is not None and prepared.searcher is not None:
        place = plain.place.homogeneous if isinstance(plain.place, pinocchio.SE3) else plain.place
        quick = prepared.searcher.search_at(origin.q, place)
    if prepared is not None and quick is not None:
        found, start, goals = quick
        asked, findings = targets_of(prepared.targets, goals), Findings(*found)
    else:
        asked = asked_targets(targets, wanted, method, solver_parameters, ("q0", *_OPTIONS))
        prepared = prepared_for(robot, asked, method, given, solver_parameters, plain.key)
        start = prepared.question.limits.wrap(origin.q)
        findings = find_all(prepared, asked, start)
    instead = None
    if not len(findings.q):
        instead = prepared.answer(asked, origin, time.perf_counter() - findings.time)
        findings.time = instead.time
        if instead.success:
            distance = largest_difference(robot.model, start, instead.q)
            findings = findings.with_answer(instead.q, distance, instead.errors)
    return _branches(prepared, asked, start, origin.turned, findings, instead)


def find_all(prepared: Prepared, targets: tuple[Target, ...], start: Array) -> Findings:
    """What a search for all answers comes to, for targets of the prepared kinds and a start (nq,) inside the limits."""
    if prepared.options.method.exact:
        return _in_closed_form(prepared, targets, start)
    if prepared.searcher is not None:
        return Findings(*prepared.searcher.search(start, goals_of(targets))[0])
    if shortfall(targets, prepared.question.bounds, prepared.options.tolerance) is not None:
        return Findings.nothing(prepared.robot.model.nq)
    return prepared.search(targets, start)


def _in_closed_form(prepared: Prepared, targets: tuple[Target, ...], start: Array) -> Findings:
    """Both answers of two bones."""
    began = time.perf_counter()
    question, robot = prepared.question, prepared.robot
    (target,) = targets
    bones = TwoBone.of(robot, target.frame, tool=target.tool, relative_to=target.relative_to)
    assert target.position is not None
    both = bones.solve(target.position, start, limits=question.options.limits)
    findings = Findings.nothing(robot.model.nq)
    plane, _ = bones.in_plane(target.position[np.newaxis])
    on_axis = np.linalg.norm(plane) <= ROUNDING * (bones.l1 + bones.l2)
    findings.redundancy = int(on_axis)  # if it is, the first joint may have any angle
    for q, inside in zip(both.q, both.inside, strict=True):
        errors = measure_errors(robot, targets, q, question.options.tolerance)
        is_new = all(largest_difference(robot.model, other, q) > SAME_ANSWER for other in findings.q)
        if not (inside and is_new and all_within(errors, question)):
            continue
        if question.touches(q):
            findings.colliding += 1
        else:
            distance = largest_difference(robot.model, start, q)
            findings = findings.with_answer(q, distance, errors, dimension=findings.redundancy)
    findings.time = time.perf_counter() - began
    return findings


def _branches(
    prepared: Prepared,
    targets: tuple[Target, ...],
    start: Array,
    turned: Mapping[str, float],
    findings: Findings,
    instead: Solution | None = None,
) -> Branches:
    """The branches that a search found, or what a solve found instead."""
    words = None
    if instead is not None:
        words = _words_of_one(findings) if instead.success else instead.message
    return Branches(
        prepared.options.method.exact and not findings.redundancy,
        Status.CONVERGED if instead is None else instead.status,
        findings,
        prepared.question,
        targets,
        start,
        turned,
        prepared.engine,
        words,
    )


def _words_of_one(findings: Findings) -> str:
    """What to say of the one answer that a solve found where the search found none."""
    if findings.colliding:
        return f"1 answer that collides with nothing; the {findings.colliding} that the search found do"
    if findings.ended_early:
        return "1 answer; the time limit ended the search for others, and of what dimension they are is not known"
    return "1 answer inside the tolerance; none that is exact was found"
