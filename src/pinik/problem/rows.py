r"""One target's rows of residual and Jacobian.

For a frame at $(p, R)$ wanted at $(p^*, R^*)$ the residual is $e = (p^* - p,\ L \log_3(R^* R^\top))$ in world-aligned
axes, with $L$ the chain's length, and $J\,dq \approx e$. An axis $a$ of the frame along a direction $d$ gives
$e = L\,\theta\,n$, the shortest rotation that takes $a$ to $d$; the spin about $a$ is projected out of its Jacobian.
"""

from __future__ import annotations

import math

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .slack import outside_ball, outside_box
from .targets import NO_DIRECTION, Target
from .term import Term
from .tolerance import TargetError, Three

__all__ = ["Rows", "shortest_rotation"]

Array = NDArray[np.float64]

_ALIGNED = pinocchio.LOCAL_WORLD_ALIGNED
_IDENTITY = np.eye(3)


class Rows:
    """One target's rows of e and J, with live views of the placements that they come from.

    Attributes:
        term: The target, compiled.
        target: The target itself, of the same kind as the term's.
        p, R: Position (3,) and rotation (3, 3) of its frame, as last evaluated.
    """

    def __init__(
        self, term: Term, target: Target, model: pinocchio.Model, data: pinocchio.Data, at_target: bool
    ) -> None:
        """With `at_target` the Jacobian is taken at the target instead of the effector (thesis, eq. 3.9)."""
        self.term = term
        self.target = target
        self._model, self._data = model, data
        self._at_target = at_target
        self._frame, self._reference = term.frame, term.reference
        # Views into data: they show each new placement without a call.
        self.p, self.R = data.oMf[term.frame].translation, data.oMf[term.frame].rotation
        if term.reference is not None:
            reference = data.oMf[term.reference]
            self._reference_p, self._reference_R = reference.translation, reference.rotation

    def wanted(self) -> tuple[Array | None, Array | None, Array | None, Array | None]:
        """(position, rotation, direction, at) that are wanted, in the world, at the configuration last evaluated.

        Along free axes, the position is that of the frame.
        """
        t = self.target
        position = t.position
        if self.term.has_free_axes:  # the nearest position that is allowed
            position = np.where(t.along, np.asarray(position), self.seen_from_reference()[0])
        if self._reference is None:
            return position, t.rotation, t.direction, t.at
        p, R = self._reference_p, self._reference_R
        return (
            None if position is None else p + R.dot(position),
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
        """(position, rotation) of the frame in the axes of the target's numbers, as last evaluated."""
        if self._reference is None:
            return self.p, self.R
        R = self._reference_R.T
        return R.dot(self.p - self._reference_p), R.dot(self.R)

    def linearize(self, q: Array, loose: bool = False) -> tuple[Array, Array, TargetError]:
        """(e, J, error) of this target alone; e and J are weighted, the error is not.

        With `loose`, e and J stop pulling inside the target's tolerance.
        """
        J = self._frame_jacobian(q, self._frame)
        moving = None if self._reference is None else self._frame_jacobian(q, self._reference)
        position, rotation, direction, at = self.wanted()
        weight, turn_weight = self.term.weight, self.term.turn_weight
        if position is None:
            e, J, angle = self._orientation_rows(J, moving, rotation, direction, at)
            if loose:
                e, J = self._outside_angle(e, J)
            return turn_weight * e, turn_weight * J, TargetError(None, angle)
        e = position - self.p
        distance = math.sqrt(e.dot(e))
        common = moving is None and not self._at_target and not loose and self.term.tolerance.box is None
        if rotation is not None and common and not self.term.has_free_axes:
            e_orientation, angle = self._rotation_left(rotation)
            if weight != 1.0:
                e, J[:3] = weight * e, weight * J[:3]
            J[3:] *= turn_weight  # the common case: J is already right
            return np.concatenate((e, turn_weight * e_orientation)), J, TargetError(distance, angle)
        J_position = _linear_rows_at(J, e) if self._at_target else J[:3]
        if moving is not None:
            J_position = J_position - _linear_rows_at(moving, position - self._reference_p)
        if self.term.has_free_axes:
            axes = self.reference_axes()
            J_position = (axes * self.target.along).dot(axes.T.dot(J_position))
        offset = self._offset(e, rotation)
        if loose:
            e, J_position = self._outside_distance(e, J_position, rotation)
        if weight != 1.0:
            e, J_position = weight * e, weight * J_position
        if not self.target.asks_orientation:
            return e, J_position, TargetError(distance, None, offset)
        e_orientation, J_orientation, angle = self._orientation_rows(J, moving, rotation, direction, at)
        if loose:
            e_orientation, J_orientation = self._outside_angle(e_orientation, J_orientation)
        return (
            np.concatenate((e, turn_weight * e_orientation)),
            np.concatenate((J_position, turn_weight * J_orientation)),
            TargetError(distance, angle, offset),
        )

    def reference_axes(self) -> Array:
        """The axes (3, 3) of the frame in which the target is expressed, in the world."""
        return _IDENTITY if self._reference is None else self._reference_R

    def box_axes(self, rotation: Array | None) -> Array:
        """The axes (3, 3) of a box of positions, for the rotation that is wanted in the world."""
        return self.reference_axes() if rotation is None else rotation

    def _offset(self, e: Array, rotation: Array | None) -> Three | None:
        """The position error along the axes of a box."""
        if self.term.tolerance.box is None:
            return None
        x, y, z = self.box_axes(rotation).T.dot(e).tolist()
        return x, y, z

    def _outside_distance(self, e: Array, J: Array, rotation: Array | None) -> tuple[Array, Array]:
        allowed = self.term.tolerance.position
        if isinstance(allowed, tuple):
            left, factor = outside_box(e, allowed, self.box_axes(rotation))
        else:
            left, factor = outside_ball(e, allowed)
        return left, factor.dot(J)

    def _outside_angle(self, e: Array, J: Array) -> tuple[Array, Array]:
        left, factor = outside_ball(e, self.term.tolerance.orientation)
        return left, factor.dot(J)

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
            e, angle = shortest_rotation(axis, direction)
            if moving is not None:
                J_angular = J_angular - moving[3:]
            return e, J_angular - np.outer(axis, axis.dot(J_angular)), angle
        line = at - self.p
        distance = math.sqrt(line.dot(line))
        if distance < NO_DIRECTION:  # every direction is right
            return np.zeros(3), np.zeros_like(J_angular), 0.0
        direction = line / distance
        e, angle = shortest_rotation(axis, direction)
        J_linear = J[:3] if moving is None else J[:3] - _linear_rows_at(moving, at - self._reference_p)
        turning = J_angular - np.outer(axis, axis.dot(J_angular))
        return e, turning + pinocchio.skew(direction).dot(J_linear) / distance, angle


def _linear_rows_at(J: Array, offset: Array) -> Array:
    """Linear rows (3, nv) of a world-aligned Jacobian, at a point of the same body `offset` away."""
    return np.array(J[:3] - pinocchio.skew(offset).dot(J[3:]))


def shortest_rotation(a: Array, b: Array) -> tuple[Array, float]:
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
