"""Tolerances of targets, and the errors that are compared with them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from ..checks import as_array, as_finite_number, as_vector
from ..errors import InputError

__all__ = ["TargetError", "Tolerance", "largest_of"]

Three = tuple[float, float, float]

WIDE_LENGTH = 1e-3
"""A position tolerance above this part of the chain's length is wide."""

WIDE_ANGLE = 0.01
"""[rad] An orientation tolerance above this is wide."""


class Tolerance(NamedTuple):
    """The largest errors that count as reached.

    Attributes:
        position: The largest distance [m]; or three numbers: the largest distances along the axes of the target's
            rotation, or of `relative_to` if the target has no rotation.
        orientation: The largest angle [rad].
    """

    position: float | Three = 1e-4
    orientation: float = 1e-3

    @classmethod
    def of(cls, value: Tolerance | ArrayLike | None, what: str = "tolerance") -> Tolerance:
        """A checked Tolerance from None (the defaults), a Tolerance or a pair (metres, radians).

        The metres may be three numbers, for a box.

        Raises:
            InputError: The numbers have another shape or are not positive.
        """
        if value is None:
            return cls()
        if isinstance(value, (tuple, list)) and len(value) == 2 and np.ndim(value[0]) == 1:
            x, y, z = as_array(value[0], (3,), f"{what} position", "a box, in metres").tolist()
            angle = as_finite_number(value[1], f"{what} orientation")
            if min(x, y, z, angle) > 0.0:
                return cls((x, y, z), angle)
            raise InputError(f"must be three positive lengths and a positive angle; got {value!r}", argument=what)
        pair = as_vector(value, 2, what, "metres, radians")
        if (pair <= 0.0).any():
            raise InputError(f"must be two positive numbers (metres, radians); got {pair.tolist()}", argument=what)
        return cls(float(pair[0]), float(pair[1]))

    @property
    def box(self) -> Three | None:
        """The half sizes of the box of positions [m]; None if the tolerance is a distance."""
        return self.position if isinstance(self.position, tuple) else None

    @property
    def farthest(self) -> float:
        """The largest distance that is within tolerance [m]: of a box, that of its corners."""
        return math.hypot(*self.position) if isinstance(self.position, tuple) else self.position

    def is_wide(self, size_of_chain: float) -> bool:
        """For pinik itself: whether it is worth looking for an answer inside the tolerance instead of the exact one.

        Args:
            size_of_chain: The length of the chain [m].
        """
        largest = max(self.position) if isinstance(self.position, tuple) else self.position
        return largest > WIDE_LENGTH * size_of_chain or self.orientation > WIDE_ANGLE


class _Errors(NamedTuple):
    position: float | None
    orientation: float | None


class TargetError(_Errors):
    """How far one target is missed: the pair (position, orientation), with None for what it does not constrain.

    Attributes:
        position: The distance [m], along the axes that the target constrains.
        orientation: The angle [rad]; for an axis target, the angle between the axis and its direction.
        offset: If the position tolerance is a box, the position error along each of the box's axes [m]; else None.
    """

    offset: Three | None

    def __new__(cls, position: float | None, orientation: float | None, offset: Three | None = None) -> Self:
        """Keep the offset beside the pair."""
        error = super().__new__(cls, position, orientation)
        error.offset = offset
        return error

    def within(self, tolerance: Tolerance) -> bool:
        """Whether both errors are at most their tolerances."""
        return self.position_within(tolerance) and self.orientation_within(tolerance)

    def position_within(self, tolerance: Tolerance) -> bool:
        """Whether the position error is at most its tolerance; True if the position is not constrained."""
        allowed = tolerance.position
        if not isinstance(allowed, tuple):
            return self.position is None or self.position <= allowed
        return self.offset is None or all(abs(own) <= most for own, most in zip(self.offset, allowed, strict=True))

    def orientation_within(self, tolerance: Tolerance) -> bool:
        """Whether the orientation error is at most its tolerance; True if the orientation is not constrained."""
        return self.orientation is None or self.orientation <= tolerance.orientation

    def excess(self, tolerance: Tolerance, metres_per_radian: float) -> float:
        """For pinik itself: how far the errors exceed the tolerance, in one number [m].

        Args:
            tolerance: The tolerance.
            metres_per_radian: The weight of a radian [m/rad].
        """
        beyond = 0.0
        if isinstance(tolerance.position, tuple):
            if self.offset is not None:
                beyond = math.hypot(
                    *[max(abs(own) - most, 0.0) for own, most in zip(self.offset, tolerance.position, strict=True)]
                )
        elif self.position is not None:
            beyond = max(self.position - tolerance.position, 0.0)
        turned = 0.0 if self.orientation is None else max(self.orientation - tolerance.orientation, 0.0)
        return math.hypot(beyond, metres_per_radian * turned)


def largest_of(errors: Iterable[TargetError]) -> TargetError:
    """The largest position error and the largest orientation error of several targets, None where none has one."""
    errors = tuple(errors)
    return TargetError(
        max((error.position for error in errors if error.position is not None), default=None),
        max((error.orientation for error in errors if error.orientation is not None), default=None),
    )
