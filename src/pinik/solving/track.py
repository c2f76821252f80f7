"""A whole path in one call: each point is solved from the last one's answer, on the same branch."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_numbers, as_vector
from ..errors import InputError, UnknownNameError
from ..model.robot_model import RobotModel
from ..problem.targets import Target
from ..problem.tolerance import Tolerance
from ..shapes.avoid import Avoided
from ..solvers.registry import Method
from .attempts import Outcomes
from .data_frame import data_frame
from .joint_bars import joint_bars
from .jumps import Excess, Jump, find_excesses, find_jumps
from .kept import kept_of
from .native.outcomes import follow
from .options import OPTION_NAMES, Options
from .origin import Origin, unwound_path
from .path import careful, follow_path
from .places import read_questions
from .prepared import Prepared
from .state import Status
from .words import check_words

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Track", "track"]

Array = NDArray[np.float64]

ON_MISS = ("hold", "nearest", "stop")

_MISSING = ("trace", "choose", "choose_weights")
_KEYWORDS = (
    "places",
    "q0",
    "times",
    "on_miss",
    "tool",
    "relative_to",
    *(name for name in OPTION_NAMES if name not in _MISSING),
)


def track(
    robot: RobotModel,
    targets: str | Target | Sequence[Target] | Sequence[Sequence[Target]],
    places: ArrayLike | Sequence[pinocchio.SE3] | None = None,
    q0: ArrayLike | Mapping[str, float] | None = None,
    method: Method = "dls",
    *,
    times: ArrayLike | None = None,
    on_miss: str = "hold",
    tool: pinocchio.SE3 | ArrayLike | None = None,
    relative_to: str | None = None,
    limits: bool = True,
    locked: Iterable[str] = (),
    restarts: int | None = None,
    seed: int = 0,
    max_iterations: int | None = None,
    tolerance: Tolerance | ArrayLike | None = None,
    time_limit: float | None = None,
    engine: str = "auto",
    polish: bool = True,
    avoid: Avoided = None,
    **solver_parameters: Any,
) -> Track:
    """Follow a path of N points in one call.

    Each point is solved from the answer to the last one, by a run that stays inside the limits and on its branch. If
    that misses, the target is approached in smaller steps; only then are restarts tried, and the answer nearest to the
    last configuration is taken. `Track.jumps` reports every change that is far larger than the target's motion asks
    for, with the reason. CCD moves each joint by at most 0.05 rad per update along a path.

    Args:
        robot: The robot.
        targets: The name of a frame, or one Target as a pattern, with the N targets in `places`; or N targets of the
            same kind; or N sequences with the same number of targets of the same kinds.
        places: (N, 4, 4) homogeneous matrices or N SE3, for positions and rotations; or positions (N, 3) [m],
            with None along axes that are free, the same ones in all places.
        q0: The start, from which the first point is solved: a configuration (nq,), or angles by joint name; neutral
            when None. The way to the first point is not part of the path, and is never reported as a jump.
        method: As for `pinik.solve`.
        times: When each point is reached (N,) [s], increasing; then `Track.too_fast` names the joints that would have
            to exceed `robot.velocity_limits`.
        on_miss: What happens at a point that is missed: "hold" keeps the last configuration that reached its point,
            "nearest" takes the nearest configuration found and goes on from there, "stop" ends the path with this
            point, at which the last configuration is kept.
        tool, relative_to: As for `Target`; only with the name of a frame.
        limits, locked, restarts, seed, max_iterations, tolerance, engine, polish: As for `pinik.solve`.
        avoid: As for `pinik.solve`: a point at which something touches is a miss. What lies between two points is not
            looked at.
        time_limit: Time limit for each point [s].
        **solver_parameters: Parameters of the solver.

    Raises:
        UnknownNameError, InputError, EngineError: As for `pinik.solve`, with the index of the first faulty target.
    """
    if not isinstance(robot, RobotModel):
        raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
    if "trace" in solver_parameters:
        raise InputError("track keeps no trace; pinik.solve does")
    check_words(method, solver_parameters, _KEYWORDS)
    if on_miss not in ON_MISS:
        raise UnknownNameError("on_miss", on_miss, ON_MISS)
    options = Options.of(
        method, solver_parameters, limits=limits, locked=locked, restarts=restarts, seed=seed,
        max_iterations=max_iterations, tolerance=tolerance, time_limit=time_limit, engine=engine,
        polish=polish, avoid=avoid,
    )  # fmt: skip
    began = time.perf_counter()
    pattern, goals = read_questions(targets, places, tool, relative_to)
    if not len(goals):
        raise InputError("a path must have at least one point; got none")
    when = None if times is None else _check_times(times, len(goals))
    origin = Origin.of(robot, q0, searches=False)
    prepared = kept_of(robot).prepared(robot, pattern, careful(options))
    native = prepared.native
    if native is None:
        outcomes = follow_path(prepared, goals, origin.q, on_miss)
    else:
        outcomes = follow(native, goals, origin.q, on_miss)
    angles = unwound_path(robot, outcomes.q, origin.q, origin.turned)
    jumps = find_jumps(prepared.question, goals, outcomes.q, angles, outcomes.restarts)
    excesses = [] if when is None else find_excesses(robot.joint_names, angles, when, robot.velocity_limits)
    total = time.perf_counter() - began
    return Track(
        **vars(outcomes), angles=angles, asked=len(goals), jumps=tuple(jumps), times=when, too_fast=tuple(excesses),
        on_miss=on_miss, total_time=total, prepared=prepared,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Track(Outcomes):
    """A path in joint space: one configuration for each of M points, each checked by plain Pinocchio.

    M is N, the number of points asked for, unless `on_miss="stop"` ended the path at a point that was missed.

    Attributes:
        q: The configurations (M, nq), inside the limits.
        angles: The angles (M, n_joints) [rad or m], in the order of `robot.joint_names`. Those of continuous joints
            are unwound: they go on beyond ±π, from the start's angle.
        status: What came of each point: an array (M,) of `Status`. A point that was missed has the configuration that
            `on_miss` says.
        position_error: The largest position error of each point's targets (M,) [m], at its configuration; NaN if there
            are no positions.
        orientation_error: The largest orientation error, likewise (M,) [rad].
        iterations, joint_updates, restarts: As in `Solution`, for each point (M,). CCD's updates are not counted here.
        time: The time that each point took (M,) [s].
        jumps: The changes between neighbours that are far larger than the target's motion asks for: more than 0.1 rad,
            and more than 0.1 rad plus three times the step Jᵀ(JJᵀ + λ²I)⁻¹e from one configuration to the next
            target, with λ = 0.02 ‖J‖. Metres count per length of the chain.
        times: When each point is reached (N,) [s]; None if no times were given.
        too_fast: The joints that would have to exceed their largest velocities, by index; empty without `times`.
        asked: The number of points asked for, N.
        on_miss: "hold", "nearest" or "stop".
        total_time: The duration of the call [s].
        prepared: The compiled problem.
    """

    angles: Array
    asked: int
    jumps: tuple[Jump, ...]
    times: Array | None
    too_fast: tuple[Excess, ...]
    on_miss: str
    total_time: float
    prepared: Prepared = field(repr=False)

    @property
    def reached(self) -> NDArray[np.bool_]:
        """Whether all targets of each point are within tolerance (M,)."""
        return np.array(self.status == Status.CONVERGED, dtype=bool)

    @property
    def success(self) -> bool:
        """Whether all N points were reached, and there is no jump."""
        return len(self) == self.asked and bool(self.reached.all()) and not self.jumps

    @property
    def robot(self) -> RobotModel:
        """The robot."""
        return self.prepared.robot

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The names of the joints, in the order of the columns of `angles`."""
        return self.robot.joint_names

    @property
    def engine(self) -> str:
        """The engine that was used: "python" or "native"."""
        return self.prepared.engine

    def __len__(self) -> int:
        return len(self.q)

    def __bool__(self) -> bool:
        return self.success

    def __str__(self) -> str:
        missed = np.flatnonzero(~self.reached)
        words = [f"{int(self.reached.sum())} of {self.asked} points reached in {self.total_time:.3g} s"]
        if len(missed):
            count = "the first miss" if len(missed) > 1 else "the miss"
            ends = ", where the path ends" if len(self) < self.asked else ""
            words.append(f"{count} is at {missed[0]} ({self.status[missed[0]]}){ends}")
        words += [str(jump) for jump in self.jumps[:3]]
        if len(self.jumps) > 3:
            words.append(f"and {len(self.jumps) - 3} more jumps")
        if self.too_fast:
            words.append(str(max(self.too_fast, key=lambda excess: excess.factor)))
        return "; ".join(words)

    def _repr_html_(self) -> str:
        """The joints as bars between their limits, each with the band that the path covers, as notebooks show them."""
        return joint_bars(self.prepared.robot, str(self), self.success, self.angles)

    def to_frame(self) -> DataFrame:
        """A data frame of pandas with one row for each point: the joints' `angles`, then what came of it.

        Its index is `times`, if they were given.

        Raises:
            MissingExtraError: pandas is not installed.
        """
        others = {
            "reached": self.reached,
            "status": [status.name for status in self.status],
            "position_error_m": self.position_error,
            "orientation_error_rad": self.orientation_error,
            "iterations": self.iterations,
            "restarts": self.restarts,
        }
        return data_frame(
            self.joint_names, self.angles, others, None if self.times is None else self.times[: len(self)]
        )

    def to_dict(self) -> dict[str, Any]:
        """The JSON form, made of plain numbers, strings, lists and dicts; docs/json.md explains the fields."""
        question = self.prepared.question
        return {
            "schema": 1,
            "robot": self.prepared.robot.name,
            "frames": [target.frame for target in question.problem.targets],
            "success": self.success,
            "message": str(self),
            "points": self.asked,
            "reached": int(self.reached.sum()),
            "joint_names": list(self.joint_names),
            "angles": self.angles.tolist(),
            "status": [status.name for status in self.status],
            "position_error_m": [_number_or_none(error) for error in self.position_error.tolist()],
            "orientation_error_rad": [_number_or_none(error) for error in self.orientation_error.tolist()],
            "jumps": [jump.to_dict() for jump in self.jumps],
            "too_fast": [excess.to_dict() for excess in self.too_fast],
            "on_miss": self.on_miss,
            "time_s": self.total_time,
            "method": question.solver.name,
            "engine": self.engine,
        }


def _check_times(times: ArrayLike, count: int) -> Array:
    """Check the times of `count` points (count,) [s], which must increase."""
    if as_numbers(times, "times").shape != (count,):
        raise InputError(f"times must be one number for each of the {count} points; got shape {np.shape(times)}")
    when = as_vector(times, count, "times")
    for k in np.flatnonzero(np.diff(when) <= 0.0)[:1]:
        raise InputError(f"times must increase; got {when[k]:g} and then {when[k + 1]:g} at index {k + 1}")
    return when


def _number_or_none(number: float) -> float | None:
    return number if np.isfinite(number) else None
