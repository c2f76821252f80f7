"""Two parallel hinges of a robot recognised as two bones, and their closed form told in configurations."""

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
from .two_bone import ELBOWS

__all__ = ["OffPlane", "TwoBone", "TwoBoneConfigurations"]

Array = NDArray[np.float64]

_LARGEST_TILT = 1e-5  # [rad]: what a URDF's 1.5708 or 3.14159 may turn an axis away by
_NO_LENGTH = 1e-9  # of the longer bone
_MOST_NAMED = 3  # joints in the way


class OffPlane(NamedTuple):
    """What a target lies beside the plane that its frame cannot leave.

    Attributes:
        distance: Along the normal, signed [m].
        normal: The plane's (3,), of unit length.
        relative_to: The frame in whose axes the normal is; None for the world.
    """

    distance: float
    normal: Array
    relative_to: str | None


@dataclass(frozen=True, eq=False)
class TwoBoneConfigurations:
    """Both elbows of a robot for one target, those inside the limits first, and of these the nearest to `q0`.

    Attributes:
        q: (2, nq): all but the two joints as in `q0`. One outside its limits is told as it is.
        elbows: (2,) "up" or "down", as in `two_bone`, seen with the first joint's axis pointing at one.
        inside: (2,) whether it keeps the joints' limits; a hinge may have been turned by whole turns for that.
        errors: (2,) distance from frame to target by plain forward kinematics [m].
        reachable: Whether the target is in reach, limits aside.
        shortfall: How far it is out of reach, limits aside [m].
        out_of_plane: What the target lies beside the plane in which the frame moves, along the first joint's axis,
            signed [m]; part of the shortfall.
        nearest: (nq,) the configuration inside the limits whose frame is nearest to the target.
        nearest_error: How far that misses it, by plain forward kinematics [m].
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
    r"""Two hinges with parallel axes that alone move a frame: an arm of two bones, wherever it hangs.

    In the plane across the axes, with x along the first bone at $q_1 = 0$, the frame is at
    $l_1 (\cos\theta_1, \sin\theta_1) + l_2 (\cos(\theta_1 + \theta_2), \sin(\theta_1 + \theta_2))$ with
    $\theta_1 = q_1$ and $\theta_2 = \sigma q_2 + \gamma$; σ = −1 where the axes point against each other, γ the angle
    between the bones at $q_2 = 0$. Along the axes it never moves.

    Attributes:
        robot: The robot.
        frame: The frame, by name.
        joints: The two joints, base first.
        l1, l2: The bones: distance from axis to axis, and from the second axis to the frame (or the tool) [m].
        origin: (3,) the point on the first axis in whose plane the frame moves [m].
        axes: (3, 3) columns: x along the first bone at angle 0, y, and the first joint's axis.
        bend: γ [rad].
        sense: σ, 1 or −1.
        tilt: How far the axes are from parallel [rad]; answers miss by up to this part of l2.
        tool: SE3 of the point meant in the frame, or None.
        relative_to: The frame in whose axes positions, `origin` and `axes` are; None for the world.
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
        """Recognise two bones.

        Args:
            robot: The robot.
            frame: The frame that should reach targets.
            tool: SE3 (or 4×4) of the point meant, in the frame; or just its position (3,) [m].
            relative_to: The frame in which targets are expressed, nearer to the base; the world when None.

        Raises:
            UnknownNameError: No such frame.
            InputError: It is not moved by two parallel hinges; the message says which joint is what.
        """
        if not isinstance(robot, RobotModel):
            raise InputError(f"robot is what pinik.load returns; got {robot!r}")
        asked = Target(frame, (0.0, 0.0, 0.0), tool=tool, relative_to=relative_to)
        first, second = joints = _two_hinges(robot, frame, relative_to)
        model = robot.model
        shank = model.jointPlacements[second.id]
        end = model.frames[robot.frame_id(frame)].placement
        end = end.translation if asked.tool is None else end.act(asked.tool.translation)
        axis, own_axis = np.array(first.axis), np.array(second.axis)
        other = shank.rotation @ own_axis
        sense = math.copysign(1.0, float(axis @ other))
        tilt = math.atan2(float(np.linalg.norm(np.cross(axis, other))), abs(float(axis @ other)))
        if tilt > _LARGEST_TILT:
            raise _refusal(frame, f"the axes of {first.name!r} and {second.name!r} are {_degrees(tilt)} from parallel")
        bone = _without(shank.translation, axis)
        tip = shank.rotation @ _without(end, own_axis)
        l1, l2 = float(np.linalg.norm(bone)), float(np.linalg.norm(tip))
        if l1 <= _NO_LENGTH * l2:
            raise _refusal(frame, f"joints {first.name!r} and {second.name!r} turn about the same line")
        if l2 <= _NO_LENGTH * l1:
            raise _refusal(frame, f"it lies on the axis of joint {second.name!r}, which cannot move it; give a tool")
        x = bone / l1
        base = model.jointPlacements[first.id]
        if relative_to is not None:
            base = model.frames[robot.frame_id(relative_to)].placement.actInv(base)
        rise = float(axis @ shank.translation) + sense * float(own_axis @ end)
        y = np.cross(axis, x)
        return cls(
            robot,
            frame,
            joints,
            l1,
            l2,
            origin=base.act(rise * axis),
            axes=base.rotation @ np.column_stack([x, y, axis]),
            bend=math.atan2(float(tip @ y), float(tip @ x)),
            sense=sense,
            tilt=tilt,
            tool=asked.tool,
            relative_to=relative_to,
        )

    def in_plane(self, positions: ArrayLike) -> tuple[Array, Array]:
        """Positions as `two_bone` takes them, for many at once.

        Args:
            positions: (N, 3) [m], in the axes of `relative_to`.

        Returns:
            Their coordinates (N, 2) in the plane in which the frame moves, and what they lie beside it (N,) [m].
        """
        seen = (as_points(positions, "positions") - self.origin) @ self.axes
        return seen[:, :2], seen[:, 2]

    def joint_angles(self, angles: ArrayLike) -> Array:
        """The two joints' angles [rad] for `two_bone`'s: (…, 2) from (…, 2), not turned to where the limits are."""
        return self._arm.joint_angles(angles)

    def position(self, q: Array) -> Array:
        """Where the frame, or the tool in it, is by plain forward kinematics (3,) [m], in `relative_to`'s axes."""
        placement = self.robot.placement(self.frame, q, self.relative_to)
        return np.array(placement.translation if self.tool is None else placement.act(self.tool.translation))

    def solve(self, position: ArrayLike, q0: ArrayLike | None = None, *, limits: bool = True) -> TwoBoneConfigurations:
        """Both elbows for one target, and the nearest point inside the limits.

        Args:
            position: Where the frame should be (3,) [m], in the axes of `relative_to`.
            q0: The other joints' values, and from where the nearest answer is meant (nq,); neutral when None.
            limits: Whether the joints' limits count.

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
        """The two joints' lowest and highest angles (2 joints, 2) [rad], infinite where there are none."""
        entries = [joint.idx_q for joint in self.joints]  # of a (cos, sin) pair neither has bounds
        return np.stack([limits.lower[entries], limits.upper[entries]], axis=-1)

    def angles_at(self, q: Array) -> Array:
        """The two joints' angles (…, 2) [rad] at configurations (…, nq)."""
        return np.stack(
            [
                np.arctan2(q[..., joint.idx_q + 1], q[..., joint.idx_q]) if joint.nq == 2 else q[..., joint.idx_q]
                for joint in self.joints
            ],
            axis=-1,
        )

    def nearest(self, positions: Array, q: Array, ranges: Array, elbow: str = "nearest") -> Array:
        """For each of N targets, the configuration inside `ranges` whose frame is nearest to it, for many at once.

        Args:
            positions: (N, 3) [m], in the axes of `relative_to`.
            q: (N, nq) what the other joints stand at.
            ranges: The two joints' lowest and highest angles (N, 2 joints, 2) [rad].
            elbow: Which is taken where several come as near: "up", "down", or "nearest" to `q`.

        Returns:
            (N, nq).
        """
        flat = (positions - self.origin) @ self.axes[:, :2]
        values = self._arm.nearest(flat, self.angles_at(q), ranges, self._slack(positions), elbow)
        return self._configurations(values, q.copy())

    def off_plane(self, position: Array) -> OffPlane:
        """What a position (3,) [m] lies beside the plane in which the frame moves."""
        return OffPlane(float((position - self.origin) @ self.axes[:, 2]), self.axes[:, 2], self.relative_to)

    @cached_property
    def _arm(self) -> PlanarArm:
        return PlanarArm(self.l1, self.l2, self.bend, self.sense)

    def _slack(self, positions: Array) -> Array:
        """What rounding, and axes not quite parallel, may move the frame by on its way to each (N, 3) [m]."""
        lengths = self.l1 + self.l2 + np.linalg.norm(self.origin) + np.linalg.norm(positions, axis=-1)
        return np.asarray(ROUNDING * lengths + self.tilt * self.l2)

    def _configurations(self, values: Array, q: Array) -> Array:
        """`q` (N, nq) with the two joints' angles (N, 2) [rad] written into it."""
        for joint, angles in zip(self.joints, values.T, strict=True):
            if joint.nq == 2:
                q[:, joint.idx_q], q[:, joint.idx_q + 1] = np.cos(angles), np.sin(angles)
            else:
                q[:, joint.idx_q] = angles
        return q

    def _error(self, q: Array, position: Array) -> float:
        return float(np.linalg.norm(self.position(q) - position))


