"""Jumps and excessive speeds along a path, each by index and joint, with the reason."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..problem.kinematics import Kinematics
from .changes import JUMP_FLOOR, asked_step, is_jump, joint_change
from .native.codec import targets_of
from .question import Question

__all__ = ["Excess", "Jump", "find_excesses", "find_jumps"]

Array = NDArray[np.float64]

SINGULAR = 0.03
"""A place is singular if the smallest singular value of J is below this part of the largest."""

_SAMPLES = 9  # configurations between two neighbours at which the singular values are computed
_RANK = 1e-6  # relative to the largest singular value


@dataclass(frozen=True)
class Jump:
    """A change between two neighbours on a path that is far larger than the target's motion asks for.

    Attributes:
        index: The index of the second of the two points.
        changes: Joint → its change [rad or m], for the joints that moved far, the largest change first.
        why: "limit" if joints would have had to cross their limits, "singular" if the way leads through or near a
            singular place, else "branch": the path continues on another branch, which a restart found.
        limits: Joint → "lower" or "upper", for the joints that would have had to cross their limits.
        conditioning: The smallest singular value of J divided by the largest, the least on the way.
    """

    index: int
    changes: dict[str, float]
    why: str
    limits: dict[str, str]
    conditioning: float

    def __str__(self) -> str:
        moved = ", ".join(f"{name} by {change:+.2g}" for name, change in list(self.changes.items())[:3])
        if self.why == "limit":
            why = " and ".join(f"{name} came to its {side} limit" for name, side in self.limits.items())
        elif self.why == "singular":
            why = f"the arm came to a singular place (smallest singular value {self.conditioning:.2g} of the largest)"
        else:
            why = "the path continues on another branch"
        return f"jump at {self.index}: {moved}; {why}"

    def to_dict(self) -> dict[str, Any]:
        """The JSON form; docs/json.md explains the fields."""
        return asdict(self)


@dataclass(frozen=True)
class Excess:
    """A joint that would have to move faster than it can.

    Attributes:
        index: The index of the point at the end of the motion.
        joint: The name of the joint.
        speed: The speed that the times ask for [rad/s or m/s].
        limit: The largest velocity of the joint [rad/s or m/s].
    """

    index: int
    joint: str
    speed: float
    limit: float

    @property
    def factor(self) -> float:
        """The speed divided by the limit."""
        return self.speed / self.limit

    def __str__(self) -> str:
        return f"{self.joint} is {self.factor:.3g} times too fast at {self.index}"

    def to_dict(self) -> dict[str, Any]:
        """The JSON form; docs/json.md explains the fields."""
        numbers = {"speed": self.speed, "limit": self.limit, "factor": self.factor}
        return asdict(self) | {name: number if math.isfinite(number) else None for name, number in numbers.items()}


def find_jumps(question: Question, goals: Array, q: Array, angles: Array, restarts: NDArray[np.int64]) -> list[Jump]:
    """Find the jumps between neighbours on a path.

    Args:
        question: The kinds of the targets, and the options.
        goals: The numbers of the targets (N, targets, 18).
        q: The configurations (M, nq) of the first M points.
        angles: Their angles (M, n_joints), unwound.
        restarts: The number of restarts that each point used (M,).
    """
    problem = question.problem
    suspects = list(_suspects(question, angles))
    if not suspects:
        return []
    judge = _Judge(question)
    jumps = []
    for index in suspects:
        before, after = q[index - 1], q[index]
        judge.kinematics.retarget(targets_of(problem.targets, goals[index]))
        if is_jump(judge.kinematics, before, after):
            jumps.append(judge.jump(index, before, after, bool(restarts[index])))
    return jumps


def find_excesses(names: tuple[str, ...], angles: Array, times: Array, limits: Array) -> list[Excess]:
    """Find the joints that would have to move faster than they can, in the order of the points.

    Args:
        names: The names of the joints.
        angles: Their angles (M, n_joints), unwound [rad or m].
        times: The times of the points (N,) [s], N at least M.
        limits: Their largest velocities (n_joints,) [rad/s or m/s].
    """
    with np.errstate(over="ignore"):
        speeds = np.abs(np.diff(angles, axis=0)) / np.diff(times[: len(angles)])[:, np.newaxis]
    return [
        Excess(int(k) + 1, names[j], float(speeds[k, j]), float(limits[j]))
        for k, j in np.argwhere(speeds > limits * (1.0 + 1e-9))
    ]


def _suspects(question: Question, angles: Array) -> Iterator[int]:
    """The indices of points before which a joint changes by more than is always allowed."""
    problem, robot = question.problem, question.robot
    moving = {coordinate.joint.name: coordinate.joint for coordinate in problem.coordinates}
    if not all(joint.has_one_axis for joint in moving.values()):
        yield from range(1, len(angles))
        return
    floors = np.full(len(robot.joint_names), math.inf)
    for column, name in enumerate(robot.joint_names):
        if name in moving:
            floors[column] = JUMP_FLOOR * (problem.size_of_chain if moving[name].kind == "prismatic" else 1.0)
    yield from (int(k) + 1 for k in np.flatnonzero((np.abs(np.diff(angles, axis=0)) > floors).any(axis=1)))


class _Judge:
    """Finds the reasons of jumps for one question."""

    def __init__(self, question: Question) -> None:
        self.question = question
        self.kinematics = Kinematics.of(question.problem)
        sigma = self._singular_values(question.robot.random(0))
        self.rank = int((sigma > _RANK * sigma.max(initial=0.0)).sum())

    def jump(self, index: int, before: Array, after: Array, restarted: bool) -> Jump:
        """Describe the jump between two configurations, for the present targets of the kinematics."""
        problem, robot = self.question.problem, self.question.robot
        changes = {c.joint.name: joint_change(c.joint, before, after) for c in problem.coordinates}
        changes = dict(sorted(changes.items(), key=lambda item: -abs(item[1])))
        far = {name: change for name, change in changes.items() if abs(change) > JUMP_FLOOR}
        limits = self._crossed(before)
        parts = np.linspace(0.0, 1.0, _SAMPLES) if not restarted else (0.0, 1.0)
        way = [pinocchio.interpolate(robot.model, before, after, float(part)) for part in parts]
        conditioning = min(self._conditioning(q) for q in way)
        why = "limit" if limits else "singular" if conditioning < SINGULAR else "branch"
        return Jump(index, far or changes, why, limits, conditioning)

    def _crossed(self, before: Array) -> dict[str, str]:
        """The joints that the step towards the targets would take across their limits."""
        limits = self.question.limits
        step = asked_step(self.kinematics.linearize(before))
        crossed = {}
        for coordinate in self.question.problem.coordinates:
            joint = coordinate.joint
            if joint.nq == 1:
                angle = before[joint.idx_q] + step[joint.idx_v]
                if angle < limits.lower[joint.idx_q]:
                    crossed[joint.name] = "lower"
                elif angle > limits.upper[joint.idx_q]:
                    crossed[joint.name] = "upper"
        return crossed

    def _conditioning(self, q: Array) -> float:
        sigma = self._singular_values(q)
        return float(sigma[self.rank - 1] / sigma[0]) if self.rank and sigma[0] > 0.0 else 0.0

    def _singular_values(self, q: Array) -> Array:
        return np.array(np.linalg.svd(self.kinematics.linearize(q).J, compute_uv=False))
