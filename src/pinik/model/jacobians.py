"""Jacobians of frames, in the world or relative to another frame."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import InputError

__all__ = ["as_reference_frame", "frame_jacobian", "relative_jacobian"]

Array = NDArray[np.float64]

_AXES = {
    "local_world_aligned": pinocchio.LOCAL_WORLD_ALIGNED,
    "local": pinocchio.LOCAL,
    "world": pinocchio.WORLD,
}


def as_reference_frame(axes: str | pinocchio.ReferenceFrame) -> pinocchio.ReferenceFrame:
    """Pinocchio's reference frame for the name of one.

    Raises:
        InputError: Another name.
    """
    if isinstance(axes, pinocchio.ReferenceFrame):
        return axes
    if not isinstance(axes, str) or axes not in _AXES:
        raise InputError(
            f"axes must be one of {', '.join(map(repr, _AXES))} or a pinocchio.ReferenceFrame; got {axes!r}"
        )
    return _AXES[axes]


def frame_jacobian(model: pinocchio.Model, data: pinocchio.Data, frame: int, axes: pinocchio.ReferenceFrame) -> Array:
    """The Jacobian (6, nv) of a frame; `data` must come from `pinocchio.computeJointJacobians`."""
    if model.nv == 0:
        return np.zeros((6, 0))  # Pinocchio ends the process if there are no columns
    J = np.array(pinocchio.getFrameJacobian(model, data, frame, axes))
    return J.reshape(6, model.nv)  # Pinocchio returns a single column as (6,)


def relative_jacobian(
    model: pinocchio.Model, data: pinocchio.Data, frame: int, reference: int, axes: pinocchio.ReferenceFrame
) -> Array:
    """The Jacobian (6, nv) of a frame relative to a reference frame, which takes the place of the world in `axes`.

    `data` must come from `pinocchio.computeJointJacobians`.
    """
    local = frame_jacobian(model, data, frame, pinocchio.LOCAL)
    moving = frame_jacobian(model, data, reference, pinocchio.LOCAL)
    oMf = pinocchio.updateFramePlacement(model, data, frame)
    rMf = pinocchio.updateFramePlacement(model, data, reference).actInv(oMf)
    J = local - rMf.toActionMatrixInverse() @ moving
    if axes == pinocchio.LOCAL:
        return np.array(J)
    if axes == pinocchio.WORLD:
        return np.array(rMf.toActionMatrix() @ J)
    return np.vstack([rMf.rotation @ J[:3], rMf.rotation @ J[3:]])
