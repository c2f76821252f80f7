"""Two bones in closed form, as a method of `solve`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..two_bone_robot import TwoBone
from .base import Array, SweepingSolver, parameter

if TYPE_CHECKING:
    from ..kinematics import Kinematics
    from ..limits import Limits
    from ..targets import Target, Tolerance

__all__ = ["TwoBoneSolver"]


@dataclass(frozen=True, kw_only=True)
class TwoBoneSolver(SweepingSolver):
    r"""$\theta_1 = \varphi \pm \alpha,\ \theta_2 = \mp\beta'$: see `pinik.two_bone`.

    One sweep, and the frame is at its target, or as near to it as the joints' limits let it come. Only for one
    position of a frame that two parallel hinges move (`pinik.TwoBone`).
    """

    name = "two_bone"
    title = "Two bones, closed form"
    about = "exact and at once; for one position of a frame that two parallel hinges move"
    restarts = 0
    exact = True

    elbow: str = parameter(
        "nearest", "which of two answers inside the limits is taken", choices=("nearest", "up", "down")
    )

    def check(self, kinematics: Kinematics) -> None:
        """See that one position is asked of a frame that two parallel hinges move.

        Raises:
            InputError: It is not so; the message says why.
        """
        _bones(kinematics)

    def sweep(self, q: Array, kinematics: Kinematics, limits: Limits, tolerance: Tolerance) -> tuple[Array, int]:
        """Both joints at once; locked ones stay, as if their limits were where they stand."""
        bones, wanted = _bones(kinematics)
        if self.max_residual < math.inf:
            here = bones.position(q)
            distance = float(np.linalg.norm(wanted - here))
            if distance > self.max_residual:
                wanted = here + (self.max_residual / distance) * (wanted - here)
        now = [joint.angle(q) for joint in bones.joints]
        ranges = [
            (angle, angle) if joint in kinematics.locked else room
            for joint, angle, room in zip(bones.joints, now, bones.ranges(limits), strict=True)
        ]
        there = bones.nearest(wanted, q, ranges, self.elbow)
        changes = [
            math.remainder(joint.angle(there) - angle, math.tau) if joint.nq == 2 else joint.angle(there) - angle
            for joint, angle in zip(bones.joints, now, strict=True)
        ]
        largest = max(map(abs, changes))
        if largest > self.max_step:
            for joint, angle, change in zip(bones.joints, now, changes, strict=True):
                joint.set_angle(there, angle + (self.max_step / largest) * change)
        return there, sum(change != 0.0 for change in changes)


def _bones(kinematics: Kinematics) -> tuple[TwoBone, Array]:
    """The two bones that are asked for, and where their end should be (3,) [m]."""
    target: Target = kinematics.targets[0]
    if len(kinematics.targets) > 1:
        raise InputError(f"two_bone takes one target; got {len(kinematics.targets)}")
    if target.position is None or target.asks_orientation:
        raise InputError(f"two_bone takes a position alone; target {target.frame!r} asks for an orientation")
    robot = kinematics.robot
    if target.tool is not None:
        return TwoBone.of(robot, target.frame, tool=target.tool, relative_to=target.relative_to), target.position
    key = "two_bone", target.frame, target.relative_to
    if key not in robot.kept:
        robot.kept[key] = TwoBone.of(robot, target.frame, relative_to=target.relative_to)
    return robot.kept[key], target.position
