"""Rotations and placements that users give, checked; a rounded rotation matrix is replaced by the nearest one."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterable

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from .checks import as_array, as_many, as_point, as_vector
from .errors import InputError, InputWarning

__all__ = [
    "as_rotation",
    "as_rotations",
    "as_rpy",
    "as_se3",
    "like_degrees",
    "rotations_of_quaternions",
    "rotations_of_rpy",
    "rpy_like_degrees",
]

# Of rotation matrices. The first is the largest entry of R Rᵀ − I, the others differences to the nearest rotation.
_EXACT = 1e-14
_UNSAID_CHANGE = 1e-6  # replaced in silence up to here, such as numbers in single precision
_FARTHEST_ROTATION = 1e-3  # refused from here on; numbers rounded to three digits are nearer

_IDENTITY = np.eye(3)

_MOST_DEGREES = 1080.0

Array = NDArray[np.float64]


def as_rotation(value: ArrayLike, what: str) -> Array:
    """`value` as a rotation matrix (3, 3); a rounded one is replaced by the nearest rotation.

    Args:
        value: The matrix. How far it is from the nearest rotation is measured by the largest difference of an entry.
        what: The argument's name in messages.

    Raises:
        InputError: It is more than 1e-3 from the nearest rotation.

    Warns:
        InputWarning: It is more than 1e-6 from it.
    """
    matrix = as_array(value, (3, 3), what, "a rotation matrix")
    small = np.abs(matrix).max() < 2.0  # otherwise the product could overflow
    if small and np.abs(matrix.dot(matrix.T) - _IDENTITY).max() < _EXACT and _determinant(matrix) > 0.0:
        return matrix
    rotation, change = _nearest_rotations(matrix)
    if change > _FARTHEST_ROTATION:
        raise InputError(
            f"must be a rotation matrix (orthonormal, determinant +1), or one whose entries are rounded by at most "
            f"{_FARTHEST_ROTATION:g}; an entry is {change:.2g} away from the nearest one; got {matrix.tolist()}",
            argument=what,
        )
    if change > _UNSAID_CHANGE:
        _warn(f"{what} is replaced by the nearest rotation matrix; the largest change of an entry is {change:.1g}")
    return rotation


def as_rotations(values: ArrayLike, what: str, indices: NDArray[np.int64] | None = None) -> Array:
    """`values` as rotation matrices (n, 3, 3), each checked and replaced as by `as_rotation`; one warning for all.

    Args:
        values: The matrices.
        what: What messages call them.
        indices: Their indices in messages (n,), if they are some of many; 0, 1, … when None.
    """
    matrices = as_many(values, (3, 3), what)
    # The rows of all matrices: sums over them are much faster than N small products.
    a, b, c = np.ascontiguousarray(matrices.transpose(1, 2, 0))
    with np.errstate(over="ignore", invalid="ignore"):
        off = np.zeros(len(matrices))
        for one, other, product in ((a, a, 1.0), (b, b, 1.0), (c, c, 1.0), (a, b, 0.0), (a, c, 0.0), (b, c, 0.0)):
            off = np.maximum(off, np.abs((one * other).sum(axis=0) - product))
        turned = np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))
        exact = (off < _EXACT) & ((turned * c).sum(axis=0) > 0.0)
    inexact = np.flatnonzero(~exact)
    if len(inexact) == 0:
        return matrices
    rotations, changes = _nearest_rotations(matrices[inexact])
    for k in inexact[changes > _FARTHEST_ROTATION][:1]:
        as_rotation(matrices[k], f"{what}[{k}]")
    matrices[inexact] = rotations
    changed = inexact[changes > _UNSAID_CHANGE]
    if len(changed) > 0:
        first = changed[0] if indices is None else indices[changed[0]]
        ones = f"{len(changed)} are replaced by the nearest rotation matrix, first {what}[{first}]"
        _warn(f"{what}: {ones}; the largest change of an entry is {changes.max():.1g}")
    return matrices


def as_se3(value: pinocchio.SE3 | ArrayLike, what: str) -> pinocchio.SE3:
    """`value`, a `pinocchio.SE3` or a homogeneous 4×4 matrix, as a new SE3; a rounded rotation as by `as_rotation`."""
    matrix = value.homogeneous if isinstance(value, pinocchio.SE3) else value
    array = as_array(matrix, (4, 4), what, "an SE3 or a homogeneous matrix")
    if np.abs(array[3] - (0.0, 0.0, 0.0, 1.0)).max() > 1e-9:
        raise InputError(
            f"must be a homogeneous matrix, whose last row is 0 0 0 1; got {array[3].tolist()}", argument=what
        )
    return pinocchio.SE3(as_rotation(array[:3, :3], what), as_point(array[:3, 3], what))


def rotations_of_quaternions(quaternions: Array) -> Array:
    """The rotation matrices (n, 3, 3) of quaternions (n, 4), scalar last, that are finite and not zero."""
    scaled = quaternions / np.abs(quaternions).max(axis=1, keepdims=True)  # first, so that no square overflows
    x, y, z, w = (scaled / np.linalg.norm(scaled, axis=1, keepdims=True)).T
    entries = [
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),
        2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),
        2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y),
    ]  # fmt: skip
    return np.stack(entries, axis=1).reshape(-1, 3, 3)


def as_rpy(value: ArrayLike, what: str) -> Array:
    """`value` as roll, pitch and yaw (3,) [rad].

    Raises:
        InputError: It is not three finite numbers.

    Warns:
        InputWarning: The numbers look like degrees.
    """
    rpy = as_vector(value, 3, what, "roll, pitch, yaw in radians")
    if rpy_like_degrees(rpy.tolist()):
        _warn(
            f"{what} goes beyond a full turn in radians, and looks like degrees; np.radians(…) converts them, and so "
            f"does --deg on the command line; got {rpy.tolist()}"
        )
    return rpy


def rpy_like_degrees(rpy: Iterable[float]) -> bool:
    """Whether roll, pitch and yaw [rad] go beyond a full turn, and are numbers as people write them in degrees."""
    angles = list(rpy)
    return max(map(abs, angles)) > 2.0 * math.pi + 0.1 and all(map(like_degrees, angles))


def like_degrees(angle: float) -> bool:
    """Whether an angle is a number as people write it in degrees: whole or half."""
    return abs(angle) <= _MOST_DEGREES and (2.0 * angle).is_integer()


def rotations_of_rpy(angles: Array) -> Array:
    """The rotation matrices (n, 3, 3) of fixed-axis roll, pitch and yaw (n, 3) [rad]: Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles).T, np.sin(angles).T
    entries = [
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp, cp * sr, cp * cr,
    ]  # fmt: skip
    return np.stack(entries, axis=1).reshape(-1, 3, 3)


def _nearest_rotations(matrices: Array) -> tuple[Array, Array]:
    """The nearest rotations (…, 3, 3), and the largest difference of an entry (…)."""
    left, _, right = np.linalg.svd(matrices)
    left[..., 2] *= np.sign(np.linalg.det(left @ right))[..., np.newaxis]  # −1 where the matrix mirrors
    rotations = np.array(left @ right)
    return rotations, np.abs(matrices - rotations).max(axis=(-2, -1))


def _warn(message: str) -> None:
    """Warn at the line outside pinik that called."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_globals["__name__"].partition(".")[0] == __package__:
        level, frame = level + 1, frame.f_back
    warnings.warn(message, InputWarning, stacklevel=level)


def _determinant(matrix: Array) -> float:
    """The determinant of a 3×3 matrix; numpy takes ten times as long for so few numbers."""
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    return float(a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g))
