"""What a robot reaches of a list of places, such as those on a workpiece."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..model.robot_model import RobotModel
from ..solving.many import Solutions, solve_many
from ..solving.origin import Origin
from ..solving.sampling import Sampler
from .measures import manipulabilities, rooms

__all__ = ["ReachedTargets", "reach_targets"]

Array = NDArray[np.float64]

_SAMPLES = 4096  # from which the robot's best manipulability is taken
_STARTS = 8


@dataclass(frozen=True, eq=False)
class ReachedTargets:
    """What a robot reaches of a list of targets, and how well.

    Attributes:
        reached: Whether each target is reached (N,).
        q: For each target the best answer found, or the nearest configuration where none was (N, nq).
        manipulability: √det(J Jᵀ) at the answers (N,); NaN where there is none.
        room: The distance to the joint limits at the answers, 0 at a limit and 1 with all joints in the middle (N,).
        score: 0 for a target that is missed; else the square root of `room` times the manipulability as a share of
            `best`, at most 1 (N,).
        best: The robot's largest manipulability among 4096 random configurations.
        solutions: The first answer to each target, with errors and messages.
    """

    reached: NDArray[np.bool_]
    q: Array
    manipulability: Array
    room: Array
    score: Array
    best: float
    solutions: Solutions = field(repr=False)

    def __len__(self) -> int:
        """The number of targets."""
        return len(self.reached)

    @property
    def success(self) -> bool:
        """Whether all targets are reached."""
        return bool(self.reached.all())

    def __str__(self) -> str:
        words = f"{int(self.reached.sum())} of {len(self)} targets reached; mean score {self.score.mean():.2f}"
        if not self.success:
            words += ", with 0 for those that are missed"
        if self.reached.any():
            worst = int(np.flatnonzero(self.reached)[np.argmin(self.score[self.reached])])
            words += f", lowest {'' if self.success else 'of the others '}{self.score[worst]:.2f} at target {worst}"
        return words


def reach_targets(
    robot: RobotModel,
    targets: Any,
    places: Any = None,
    *,
    q0: Any = None,
    locked: Iterable[str] = (),
    limits: bool = True,
    seed: int = 0,
    **options: Any,
) -> ReachedTargets:
    """Solve for each target from several starts, and keep the answer with the highest score.

    The arguments are those of `pinik.solve_many`, which is called for each start.

    Raises:
        InputError: There is no target, or there are several frames in one.
    """
    options |= {"locked": tuple(locked), "limits": limits}
    start = Origin.of(robot, q0, searches=False).q
    first = solve_many(robot, targets, places, q0=start, seed=seed, **options)
    if first.prepared is None or len(first.prepared.targets) != 1:
        raise InputError("there must be at least one target, and each must be for one frame", argument="targets")
    (pattern,) = first.prepared.targets
    sampler = Sampler(robot, pattern, start, locked=locked, limits=limits, seed=seed)
    rows = 6 if pattern.asks_orientation else 3
    samples = sampler.configurations(0, _SAMPLES)
    best = float(manipulabilities(sampler, samples, rows).max())
    kept = _measured(sampler, first, rows, best)
    for k, own in enumerate(samples[: _STARTS - 1], start=1):
        other = _measured(sampler, solve_many(robot, targets, places, q0=own, seed=seed + k, **options), rows, best)
        wins = other["reached"] & (~kept["reached"] | (other["score"] > kept["score"]))
        for name, values in kept.items():
            values[wins] = other[name][wins]
    return ReachedTargets(**kept, best=best, solutions=first)


def _measured(sampler: Sampler, answers: Solutions, rows: int, best: float) -> dict[str, NDArray[Any]]:
    """The arrays of `ReachedTargets` for one answer to each target."""
    reached, q = answers.success, answers.q
    manipulability = np.where(reached, manipulabilities(sampler, q, rows), np.nan)
    room = np.where(reached, rooms(sampler, q), np.nan)
    share = np.minimum(manipulability / best, 1.0) if best > 0.0 else np.zeros(len(q))
    score = np.where(reached, np.sqrt(share * room), 0.0)
    return {"reached": reached, "q": q.copy(), "manipulability": manipulability, "room": room, "score": score}
