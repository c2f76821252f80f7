"""Many targets in one call, as arrays, on all processor cores."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_count, as_numbers
from ..errors import InputError
from ..model.robot_model import RobotModel
from ..problem.reach import shortfall
from ..problem.targets import Target
from ..problem.tolerance import Tolerance, largest_of
from ..shapes.avoid import Avoided
from ..solvers.registry import Method
from .at_once import attempt_at_once, lands_at_once
from .attempts import Outcome, Outcomes
from .data_frame import data_frame
from .joint_bars import joint_bars
from .native.codec import targets_of
from .native.outcomes import attempt_many
from .options import OPTION_NAMES, Options
from .origin import Origin, as_start, is_nearest, unwound_rows
from .places import read_questions
from .prepared import Prepared
from .processors import processors
from .solution import Solution
from .state import Status
from .verdict import measure_errors
from .words import check_words

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Solutions", "attempt_all", "solve_many"]

Array = NDArray[np.float64]

_MOST_THREADS = 1024

_KEYWORDS = ("places", "tool", "relative_to", "q0", "threads", *(name for name in OPTION_NAMES if name != "trace"))


def solve_many(
    robot: RobotModel,
    targets: str | Target | Sequence[Target] | Sequence[Sequence[Target]],
    places: ArrayLike | Sequence[pinocchio.SE3] | None = None,
    method: Method = "dls",
    *,
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    q0: ArrayLike | Mapping[str, float] | str | None = None,
    threads: int | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    polish: bool = True,
    choose: str = "first",
    choose_weights: Mapping[str, float] | None = None,
    avoid: Avoided = None,
    **solver_parameters: Any,
) -> Solutions:
    """Solve N problems of the same kind, independently of each other.

    The answers do not depend on `threads`: random starts depend only on the seed and on the index of each problem.
    Ctrl-C stops the call at once.

    Args:
        robot: The robot.
        targets: The name of a frame, or one Target as a pattern, with the N targets in `places`; or N targets of the
            same kind; or N sequences with the same number of targets of the same kinds.
        places: (N, 4, 4) homogeneous matrices or N SE3, for positions and rotations; or positions (N, 3) [m],
            with None along axes that are free, the same ones in all places.
        method: As for `pinik.solve`.
        tool, relative_to: As for `Target`; only with the name of a frame.
        q0: One start (nq,) or N starts (N, nq); angles by joint name, with all other joints neutral; neutral when None;
            "nearest" for a start near each target, from a table.
        threads: The number of threads; one for each processor available to this process when None. The Python engine
            uses one thread.
        limits, locked, restarts, seed, max_iterations, tolerance, engine, polish, choose, choose_weights, avoid: As for
            `pinik.solve`.
        time_limit: Time limit for each problem [s].
        **solver_parameters: Parameters of the solver.

    Raises:
        UnknownNameError, InputError, EngineError: As for `pinik.solve`, with the index of the first faulty target.

    Warns:
        InputWarning: Rotation matrices in `places` were rounded and replaced, as by `Target`; one warning for all.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    if "trace" in solver_parameters:
        raise InputError("solve_many keeps no trace; pinik.solve does")
    check_words(method, solver_parameters, _KEYWORDS)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine,
        polish=polish, choose=choose, choose_weights=choose_weights, avoid=avoid,
    )  # fmt: skip
    count = processors() if threads is None else min(as_count(threads, "threads"), _MOST_THREADS)
    began = time.perf_counter()
    pattern, goals = read_questions(targets, places, tool, relative_to, count)
    starts, turned = _starts(robot, q0, len(goals))
    prepared = Prepared(robot, pattern, options) if pattern else None
    outcomes = _nothing(robot) if prepared is None else attempt_all(prepared, goals, starts, is_nearest(q0), count)
    seconds = time.perf_counter() - began
    return Solutions(
        **vars(outcomes), total_time=seconds, prepared=prepared, _goals=goals, _starts=starts, _turned=turned
    )


def attempt_all(
    prepared: Prepared, goals: Array, starts: Array, nearest: bool, threads: int, *, numbered: bool = True
) -> Outcomes:
    """Solve for goals of the same kinds, independently of each other.

    Args:
        prepared: The compiled problem.
        goals: The numbers of the targets (N, targets, 18).
        starts: One start for each, or one for all (N or 1, nq).
        nearest: Whether each starts from the configuration of the table that is nearest to its targets.
        threads: The number of threads of the compiled engine.
        numbered: Whether the number of each question seeds its random starts; otherwise each is answered as if it were
            alone, so that its answer does not depend on its place among the others.
    """
    if prepared.native is not None:
        return attempt_many(prepared.native, goals, starts, nearest, threads, numbered)
    if lands_at_once(prepared.question) and not nearest:
        return attempt_at_once(prepared.question, goals, starts)
    return _attempt_one_by_one(prepared, goals, starts, nearest, numbered)


def _nothing(robot: RobotModel) -> Outcomes:
    """What no solves came to."""
    none, counts = np.zeros(0), np.zeros(0, dtype=np.int64)
    status = np.zeros(0, dtype=object)
    return Outcomes(np.zeros((0, robot.model.nq)), status, none, none, counts, counts, counts, counts, none)


