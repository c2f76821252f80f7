"""The values that a target is made of, checked: its frames, position, orientation, axis and tool."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_length, as_plain, as_point, as_unit_vector, as_vector
from ..errors import InputError
from ..rotations import as_rotation, as_rpy, as_se3

__all__ = ["Position", "as_axis", "as_position", "as_tool", "check_combination", "named", "rotation_of"]

Array = NDArray[np.float64]

Position = ArrayLike | Sequence[float | None]
"""A position (3,), with None for axes that are free."""

_NAMED_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_NAMED_AXES |= {f"-{name}": (-x, -y, -z) for name, (x, y, z) in list(_NAMED_AXES.items())}


def named(frame: object, relative_to: object) -> str:
    """Check that the frames are names, and return the words with which errors about this target begin."""
    if not isinstance(frame, str):
        raise InputError(f"a target's frame must be a name; got {frame!r}")
    if not isinstance(relative_to, (str, type(None))):
        raise InputError(f"target {frame!r}: relative_to must be the name of a frame; got {relative_to!r}")
    return f"target {frame!r}: "


def check_combination(
    what: str, position: object, rotation: object, rpy: object, quat_xyzw: object, quat_wxyz: object,
    placement: object, axis: object, direction: object, at: object,
) -> None:  # fmt: skip
    """Check that the keywords ask for something, and for nothing twice."""
    orientations = {
        "rotation": rotation, "rpy": rpy, "quat_xyzw": quat_xyzw, "quat_wxyz": quat_wxyz,
        "placement": placement, "axis": axis,
    }  # fmt: skip
    given = [name for name, value in orientations.items() if value is not None]
    if len(given) > 1:
        raise InputError(f"{what}give the orientation once; got {' and '.join(given)}")
    if (axis is None) != (direction is None and at is None):
        raise InputError(f"{what}axis= needs direction= or at=, and these need axis=")
    if direction is not None and at is not None:
        raise InputError(f"{what}give direction= or at=, not both")
    if placement is not None and position is not None:
        raise InputError(f"{what}placement gives the position already; leave out position=")
    if position is None and not given:
        raise InputError(f"{what}nothing is asked for; give position=, an orientation, or placement=")


def rotation_of(
    what: str,
    rotation: ArrayLike | None,
    rpy: ArrayLike | None,
    quat_xyzw: ArrayLike | None,
    quat_wxyz: ArrayLike | None,
) -> Array | None:
    """The rotation matrix (3, 3) that the one keyword that is given means; None if none is given."""
    if rotation is not None:
        return as_rotation(rotation, f"{what}rotation")
    if rpy is not None:
        return np.array(pinocchio.rpy.rpyToMatrix(as_rpy(rpy, f"{what}rpy")))
    if quat_xyzw is None and quat_wxyz is None:
        return None
    if quat_xyzw is not None:
        x, y, z, w = as_vector(quat_xyzw, 4, f"{what}quat_xyzw")
    else:
        assert quat_wxyz is not None
        w, x, y, z = as_vector(quat_wxyz, 4, f"{what}quat_wxyz")
    quaternion = np.array([x, y, z, w])
    largest = np.abs(quaternion).max()
    if largest < 1e-9:
        raise InputError(f"{what}a quaternion must not be zero; got {quaternion.tolist()} (x, y, z, w)")
    quaternion = quaternion / largest  # first, so that no square overflows
    return np.array(pinocchio.Quaternion(quaternion / np.linalg.norm(quaternion)).toRotationMatrix())


def as_position(position: Position, what: str) -> Array:
    """A point (3,) [m], with NaN for coordinates of None."""
    if isinstance(position, pinocchio.SE3) or (isinstance(position, np.ndarray) and position.shape == (4, 4)):
        raise InputError("must be 3 finite numbers; give a whole placement as placement=", argument=what)
    position = as_plain(position, what)
    parts = position.tolist() if isinstance(position, np.ndarray) and position.dtype == object else position
    if not isinstance(parts, (list, tuple)) or len(parts) != 3 or not any(part is None for part in parts):
        return as_point(position, what)  # type: ignore[arg-type]
    if all(part is None for part in parts):
        raise InputError("must have a coordinate that is not None; leave it out to leave all axes free", argument=what)
    return np.array([np.nan if part is None else as_length(part, f"{what}[{k}]") for k, part in enumerate(parts)])


def as_axis(axis: str | ArrayLike, what: str) -> Array:
    """A unit vector (3,) from the name of an axis or a vector."""
    if isinstance(axis, str):
        if axis not in _NAMED_AXES:
            raise InputError(f"{what} must be one of {', '.join(_NAMED_AXES)} or three numbers; got {axis!r}")
        return np.array(_NAMED_AXES[axis])
    return as_unit_vector(axis, what)


def as_tool(tool: pinocchio.SE3 | ArrayLike, what: str) -> pinocchio.SE3:
    """The placement of a tool in its frame, from a placement or a point (3,) [m]."""
    tool = as_plain(tool, what)
    if isinstance(tool, (list, tuple, np.ndarray)) and np.ndim(tool) and len(tool) == 3:
        return pinocchio.SE3(np.eye(3), as_point(tool, what))
    return as_se3(tool, what)
