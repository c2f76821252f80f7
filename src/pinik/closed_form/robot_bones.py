"""The closed form for two bones of a robot, in terms of its configurations."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_point, as_points
from ..errors import InputError
from ..model.joint import Joint
from ..model.limits import Limits
from ..model.robot_model import RobotModel
from ..problem.targets import Target
from .planar_arm import ROUNDING, PlanarArm, turn
from .recognise import recognise
from .two_bone import ELBOWS

__all__ = ["OffPlane", "TwoBone", "TwoBoneConfigurations"]

Array = NDArray[np.float64]


class OffPlane(NamedTuple):
    """How far a target lies from the plane in which its frame moves.

    Attributes:
        distance: Signed distance along the normal [m].
        normal: Unit normal of the plane (3,).
        relative_to: The frame in whose axes the normal is expressed; None for the world.
    """

    distance: float
    normal: Array
    relative_to: str | None


@dataclass(frozen=True, eq=False)
class TwoBoneConfigurations:
    """Both answers for one target; those inside the limits come first, then the one nearer to `q0`.

    Attributes:
        q: (2, nq); every other joint is as in `q0`. An answer outside the limits is not moved into them.
        elbows: (2,), "up" or "down" as in `two_bone`, seen with the first joint's axis pointing towards the viewer.
        inside: (2,), whether the answer is inside the joint limits, if need be after whole turns.
        errors: (2,), distance between frame and target, by forward kinematics [m].
        reachable: Whether the target can be reached without the limits.
        shortfall: How far the target is out of reach without the limits [m].
        out_of_plane: Signed distance of the target from the plane in which the frame moves, along the first joint's
            axis [m]; it is part of the shortfall.
        nearest: (nq,), the configuration inside the limits that brings the frame nearest to the target.
        nearest_error: Its distance to the target, by forward kinematics [m].
    """

    q: Array
    elbows: tuple[str, str]
    inside: NDArray[np.bool_]
    errors: Array
    reachable: bool
    shortfall: float
    out_of_plane: float
    nearest: Array
    nearest_error: float


@dataclass(frozen=True, eq=False)
class TwoBone:
    r"""A frame that two hinges with parallel axes move, and no other joint: an arm of two bones anywhere on a robot.

    In the plane normal to the axes, with x along the first bone at $q_1 = 0$, the frame is at
    $l_1 (\cos\theta_1, \sin\theta_1) + l_2 (\cos(\theta_1 + \theta_2), \sin(\theta_1 + \theta_2))$ with
    $\theta_1 = q_1$ and $\theta_2 = \sigma q_2 + \gamma$. σ is −1 where the two axes point in opposite directions, and
    γ is the angle between the bones at $q_2 = 0$. The frame never moves along the axes.

    Attributes:
        robot: The robot.
        frame: The name of the frame.
        joints: The two joints, base first.
        l1, l2: The bones' lengths: from axis to axis, and from the second axis to the frame or its tool [m].
        origin: The point (3,) on the first axis that lies in the plane of motion [m].
        axes: (3, 3), with columns x along the first bone at angle 0, y, and z along the first joint's axis.
        bend: γ [rad].
        sense: σ, 1 or −1.
        tilt: The angle by which the axes differ from parallel [rad]; answers are off by up to tilt · l2.
        tool: SE3 of the point of interest in the frame, or None.
        relative_to: The frame in which positions, `origin` and `axes` are expressed; None for the world.
    """

    robot: RobotModel
    frame: str
    joints: tuple[Joint, Joint]
    l1: float
    l2: float
    origin: Array
    axes: Array
    bend: float
    sense: float
    tilt: float
    tool: pinocchio.SE3 | None = None
    relative_to: str | None = None

    @classmethod
    def of(
        cls,
        robot: RobotModel,
        frame: str,
        *,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
    ) -> TwoBone:
        """Recognise the two bones that move a frame.

        Args:
            robot: The robot.
            frame: The frame that is to reach targets.
            tool: SE3 (or 4×4 matrix) of the point of interest in the frame, or just its position (3,) [m].
            relative_to: The frame in which targets are expressed, nearer to the base; the world when None.

        Raises:
            UnknownNameError: No such frame.
            InputError: The frame is not moved by two parallel hinges alone; the message says why.
        """
        if not isinstance(robot, RobotModel):
            raise InputError(f"robot must be a RobotModel, as pinik.load returns it; got {robot!r}")
        checked = Target(frame, (0.0, 0.0, 0.0), tool=tool, relative_to=relative_to).tool
        bones = recognise(robot, frame, checked, relative_to)
        return cls(robot, frame, *bones, tool=checked, relative_to=relative_to)

    def in_plane(self, positions: ArrayLike) -> tuple[Array, Array]:
        """Project positions onto the plane in which the frame moves; `two_bone` takes the result as targets.

        Args:
            positions: (N, 3) [m], in `relative_to`.

        Returns:
            Coordinates in the plane (N, 2) and signed distances from it (N,) [m].
        """
        seen = (as_points(positions, "positions") - self.origin) @ self.axes
        return seen[:, :2], seen[:, 2]

    def joint_angles(self, angles: ArrayLike) -> Array:
        """The two joints' angles (…, 2) for the angles (…, 2) that `two_bone` returns [rad]; limits are ignored."""
        return self._arm.joint_angles(angles)

    def position(self, q: Array) -> Array:
        """The position of the frame, or of its tool, in `relative_to` by forward kinematics (3,) [m]."""
        placement = self.robot.placement(self.frame, q, self.relative_to)
        return np.array(placement.translation if self.tool is None else placement.act(self.tool.translation))

    def solve(self, position: ArrayLike, q0: ArrayLike | None = None, *, limits: bool = True) -> TwoBoneConfigurations:
        """Both answers for one target, and the nearest configuration inside the limits.

        Args:
            position: Target position (3,) [m], in `relative_to`.
            q0: The configuration (nq,) that gives all other joints, and from which "nearer" is measured; neutral when
                None.
            limits: Whether the joint limits hold.

        Raises:
            InputError: A wrong shape, or a number that is not finite.
        """
        robot, point = self.robot, as_point(position, "position")
        start = robot.neutral() if q0 is None else robot.check_configuration(q0, "q0")
        ranges, now = self.ranges(Limits.of(robot, limits)), self.angles_at(start)
        (slack,), (flat, beside) = self._slack(point[np.newaxis]), self.in_plane(point[np.newaxis])
        ways, missed = self._arm.elbows(flat, now[np.newaxis], slack)
        turns = turn(ways[0], ranges, now)
        inside: NDArray[np.bool_] = np.all(turns.fits, axis=-1)
        values = np.where(inside[:, np.newaxis], turns.inside, turns.angle)
        order = np.lexsort([np.hypot(*(values - now).T), ~inside])
        q = self._configurations(values[order], np.tile(start, (2, 1)))
        nearest = self.nearest(point[np.newaxis], start[np.newaxis], ranges[np.newaxis])[0]
        shortfall = math.hypot(float(missed[0]), float(beside[0]))
        return TwoBoneConfigurations(
            q=q,
            elbows=(ELBOWS[order[0]], ELBOWS[order[1]]),
            inside=inside[order],
            errors=np.array([self._error(each, point) for each in q]),
            reachable=bool(shortfall <= slack),
            shortfall=shortfall,
            out_of_plane=float(beside[0]),
            nearest=nearest,
            nearest_error=self._error(nearest, point),
        )

    def ranges(self, limits: Limits) -> Array:
        """For pinik itself: lower and upper limits of the two joints (2 joints, 2) [rad], infinite without."""
        entries = [joint.idx_q for joint in self.joints]  # a (cos, sin) pair has no bounds
        return np.stack([limits.lower[entries], limits.upper[entries]], axis=-1)

    def angles_at(self, q: Array) -> Array:
        """For pinik itself: the angles of the two joints (…, 2) at configurations (…, nq) [rad]."""
        return np.stack(
            [
                np.arctan2(q[..., joint.idx_q + 1], q[..., joint.idx_q]) if joint.nq == 2 else q[..., joint.idx_q]
                for joint in self.joints
            ],
            axis=-1,
        )

    def nearest(self, positions: Array, q: Array, ranges: Array, elbow: str = "nearest") -> Array:
        """For pinik itself: for each of N targets, the configuration inside `ranges` nearest to it.

        Args:
            positions: Target positions (N, 3) [m], in `relative_to`.
            q: Configurations (N, nq) that give all other joints.
            ranges: Lower and upper limits of the two joints (N, 2 joints, 2) [rad].
            elbow: Which of several equally near answers to take: "up", "down", or the one "nearest" to `q`.

        Returns:
            Configurations (N, nq).
        """
        flat = (positions - self.origin) @ self.axes[:, :2]
        values = self._arm.nearest(flat, self.angles_at(q), ranges, self._slack(positions), elbow)
        return self._configurations(values, q.copy())

    def off_plane(self, position: Array) -> OffPlane:
        """For pinik itself: how far a position (3,) [m] lies from the plane in which the frame moves."""
        return OffPlane(float((position - self.origin) @ self.axes[:, 2]), self.axes[:, 2], self.relative_to)

    @cached_property
    def _arm(self) -> PlanarArm:
        return PlanarArm(self.l1, self.l2, self.bend, self.sense)

    def _slack(self, positions: Array) -> Array:
        """How far rounding and the tilt of the axes may move the frame for each position (N, 3) [m]; (N,) [m]."""
        lengths = self.l1 + self.l2 + np.linalg.norm(self.origin) + np.linalg.norm(positions, axis=-1)
        return np.asarray(ROUNDING * lengths + self.tilt * self.l2)

    def _configurations(self, values: Array, q: Array) -> Array:
        """Write the two joints' angles (N, 2) [rad] into `q` (N, nq), in place; returns `q`."""
        for joint, angles in zip(self.joints, values.T, strict=True):
            if joint.nq == 2:
                q[:, joint.idx_q], q[:, joint.idx_q + 1] = np.cos(angles), np.sin(angles)
            else:
                q[:, joint.idx_q] = angles
        return q

    def _error(self, q: Array, position: Array) -> float:
        return float(np.linalg.norm(self.position(q) - position))
