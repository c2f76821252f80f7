"""The closed form for two bones, as a method of `solve`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio

from ..closed_form.robot_bones import OffPlane, TwoBone
from ..errors import InputError
from ..model.robot_model import RobotModel
from .base import Array, SweepingSolver
from .parameter import parameter

if TYPE_CHECKING:
    from ..model.limits import Limits
    from ..problem.kinematics import Kinematics
    from ..problem.problem import Problem
    from ..problem.targets import Target
    from ..problem.tolerance import Tolerance

__all__ = ["TwoBoneSolver"]

_KNOWN: WeakKeyDictionary[RobotModel, dict[tuple[str, str | None], TwoBone]] = WeakKeyDictionary()


@dataclass(frozen=True, kw_only=True)
class TwoBoneSolver(SweepingSolver):
    r"""$\theta_1 = \varphi \pm \alpha,\ \theta_2 = \mp\beta'$: see `pinik.two_bone`.

    One sweep moves the frame to its target, or as near as the joint limits allow. The method solves only for a single
    position of a frame that two parallel hinges move (`pinik.TwoBone`).
    """

    name = "two_bone"
    title = "Two bones, closed form"
    about = "exact, in one step; only for one position of a frame that two parallel hinges move"
    restarts = 0

    elbow: str = parameter(
        "nearest", "which of two solutions inside the limits to take", choices=("nearest", "up", "down"), level=1
    )

    def check(self, problem: Problem) -> None:
        """For pinik itself: check that the only target is a position of a frame that two parallel hinges move.

        Raises:
            InputError: It is not; the message says why.
        """
        _bones(problem.robot, problem.targets)

    @property
    def exact(self) -> bool:
        """For pinik itself: whether `max_residual` is infinite; limits may block a partial step."""
        return self.max_residual == math.inf

    @property
    def lands_at_once(self) -> bool:
        """For pinik itself: whether the first sweep reaches the final configuration."""
        return self.exact and self.max_step == math.inf

    def answers(self, positions: Array, q: Array, problem: Problem, limits: Limits) -> Array:
        """For pinik itself: the configurations (N, nq) inside the limits nearest to positions (N, 3) [m].

        Locked joints keep their values.
        """
        bones, _ = _bones(problem.robot, problem.targets)
        ranges = np.tile(bones.ranges(limits), (len(q), 1, 1))
        for k, joint in enumerate(bones.joints):
            if joint in problem.locked:
                ranges[:, k] = bones.angles_at(q)[:, k, np.newaxis]
        return limits.clip(bones.nearest(positions, q, ranges, self.elbow))

    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """Move both joints at once; this counts as no single-joint update."""
        bones, wanted = _bones(kinematics.robot, kinematics.targets)
        if self.max_residual < math.inf:
            here = bones.position(q)
            distance = float(np.linalg.norm(wanted - here))
            if distance > self.max_residual:
                wanted = here + (self.max_residual / distance) * (wanted - here)
        there: Array = self.answers(wanted[np.newaxis], q[np.newaxis], kinematics.problem, limits)[0]
        if self.max_step < math.inf:
            step = pinocchio.difference(kinematics.model, q, there)
            largest = float(np.abs(step).max())
            if largest > self.max_step:
                there = pinocchio.integrate(kinematics.model, q, (self.max_step / largest) * step)
                if kinematics.problem.held_entries is not None:
                    there[kinematics.problem.held_entries] = q[kinematics.problem.held_entries]
        return there, 0

    def off_plane(self, robot: RobotModel, targets: Sequence[Target]) -> OffPlane:
        """For pinik itself: how far the target lies off the plane in which the two bones move."""
        bones, wanted = _bones(robot, targets)
        return bones.off_plane(wanted)


def _bones(robot: RobotModel, targets: Sequence[Target]) -> tuple[TwoBone, Array]:
    """The two bones that move the target's frame, and the target position (3,) [m]."""
    target = targets[0]
    if len(targets) > 1:
        raise InputError(f"two_bone takes only one target; got {len(targets)}")
    if target.position is not None and not all(target.along):
        raise InputError(f"two_bone takes only a whole position; target {target.frame!r} leaves an axis free")
    if target.position is None or target.asks_orientation:
        raise InputError(f"two_bone takes only a position; target {target.frame!r} has an orientation")
    if target.tool is not None:
        return TwoBone.of(robot, target.frame, tool=target.tool, relative_to=target.relative_to), target.position
    known = _KNOWN.setdefault(robot, {})
    key = target.frame, target.relative_to
    if key not in known:
        known[key] = TwoBone.of(robot, target.frame, relative_to=target.relative_to)
    return known[key], target.position