@dataclass(frozen=True, eq=False)
class Solutions(Outcomes):
    """The answers to N questions, each checked by plain Pinocchio. `solutions[i]` is what `pinik.solve` returns.

    Any thread may read it. The arrays belong to the caller, and `solutions[i]` is made from them when it is read.

    Attributes:
        q: The best configurations (N, nq).
        status: The reason why each solve ended: an array (N,) of `Status`.
        position_error: The largest position error of each problem's targets (N,) [m]; NaN if there are no positions.
        orientation_error: The largest orientation error, likewise (N,) [rad].
        iterations, joint_updates, restarts, chosen_from: As in `Solution`, for each problem (N,).
        time: The duration of each solve (N,) [s]; equal shares of the total if one vectorised call solved all.
        total_time: The duration of the call [s].
        prepared: The compiled problem; None if `solve_many` was called without any targets.
    """

    total_time: float
    prepared: Prepared | None = field(repr=False)
    _goals: Array = field(repr=False)
    _starts: Array = field(repr=False)
    _turned: Mapping[str, float] = field(repr=False)

    @property
    def success(self) -> NDArray[np.bool_]:
        """Whether every target is within tolerance, and nothing touches that was to be avoided (N,)."""
        return np.array(self.status == Status.CONVERGED, dtype=bool)

    @property
    def angles(self) -> Array:
        """The angles (N, n_joints) at `q`, in the order of `robot.joint_names` [rad or m].

        Continuous joints are at the whole turn nearest to their start.
        """
        if self.prepared is None:
            return np.zeros((0, 0))
        return unwound_rows(self.prepared.robot, self.q, self._starts, self._turned)

    @property
    def engine(self) -> str:
        """The engine that was used: "python" or "native"."""
        return "python" if self.prepared is None else self.prepared.engine

    def __len__(self) -> int:
        return len(self.q)

    def __str__(self) -> str:
        return f"{int(self.success.sum())} of {len(self)} solved in {self.total_time:.3g} s"

    def _repr_html_(self) -> str:
        """The joints as bars between their limits, each with the band of all answers, as notebooks show them."""
        if self.prepared is None:
            return str(self)
        return joint_bars(self.prepared.robot, str(self), bool(self.success.all()), self.angles)

    def to_frame(self) -> DataFrame:
        """A data frame of pandas with one row for each problem: the joints' `angles`, then what came of it.

        Raises:
            MissingExtraError: pandas is not installed.
        """
        names = () if self.prepared is None else self.prepared.robot.joint_names
        others = {
            "success": self.success,
            "status": [status.name for status in self.status],
            "position_error_m": self.position_error,
            "orientation_error_rad": self.orientation_error,
            "iterations": self.iterations,
            "restarts": self.restarts,
            "time_s": self.time,
        }
        return data_frame(names, self.angles, others)

    def __iter__(self) -> Iterator[Solution]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Solution:
        if not isinstance(index, (int, np.integer)):
            raise TypeError(f"index must be a whole number; slice the arrays of the solutions instead; got {index!r}")
        if not -len(self) <= index < len(self) or self.prepared is None:
            raise IndexError(f"there are {len(self)} solutions; got index {index}")
        question = self.prepared.question
        targets = targets_of(question.problem.targets, self._goals[index])
        missed = self.status[index] is Status.UNREACHABLE
        tolerance = question.options.tolerance
        outcome = Outcome(
            self.status[index],
            self.q[index].copy(),
            self._starts[index % len(self._starts)],
            measure_errors(question.robot, targets, self.q[index], tolerance),
            int(self.iterations[index]),
            int(self.joint_updates[index]),
            int(self.restarts[index]),
            int(self.chosen_from[index]),
            shortfall(targets, question.bounds, tolerance) if missed else None,
            (),
            targets,
            float(self.time[index]),
            self.engine,
        )
        return Solution(outcome, question, self._turned)


def _starts(robot: RobotModel, q0: Any, count: int) -> tuple[Array, Mapping[str, float]]:
    """(the starts (1, nq) or (N, nq), checked; the angles of continuous joints that were given by their angle)."""
    if q0 is None or isinstance(q0, (Mapping, str)) or as_numbers(q0, "q0").ndim != 2:
        origin = Origin.of(robot, q0)
        return origin.q[np.newaxis], origin.turned
    starts = as_start(robot.check_configurations(q0, "q0"))
    if len(starts) != count:
        raise InputError(f"q0 must be one start, or one for each of the {count} targets; got {len(starts)}")
    return starts, {}


def _attempt_one_by_one(prepared: Prepared, goals: Array, starts: Array, nearest: bool, numbered: bool) -> Outcomes:
    attempts, pattern = prepared.attempts, prepared.targets
    outcomes = [
        attempts(targets_of(pattern, goal), starts[k % len(starts)], number=k if numbered else 0, nearest=nearest)
        for k, goal in enumerate(goals)
    ]
    largest = np.array([largest_of(outcome.errors) for outcome in outcomes], dtype=np.float64)  # None becomes NaN
    largest = largest.reshape(-1, 2)
    return Outcomes(
        np.array([outcome.q for outcome in outcomes]).reshape(len(outcomes), prepared.robot.model.nq),
        np.array([outcome.status for outcome in outcomes], dtype=object),
        largest[:, 0],
        largest[:, 1],
        np.array([outcome.iterations for outcome in outcomes], dtype=np.int64),
        np.array([outcome.joint_updates for outcome in outcomes], dtype=np.int64),
        np.array([outcome.restarts for outcome in outcomes], dtype=np.int64),
        np.array([outcome.chosen_from for outcome in outcomes], dtype=np.int64),
        np.array([outcome.time for outcome in outcomes]),
    )
