r"""Residual and Jacobian of some targets at one configuration.

For a frame at $(p, R)$ wanted at $(p^*, R^*)$ the residual is $e = (p^* - p,\ \log_3(R^* R^\top))$ in world-aligned
axes, and $J\,dq \approx e$. An axis $a$ of the frame along a direction $d$ gives $e = \theta\,n$, the shortest
rotation that takes $a$ to $d$; the spin about $a$ is projected out of its Jacobian.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .coordinates import Coordinate
from .errors import InputError
from .robot import Joint, Robot
from .targets import Target, Tolerance

__all__ = ["Kinematics", "Linearization", "TargetError"]

Array = NDArray[np.float64]

_ALIGNED = pinocchio.LOCAL_WORLD_ALIGNED
_NO_DIRECTION = 1e-9  # [m]


class TargetError(NamedTuple):
    """How far one target is missed; None for what it does not ask for.

    Attributes:
        position: Metres.
        orientation: Radians; for an axis target the angle between the axis and its direction.
    """

    position: float | None
    orientation: float | None

    def within(self, tolerance: Tolerance) -> bool:
        """Whether both errors are at most their tolerances."""
        return (self.position is None or self.position <= tolerance.position) and (
            self.orientation is None or self.orientation <= tolerance.orientation
        )


class Linearization(NamedTuple):
    """The targets seen from one configuration.

    Attributes:
        q: The configuration (nq,).
        e: Weighted residual (m,).
        J: Weighted Jacobian (m, nv), zero in the columns of locked joints.
        errors: Each target's error, unweighted.
        residual: Norm of e, before anything shortens it.
        free: (nv,) whether the solver may move a tangent coordinate; J is zero in the columns of the others.
    """

    q: Array
    e: Array
    J: Array
    errors: list[TargetError]
    residual: float
    free: NDArray[np.bool_]


class Kinematics:
    """Some targets of a robot, made ready to be evaluated many times.

    Holds a `pinocchio.Data` of its own and is therefore for one thread.

    Attributes:
        robot: The robot.
        model: Its model, or a copy with one more frame for each target's tool.
        data: The `pinocchio.Data` of the last evaluation.
        targets: What is asked for.
        terms: The targets, compiled: see `TargetTerm`.
        coordinates: The free ones among them one by one, distal joints first, as CCD visits them.
        free: (nv,) whether a tangent coordinate moves a target and is not locked.
        locked: Joints that hold still.
        size: Number of residual rows m.
        evaluations: How many times a residual was computed.
    """

    def __init__(
        self,
        robot: Robot,
        targets: Sequence[Target],
        *,
        locked: Iterable[str] = (),
        target_jacobian: bool = False,
    ) -> None:
        """Compile the targets.

        Args:
            robot: The robot.
            targets: At least one.
            locked: Names of joints that hold still; their followers with them.
            target_jacobian: Move the effector's point to the target in the Jacobian (thesis, eq. 3.9).

        Raises:
            UnknownNameError: No such frame or joint.
            InputError: No target, or a locked joint that follows another.
        """
        if isinstance(locked, str):
            raise InputError(f"locked takes a list of joint names; got the string {locked!r}")
        self.robot = robot
        self.locked = tuple(robot.settable_joint(name) for name in locked)
        self.target_jacobian = target_jacobian
        self.evaluations = 0
        self.retarget(targets)

    def retarget(self, targets: Sequence[Target]) -> None:
        """Ask for other targets."""
        self.targets = tuple(targets)
        if not self.targets:
            raise InputError("there is nothing to solve: give at least one target")
        self.model = self.robot.model
        ids = [(self._frame_id(t), _reference_id(self.robot, t)) for t in self.targets]
        self.data = self.model.createData()
        self.terms = [TargetTerm(self, t, frame, ref) for t, (frame, ref) in zip(self.targets, ids, strict=True)]
        self.size = sum(term.size for term in self.terms)
        self.free = np.zeros(self.model.nv, dtype=bool)
        for term in self.terms:
            for joint in term.movers:
                if joint.multiplier == 0.0:
                    continue
                owner = self.robot.joint(joint.leader or joint.name)
                self.free[owner.idx_v : owner.idx_v + owner.nv] = True
        for joint in self.locked:
            self.free[joint.idx_v : joint.idx_v + joint.nv] = False
        # Without a reference the other columns are zero anyway; with one, what moves both cancels but for rounding.
        relative = any(target.relative_to is not None for target in self.targets)
        self._columns_to_clear = np.flatnonzero(~self.free) if relative or self.locked else None
        self.coordinates = self._coordinates()

    def _coordinates(self) -> tuple[Coordinate, ...]:
        """The free tangent coordinates, distal joints first."""
        movers = {joint.id: joint for term in self.terms for joint in term.movers}
        coordinates = []
        for joint in reversed(self.robot.joints):
            moved = [(j, j.multiplier) for j in movers.values() if j.leader == joint.name]
            if joint.id in movers:
                moved.insert(0, (joint, 1.0))
            moved = [(j, multiplier) for j, multiplier in moved if multiplier != 0.0]
            for index in range(joint.nv):
                if moved and self.free[joint.idx_v + index]:
                    coordinates.append(Coordinate(joint, index, tuple(moved)))
        return tuple(coordinates)

    def linearize(self, q: Array) -> Linearization:
        """Residual, Jacobian and errors at `q` (nq,)."""
        self.evaluations += 1
        if len(self.terms) == 1:
            e, J, error = self.terms[0].linearize(q)
            errors = [error]
        else:
            parts = [term.linearize(q) for term in self.terms]
            e = np.concatenate([part[0] for part in parts])
            J = np.vstack([part[1] for part in parts])
            errors = [part[2] for part in parts]
        if self._columns_to_clear is not None:
            J[:, self._columns_to_clear] = 0.0
        return Linearization(q, e, J, errors, math.sqrt(e.dot(e)), self.free)

    def shortened(self, e: Array, longest: float) -> Array:
        """The residual with each position part cut to `longest` [m], its direction kept: ClampMag of the thesis."""
        e = e.copy()
        row = 0
        for term in self.terms:
            if term.target.position is not None:
                part = e[row : row + 3]
                length = math.sqrt(part.dot(part)) / term.target.weight
                if length > longest:
                    part *= longest / length
            row += term.size
        return e

    def _frame_id(self, target: Target) -> int:
        frame_id = self.robot.frame_id(target.frame)
        if target.tool is None:
            return frame_id
        if self.model is self.robot.model:
            self.model = pinocchio.Model(self.robot.model)
        frame = self.model.frames[frame_id]
        placement = frame.placement * target.tool
        name = f"tool {self.model.nframes}"
        return int(
            self.model.addFrame(pinocchio.Frame(name, frame.parentJoint, frame_id, placement, pinocchio.OP_FRAME))
        )


class TargetTerm:
    """One target, compiled: its frames' ids, live views of their placements, and its rows of e and J.

    Attributes:
        target: The target.
        size: Its rows: 3 for a position, 3 for an orientation or an axis.
        frame_joint, reference_joint: The joints that carry the frame and the reference (0: the world).
        frame_placement, reference_placement: Where they sit on these joints.
        frame_support, reference_support: Ids of all joints between the world and each.
        chain_length: Sum of the distances between the origins of the movers, the tool's included [m].
        movers: The joints that move the frame relative to the reference, followers included, base first.
    """

    def __init__(self, kinematics: Kinematics, target: Target, frame: int, reference: int | None) -> None:
        self.target = target
        self.size = 3 * ((target.position is not None) + (target.rotation is not None or target.axis is not None))
        self._kinematics = kinematics
        model, data = kinematics.model, kinematics.data
        self._frame = frame
        self._reference = reference
        # Views into data: they show each new placement without a call.
        self.p, self.R = data.oMf[frame].translation, data.oMf[frame].rotation
        self.frame_joint = model.frames[frame].parentJoint
        self.reference_joint = 0 if reference is None else model.frames[reference].parentJoint
        if reference is not None:
            self._reference_p, self._reference_R = (
                data.oMf[reference].translation,
                data.oMf[reference].rotation,
            )
        self.frame_support = frozenset(model.supports[self.frame_joint])
        self.reference_support = frozenset(model.supports[self.reference_joint])
        one_sided = self.frame_support ^ self.reference_support
        self.movers: tuple[Joint, ...] = tuple(j for j in kinematics.robot.joints if j.id in one_sided)
        self.frame_placement = model.frames[frame].placement
        self.reference_placement = None if reference is None else model.frames[reference].placement
        offsets = [model.jointPlacements[j.id].translation for j in self.movers]
        length = sum(float(np.linalg.norm(o)) for o in (*offsets, self.frame_placement.translation))
        self.chain_length = length or 1.0

    def wanted(self) -> tuple[Array | None, Array | None, Array | None, Array | None]:
        """(position, rotation, direction, at) in the world, at the configuration last evaluated."""
        t = self.target
        if self._reference is None:
            return t.position, t.rotation, t.direction, t.at
        p, R = self._reference_p, self._reference_R
        return (
            None if t.position is None else p + R.dot(t.position),
            None if t.rotation is None else R.dot(t.rotation),
            None if t.direction is None else R.dot(t.direction),
            None if t.at is None else p + R.dot(t.at),
        )

    def update_placements(self) -> None:
        """Bring the views up to date after a forward kinematics of all joints."""
        model, data = self._kinematics.model, self._kinematics.data
        pinocchio.updateFramePlacement(model, data, self._frame)
        if self._reference is not None:
            pinocchio.updateFramePlacement(model, data, self._reference)

    def linearize(self, q: Array) -> tuple[Array, Array, TargetError]:
        """(e, J, error) of this target alone, weighted but for the error."""
        k, target = self._kinematics, self.target
        J = _frame_jacobian(k, q, self._frame)
        moving = None if self._reference is None else _frame_jacobian(k, q, self._reference)
        position, rotation, direction, at = self.wanted()
        if position is None:
            e, J, orientation_error = self._orientation_rows(J, moving, rotation, direction, at)
            error = TargetError(None, orientation_error)
        else:
            e = position - self.p
            position_error = math.sqrt(e.dot(e))
            if rotation is not None and moving is None and not k.target_jacobian:
                e_orientation, orientation_error = self._rotation_left(rotation)
                e = np.concatenate((e, e_orientation))  # the common case: J is already right
            else:
                J_position = _linear_rows_at(J, e) if k.target_jacobian else J[:3]
                if moving is not None:
                    J_position = J_position - _linear_rows_at(moving, position - self._reference_p)
                if self.size == 3:
                    J, orientation_error = J_position, None
                else:
                    e_orientation, J, orientation_error = self._orientation_rows(J, moving, rotation, direction, at)
                    e, J = np.concatenate((e, e_orientation)), np.concatenate((J_position, J))
            error = TargetError(position_error, orientation_error)
        if target.weight != 1.0:
            return target.weight * e, target.weight * J, error
        return e, J, error

    def _rotation_left(self, rotation: Array) -> tuple[Array, float]:
        e = pinocchio.log3(rotation.dot(self.R.T))
        return e, math.sqrt(e.dot(e))

    def _orientation_rows(
        self,
        J: Array,
        moving: Array | None,
        rotation: Array | None,
        direction: Array | None,
        at: Array | None,
    ) -> tuple[Array, Array, float]:
        """(e, J, angle) of the wanted rotation, direction or point to look at."""
        J_angular = J[3:]
        if rotation is not None:
            e, angle = self._rotation_left(rotation)
            return e, J_angular if moving is None else J_angular - moving[3:], angle
        assert self.target.axis is not None
        axis = self.R.dot(self.target.axis)
        if at is None:
            assert direction is not None
            e, angle = _shortest_rotation(axis, direction)
            if moving is not None:
                J_angular = J_angular - moving[3:]
            return e, J_angular - np.outer(axis, axis.dot(J_angular)), angle
        line = at - self.p
        distance = math.sqrt(line.dot(line))
        if distance < _NO_DIRECTION:  # the frame sits on the point that it should look at: every direction is right
            return np.zeros(3), np.zeros_like(J_angular), 0.0
        direction = line / distance
        e, angle = _shortest_rotation(axis, direction)
        J_linear = J[:3] if moving is None else J[:3] - _linear_rows_at(moving, at - self._reference_p)
        turning = J_angular - np.outer(axis, axis.dot(J_angular))
        return e, turning + pinocchio.skew(direction).dot(J_linear) / distance, angle


def _frame_jacobian(kinematics: Kinematics, q: Array, frame: int) -> Array:
    """World-aligned Jacobian (6, nv) of a frame, whose placement is up to date afterwards."""
    model = kinematics.model
    # Walks only the frame's own chain; a single column comes back as (6,).
    J: Array = pinocchio.computeFrameJacobian(model, kinematics.data, q, frame, _ALIGNED)
    return J if J.ndim == 2 else J.reshape(6, model.nv)


def _linear_rows_at(J: Array, offset: Array) -> Array:
    """Linear rows (3, nv) of a world-aligned Jacobian, at a point of the same body `offset` away."""
    return np.array(J[:3] - pinocchio.skew(offset).dot(J[3:]))


def _shortest_rotation(a: Array, b: Array) -> tuple[Array, float]:
    """(rotation vector (3,), angle) of the shortest rotation that takes unit vector a to unit vector b."""
    normal = pinocchio.skew(a).dot(b)
    sine, cosine = math.sqrt(normal.dot(normal)), float(a.dot(b))
    angle = math.atan2(sine, cosine)
    if sine > 1e-12:
        return normal * (angle / sine), angle
    if cosine > 0.0:
        return np.zeros(3), angle
    # opposite: any axis across a will do; take the one nearest the coordinate axis that a avoids most
    across = pinocchio.skew(a)[:, int(np.argmin(np.abs(a)))]
    return across * (math.pi / np.linalg.norm(across)), math.pi


def _reference_id(robot: Robot, target: Target) -> int | None:
    return None if target.relative_to is None else robot.frame_id(target.relative_to)
