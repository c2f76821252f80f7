r"""One target's rows of residual and Jacobian.

For a frame at $(p, R)$ wanted at $(p^*, R^*)$ the residual is $e = (p^* - p,\ \log_3(R^* R^\top))$ in world-aligned
axes, and $J\,dq \approx e$. An axis $a$ of the frame along a direction $d$ gives $e = \theta\,n$, the shortest
rotation that takes $a$ to $d$; the spin about $a$ is projected out of its Jacobian.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..model.joint import Joint
from .targets import NO_DIRECTION, Target, TargetError

__all__ = ["TargetTerm"]

Array = NDArray[np.float64]

_ALIGNED = pinocchio.LOCAL_WORLD_ALIGNED


class TargetTerm:
    """One target, compiled: its frames' ids, live views of their placements, and its rows of e and J.

    Attributes:
        target: The target.
        weight: Factor on its rows, at most 1.
        size: Its rows: 3 for a position, 3 for an orientation or an axis.
        frame_joint, reference_joint: The joints that carry the frame and the reference (0: the world).
        frame_placement, reference_placement: Where they sit on these joints.
        frame_support, reference_support: Ids of all joints between the world and each.
        chain_length: Sum of the distances between the origins of the movers, the tool's included [m].
        movers: The joints that move the frame relative to the reference, followers included, base first.
    """

    def __init__(
        self,
        model: pinocchio.Model,
        data: pinocchio.Data,
        joints: Iterable[Joint],
        target: Target,
        frame: int,
        reference: int | None,
        target_jacobian: bool,
        weight: float,
    ) -> None:
        self.target = target
        self.size = 3 * ((target.position is not None) + target.asks_orientation)
        self._model, self._data = model, data
        self._target_jacobian = target_jacobian
        self.weight = weight
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
        self.movers: tuple[Joint, ...] = tuple(j for j in joints if j.id in one_sided)
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
        pinocchio.updateFramePlacement(self._model, self._data, self._frame)
        if self._reference is not None:
            pinocchio.updateFramePlacement(self._model, self._data, self._reference)

    def seen_from_reference(self) -> tuple[Array, Array]:
        """(position, rotation) of the frame in the axes that the target's numbers are in, as last evaluated."""
        if self._reference is None:
            return self.p, self.R
        R = self._reference_R.T
        return R.dot(self.p - self._reference_p), R.dot(self.R)

    def linearize(self, q: Array) -> tuple[Array, Array, TargetError]:
        """(e, J, error) of this target alone, weighted but for the error."""
        J = self._frame_jacobian(q, self._frame)
        moving = None if self._reference is None else self._frame_jacobian(q, self._reference)
        position, rotation, direction, at = self.wanted()
        if position is None:
            e, J, orientation_error = self._orientation_rows(J, moving, rotation, direction, at)
            error = TargetError(None, orientation_error)
        else:
            e = position - self.p
            position_error = math.sqrt(e.dot(e))
            if rotation is not None and moving is None and not self._target_jacobian:
                e_orientation, orientation_error = self._rotation_left(rotation)
                e = np.concatenate((e, e_orientation))  # the common case: J is already right
            else:
                J_position = _linear_rows_at(J, e) if self._target_jacobian else J[:3]
                if moving is not None:
                    J_position = J_position - _linear_rows_at(moving, position - self._reference_p)
                if self.size == 3:
                    J, orientation_error = J_position, None
                else:
                    e_orientation, J, orientation_error = self._orientation_rows(J, moving, rotation, direction, at)
                    e, J = np.concatenate((e, e_orientation)), np.concatenate((J_position, J))
            error = TargetError(position_error, orientation_error)
        if self.weight != 1.0:
            return self.weight * e, self.weight * J, error
        return e, J, error

    def _frame_jacobian(self, q: Array, frame: int) -> Array:
        """World-aligned Jacobian (6, nv) of a frame, whose placement is up to date afterwards."""
        # Walks only the frame's own chain; a single column comes back as (6,).
        J: Array = pinocchio.computeFrameJacobian(self._model, self._data, q, frame, _ALIGNED)
        return J if J.ndim == 2 else J.reshape(6, self._model.nv)

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
        if distance < NO_DIRECTION:  # the frame sits on the point that it should look at: every direction is right
            return np.zeros(3), np.zeros_like(J_angular), 0.0
        direction = line / distance
        e, angle = _shortest_rotation(axis, direction)
        J_linear = J[:3] if moving is None else J[:3] - _linear_rows_at(moving, at - self._reference_p)
        turning = J_angular - np.outer(axis, axis.dot(J_angular))
        return e, turning + pinocchio.skew(direction).dot(J_linear) / distance, angle


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
