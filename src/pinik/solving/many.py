"""Many targets at once: arrays in, arrays out, over all cores."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_count, as_many, as_numbers, as_points, as_rotations, as_se3
from ..errors import InputError
from ..model.robot_model import Robot
from ..problem.reach import shortfall
from ..problem.targets import Target, as_targets, largest_of
from ..solvers.base import Solver
from . import native
from .at_once import attempt_at_once, lands_at_once
from .attempts import Outcome, attempt_all
from .prepared import Prepared, prepare
from .solution import Solution
from .state import Status, measure_errors

__all__ = ["Solutions", "solve_many"]

Array = NDArray[np.float64]

_MOST_THREADS = 1024


def solve_many(
    robot: Robot,
    targets: str | Target | Sequence[Target] | Sequence[Sequence[Target]],
    places: ArrayLike | Sequence[pinocchio.SE3] | None = None,
    method: str | type[Solver] | Solver = "dls",
    *,
    q0: ArrayLike | str | None = None,
    threads: int | None = None,
    **options: Any,
) -> Solutions:
    """Solve N questions of the same kind, each for itself.

    The answers do not depend on `threads`: what is drawn is keyed by the seed and by each question's number. Ctrl-C
    stops it at once.

    Args:
        robot: The robot.
        targets: A frame's name or one Target as a pattern, and `places` says where; or N targets of the same kind; or N
            sequences of as many targets of the same kinds.
        places: (N, 4, 4) homogeneous matrices or N SE3, for positions and rotations; or positions (N, 3) [m].
        method: As for `pinik.solve`.
        q0: One start (nq,), or N of them (N, nq); neutral when None; "nearest" for starts near each target, from a
            table.
        threads: How many share the work; one for each processor that is free to this process when None. Of the
            compiled engine; the Python one takes one.
        **options: `pinik.solve`'s (limits, locked, restarts, seed, max_iterations, tolerance, time_limit for each,
            engine) and the solver's own parameters.

    Raises:
        UnknownNameError, InputError, EngineError: As `pinik.solve`, with the number of the first target at fault.
    """
    if not isinstance(robot, Robot):
        raise InputError(f"robot is what pinik.load returns; got {robot!r}")
    if "trace" in options:
        raise InputError("solve_many keeps no trace; pinik.solve does")
    count = _processors() if threads is None else min(as_count(threads, "threads"), _MOST_THREADS)
    began = time.perf_counter()
    pattern, goals = _questions(robot, targets, places)
    prepared = prepare(robot, pattern, method, **options)
    nearest = isinstance(q0, str) and q0 == "nearest"
    starts = _starts(robot, None if nearest else q0, len(goals))
    if prepared.native is not None:
        answers = native.attempt_many(prepared.native, goals, starts, nearest, count)
    elif lands_at_once(prepared.settings) and not nearest:
        answers = attempt_at_once(prepared.settings, goals, starts)
    else:
        answers = _attempt_one_by_one(prepared, goals, starts, nearest)
    return Solutions(**vars(answers), total_time=time.perf_counter() - began, prepared=prepared, _goals=goals)


@dataclass(frozen=True, eq=False)
class Solutions(native.Answers):
    """The answers to N questions, each checked by plain Pinocchio; `solutions[i]` is one as `pinik.solve` gives it.

    Attributes:
        q: The best configurations (N, nq).
        status: Why each solve ended: an array of `Status`.
        position_error: The largest of each question's targets [m]; NaN where none was asked for.
        orientation_error: The same [rad].
        iterations, joint_updates, restarts: Of each question, as in `Solution`.
        time: Seconds that each one took; an equal share of them where all were answered at once.
        total_time: Seconds from call to answer.
        prepared: The kind of question.
    """

    total_time: float
    prepared: Prepared = field(repr=False)
    _goals: Array = field(repr=False)

    @property
    def success(self) -> NDArray[np.bool_]:
        """Whether every target is within tolerance (N,)."""
        return np.array(self.status == Status.CONVERGED, dtype=bool)

    @property
    def engine(self) -> str:
        """Either "python" or "native"."""
        return self.prepared.engine

    def __len__(self) -> int:
        return len(self.q)

    def __str__(self) -> str:
        return f"{int(self.success.sum())} of {len(self)} solved in {self.total_time:.3g} s"

    def __iter__(self) -> Iterator[Solution]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Solution:
        if not isinstance(index, (int, np.integer)):
            raise TypeError(f"solutions are counted by whole numbers, the arrays take slices; got {index!r}")
        prepared, asked = self.prepared, self.prepared.settings
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} solutions; got {index}")
        targets = native.targets_of(prepared.targets, self._goals[index])
        asked.kinematics.retarget(targets)
        missed = self.status[index] is Status.UNREACHABLE
        outcome = Outcome(
            self.status[index],
            self.q[index].copy(),
            measure_errors(prepared.robot, targets, self.q[index]),
            int(self.iterations[index]),
            int(self.joint_updates[index]),
            int(self.restarts[index]),
            shortfall(asked.kinematics, asked.limits, asked.tolerance.position) if missed else None,
            (),
            targets,
            float(self.time[index]),
            prepared.engine,
        )
        return Solution(outcome, asked)


def _questions(robot: Robot, targets: Any, places: Any) -> tuple[tuple[Target, ...], Array]:
    """(a pattern of what is asked each time, the numbers that say where (N, targets, 18))."""
    if places is None:
        if not isinstance(targets, Iterable):
            raise InputError(f"targets is a frame's name, a Target, or a sequence of them; got {targets!r}")
        if isinstance(targets, (str, Target)):
            raise InputError("places says where the frame should be: (N, 4, 4) matrices, N SE3, or positions (N, 3)")
        asked = [as_targets(each) for each in targets]
        if not asked:
            raise InputError("no target was given")
        kind = [target.shape for target in asked[0]]
        for number, each in enumerate(asked):
            if [target.shape for target in each] != kind:
                raise InputError(
                    f"targets[{number}] asks for something else than targets[0]; solve each kind for itself"
                )
        return asked[0], np.array([native.goals_of(each) for each in asked])
    if isinstance(places, Sequence) and any(isinstance(place, pinocchio.SE3) for place in places):
        places = np.array([as_se3(place, f"places[{k}]").homogeneous for k, place in enumerate(places)])
    rotations, points = None, None
    if as_numbers(places, "places").ndim == 3:
        matrices = as_many(places, (4, 4), "places")
        for k in np.flatnonzero((np.abs(matrices[:, 3] - (0.0, 0.0, 0.0, 1.0)) > 1e-9).any(axis=1))[:1]:
            as_se3(matrices[k], f"places[{k}]")
        rotations, points = as_rotations(matrices[:, :3, :3], "places"), as_points(matrices[:, :3, 3], "places")
    else:
        points = as_points(places, "places")
    if not len(points):
        raise InputError("places is empty")
    first = None if rotations is None else rotations[0]
    pattern = Target(targets, points[0], rotation=first) if isinstance(targets, str) else _one(targets)
    if pattern.axis is not None or (pattern.rotation is not None and rotations is None):
        raise InputError(f"places of {pattern.frame!r} say less than the target asks for; give N Target objects")
    goals = np.zeros((len(points), 1, 18))
    if pattern.position is not None:
        goals[:, 0, :3] = points
    if pattern.rotation is not None:
        assert rotations is not None
        goals[:, 0, 3:12] = rotations.reshape(-1, 9)
    return (pattern,), goals


def _one(targets: Any) -> Target:
    if not isinstance(targets, Target):
        raise InputError(f"with places, targets is a frame's name or one Target; got {targets!r}")
    return targets


def _starts(robot: Robot, q0: ArrayLike | None, count: int) -> Array:
    """(1, nq) or (N, nq)."""
    if q0 is None:
        return robot.neutral()[np.newaxis]
    if as_numbers(q0, "q0").ndim != 2:
        return robot.check_configuration(q0, "q0")[np.newaxis]
    starts = robot.check_configurations(q0, "q0")
    if len(starts) != count:
        raise InputError(f"q0 is one start or one for each of the {count} targets; got {len(starts)}")
    return starts


def _attempt_one_by_one(prepared: Prepared, goals: Array, starts: Array, nearest: bool) -> native.Answers:
    outcomes, seconds = [], []
    for number, goal in enumerate(goals):
        began = time.perf_counter()
        settings = prepared.settings._replace(start=starts[number % len(starts)], target=number, nearest=nearest)
        settings.kinematics.retarget(native.targets_of(prepared.targets, goal))
        outcomes.append(attempt_all(settings, began))
        seconds.append(time.perf_counter() - began)
    largest = np.array([largest_of(outcome.errors) for outcome in outcomes], dtype=np.float64)  # None becomes NaN
    return native.Answers(
        np.array([outcome.q for outcome in outcomes]),
        np.array([outcome.status for outcome in outcomes], dtype=object),
        largest[:, 0],
        largest[:, 1],
        np.array([outcome.iterations for outcome in outcomes]),
        np.array([outcome.joint_updates for outcome in outcomes]),
        np.array([outcome.restarts for outcome in outcomes]),
        np.array(seconds),
    )


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