def _two_hinges(robot: RobotModel, frame: str, relative_to: str | None) -> tuple[Joint, Joint]:
    """The two hinges, base first, that move a frame.

    Raises:
        InputError: There are others, or none; the message names them.
    """
    model = robot.model
    carriers = [model.frames[robot.frame_id(frame)].parentJoint]
    carriers.append(0 if relative_to is None else model.frames[robot.frame_id(relative_to)].parentJoint)
    moving, still = (set(model.supports[carrier]) for carrier in carriers)
    seen = "" if relative_to is None else f" relative to {relative_to!r}"
    if not still <= moving:
        raise _refusal(frame, f"{relative_to!r} has joints of its own that move it relative to {frame!r}")
    movers = [joint for joint in robot.joints if joint.id in moving - still]
    names = ", ".join(f"{joint.name!r} ({joint.kind})" for joint in movers[:_MOST_NAMED])
    if len(movers) > _MOST_NAMED:
        names += f" and {len(movers) - _MOST_NAMED} more"
    if len(movers) != 2:
        number = {0: "no joint moves", 1: "only one joint moves"}.get(len(movers), f"{len(movers)} joints move")
        raise _refusal(frame, f"{number} it{seen}" + (f": {names}" if movers else ""))
    for joint in movers:
        if joint.kind not in ("revolute", "continuous"):
            raise _refusal(frame, f"joint {joint.name!r} is {joint.kind}")
        if joint.leader is not None:
            raise _refusal(frame, f"joint {joint.name!r} mimics {joint.leader!r}")
    return movers[0], movers[1]


def _refusal(frame: str, reason: str) -> InputError:
    return InputError(f"frame {frame!r} is not moved by two parallel hinges alone: {reason}")


def _without(vector: Array, axis: Array) -> Array:
    return np.array(vector - (vector @ axis) * axis)


def _degrees(radians: float) -> str:
    return f"{math.degrees(radians):.3g}°"
