"""Targets: frames, and where they should be."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number, as_plain, as_point, as_unit_vector
from ..errors import InputError
from ..rotations import as_se3
from .target_json import check_fields, known
from .target_values import Position, as_axis, as_position, as_tool, check_combination, named, rotation_of
from .tolerance import Tolerance

__all__ = ["NO_DIRECTION", "Target", "as_targets"]

Array = NDArray[np.float64]

NO_DIRECTION = 1e-6
"""[m] A frame nearer than this to the point that its axis should point at counts as pointing at it. From there the
direction is mostly rounding: coordinates of 1 m are rounded to 1e-16 m, those of 1 km to 1e-13 m."""
_LIGHTEST, _HEAVIEST = 1e-3, 1e3


@dataclass(frozen=True, eq=False, init=False)
class Target:
    """A frame, and where it should be. Immutable; equal where the same is asked.

    Give the orientation in at most one way: `rotation`, `rpy`, `quat_xyzw`, `quat_wxyz`, `placement` (which gives the
    position as well), or `axis` with `direction` or `at`, which leaves the spin about that axis free.

    Attributes:
        frame: The name of the frame to move.
        position: The position wanted for the frame's origin, or for `tool`'s (3,) [m], NaN along axes that are free;
            None where all of it is free.
        rotation: The orientation wanted (3, 3); None where it is free or given by `axis`.
        axis: A unit vector (3,) fixed in the frame (in `tool` where one is given).
        direction: The unit vector (3,) that `axis` should point along.
        at: The point (3,) [m] that `axis` should point at. Within 1e-6 m of it there is no direction to it, and the
            axis counts as pointing at it.
        relative_to: The frame, moving or not, in which all of the above is expressed; the world when None.
        weight: A factor on this target's residual in the step; it never changes the verdict.
        tolerance: The errors of this target that count as reached; those of the call when None.
    """

    frame: str
    position: Array | None
    rotation: Array | None
    axis: Array | None
    direction: Array | None
    at: Array | None
    relative_to: str | None
    weight: float
    tolerance: Tolerance | None
    _tool: pinocchio.SE3 | None

    def __init__(
        self,
        frame: str,
        position: Position | None = None,
        *,
        rotation: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        quat_xyzw: ArrayLike | None = None,
        quat_wxyz: ArrayLike | None = None,
        placement: pinocchio.SE3 | ArrayLike | None = None,
        axis: str | ArrayLike | None = None,
        direction: ArrayLike | None = None,
        at: ArrayLike | None = None,
        tool: pinocchio.SE3 | ArrayLike | None = None,
        relative_to: str | None = None,
        weight: float = 1.0,
        tolerance: Tolerance | ArrayLike | None = None,
    ) -> None:
        """Check and normalise.

        Args:
            frame: The frame to move.
            position: Where its origin should be (3,) [m]. A coordinate of None leaves that axis of `relative_to`, or of
                the world, free.
            rotation: Rotation matrix (3, 3). One that was rounded is replaced by the nearest rotation, if no entry
                changes by more than 1e-3; the same holds for placements.
            rpy: Fixed-axis roll, pitch, yaw (3,) [rad]: Rz(yaw) Ry(pitch) Rx(roll).
            quat_xyzw: Quaternion, scalar last; scaled to unit length.
            quat_wxyz: Quaternion, scalar first; scaled to unit length.
            placement: SE3 or 4×4 matrix: position and orientation at once.
            axis: "x", "y", "z", "-x", "-y", "-z" or a vector (3,) in the frame.
            direction: The vector (3,) that `axis` should point along; scaled to unit length.
            at: The point (3,) [m] that `axis` should point at.
            tool: SE3 (or 4×4) of the point meant, in the frame; or just its position (3,) [m].
            relative_to: The frame in which the target is expressed.
            weight: A factor from 0.001 to 1000.
            tolerance: The errors that count as reached (metres, radians). The metres may be three numbers: the largest
                errors along the axes of the target's rotation, or of `relative_to` if it has no rotation.

        Raises:
            InputError: Nothing is asked for, something is contradictory, not finite or of the wrong shape; a direction
                or quaternion is zero; the weight is out of its range.

        Warns:
            InputWarning: An entry of a rotation matrix was changed by more than 1e-6, or `rpy` looks like degrees.
        """
        what = named(frame, relative_to)
        check_combination(what, position, rotation, rpy, quat_xyzw, quat_wxyz, placement, axis, direction, at)
        if not _LIGHTEST <= as_finite_number(weight, f"{what}weight") <= _HEAVIEST:
            raise InputError(
                f"{what}weight must be a number from {_LIGHTEST:g} to {_HEAVIEST:g}; got {weight!r}; "
                "leave the target out to switch it off"
            )
        if placement is not None:
            pose = as_se3(placement, f"{what}placement")
            position, rotation = pose.translation, pose.rotation
        self._keep(
            frame=frame,
            position=None if position is None else as_position(position, f"{what}position"),
            rotation=rotation_of(what, rotation, rpy, quat_xyzw, quat_wxyz),
            axis=None if axis is None else as_axis(axis, f"{what}axis"),
            direction=None if direction is None else as_unit_vector(direction, f"{what}direction"),
            at=None if at is None else as_point(at, f"{what}at"),
            relative_to=relative_to,
            weight=float(weight),
            tolerance=None if tolerance is None else Tolerance.of(tolerance, f"{what}tolerance"),
            _tool=None if tool is None else as_tool(tool, f"{what}tool"),
        )

    def _keep(self, **fields: Any) -> None:
        for name, value in fields.items():
            if isinstance(value, np.ndarray):
                fields[name] = np.ascontiguousarray(value)  # products of other layouts would round otherwise
                fields[name].setflags(write=False)
        vars(self).update(fields)

    @property
    def tool(self) -> pinocchio.SE3 | None:
        """A copy of the SE3 of the point meant, in the frame; None where that is the frame's origin."""
        return None if self._tool is None else self._tool.copy()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Target) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @cached_property
    def _key(self) -> tuple[object, ...]:
        """All that is asked, as something that can be compared."""
        numbers = (self.position, self.rotation, self.direction, self.at)
        return self.shape, tuple([None if value is None else tuple(known(value)) for value in numbers])

    @property
    def asks_orientation(self) -> bool:
        """Whether a rotation, or an axis's direction, is wanted."""
        return self.rotation is not None or self.axis is not None

    @property
    def along(self) -> tuple[bool, bool, bool]:
        """For pinik itself: along which axes of `relative_to` the position is constrained."""
        if self.position is None:
            return False, False, False
        x, y, z = (~np.isnan(self.position)).tolist()
        return x, y, z

    @cached_property
    def shape(self) -> tuple[object, ...]:
        """For pinik itself: what is asked of which frame, and equal where only the numbers that say where differ."""
        axis = None if self.axis is None else tuple(self.axis.tolist())
        parts = (self.along, self.rotation is not None, axis, self.at is not None, self.tolerance)
        tool = None if self._tool is None else self._tool.homogeneous.tobytes()
        return self.frame, self.relative_to, self.weight, tool, parts

    def moved_to(self, place: pinocchio.SE3 | ArrayLike) -> Target:
        """The same target at another place.

        Args:
            place: An SE3 or 4×4 matrix where position and rotation are asked for, the parts that are asked for taken
                from it; or a position (3,) [m] where only that is, which may have None along free axes.

        Raises:
            InputError: It is neither, or the target asks for an axis, or for more than the position says.
        """
        what = f"target {self.frame!r}"
        if self.axis is not None:
            raise InputError(f"{what} asks for an axis's direction; give a Target")
        place = as_plain(place, f"{what}: place")
        if not isinstance(place, pinocchio.SE3) and _is_a_point(place):
            if self.rotation is not None:
                raise InputError(f"{what} asks for an orientation too; give an SE3 or a 4×4 matrix")
            position = as_position(place, f"{what}: position")
            if np.isnan(position[list(self.along)]).any():
                raise InputError(f"{what}: position must have numbers where the target asks for them; got {place!r}")
            place = pinocchio.SE3(np.eye(3), np.nan_to_num(position))
        pose = as_se3(place, f"{what}: placement")
        return self.with_numbers(pose.translation, pose.rotation)

    def with_numbers(
        self, position: Array, rotation: Array, direction: Array | None = None, at: Array | None = None
    ) -> Target:
        """For pinik itself: the same target with other numbers; those that it does not ask for are ignored."""
        moved = object.__new__(Target)
        vars(moved).update(vars(self))
        vars(moved).pop("_key", None)
        if self.position is not None:
            position = np.where(self.along, position, np.nan)
        given = {"position": position, "rotation": rotation, "direction": direction, "at": at}
        moved._keep(
            **{
                name: value.copy()
                for name, value in given.items()
                if value is not None and getattr(self, name) is not None
            }
        )
        return moved

    def alone(self, part: str) -> Target | None:
        """For pinik itself: the same target with its position or orientation alone; None if it asks for no such.

        Args:
            part: "position" or "orientation".
        """
        dropped = ("rotation", "axis", "direction", "at") if part == "position" else ("position",)
        if self.position is None if part == "position" else not self.asks_orientation:
            return None
        own = object.__new__(Target)
        vars(own).update({name: value for name, value in vars(self).items() if name not in ("_key", "shape")})
        vars(own).update(dict.fromkeys(dropped))
        return own

    def __reduce__(self) -> tuple[Any, ...]:
        fields = {name: value for name, value in vars(self).items() if name not in ("_key", "shape")}
        return _restored, (fields,)

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Target:
        """A target from its JSON form: `Target`'s own keywords, `frame` among them.

        Raises:
            InputError: Not an object, no frame, or a value that `Target` refuses.
            UnknownNameError: A key that is not one of the keywords.
        """
        check_fields(fields)
        return cls(**fields)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form: plain numbers and lists, only what was asked for; `from_dict` reads it back."""
        fields: dict[str, Any] = {"frame": self.frame}
        for name in ("position", "rotation", "axis", "direction", "at"):
            numbers: Array | None = getattr(self, name)
            if numbers is not None:
                fields[name] = known(numbers) if numbers.ndim == 1 else numbers.tolist()
        if self._tool is not None:
            fields["tool"] = self._tool.homogeneous.tolist()
        if self.relative_to is not None:
            fields["relative_to"] = self.relative_to
        if self.weight != 1.0:
            fields["weight"] = self.weight
        if self.tolerance is not None:
            largest = self.tolerance.position if self.tolerance.box is None else list(self.tolerance.box)
            fields["tolerance"] = [largest, self.tolerance.orientation]
        return fields


def as_targets(targets: Target | Iterable[Target]) -> tuple[Target, ...]:
    """One target or several, as a tuple of at least one.

    Raises:
        InputError: Something that is no Target, or none at all.
    """
    if isinstance(targets, Target):
        return (targets,)
    if isinstance(targets, (str, memoryview)) or not isinstance(targets, Iterable):
        raise InputError(f"targets must be Target objects; got {targets!r}")
    checked = tuple(targets)
    for target in checked:
        if not isinstance(target, Target):
            raise InputError(f"targets must be Target objects; got {target!r}")
    if not checked:
        raise InputError("there is nothing to solve: give at least one target")
    return checked


def _restored(fields: dict[str, Any]) -> Target:
    """A target from a pickle."""
    target = object.__new__(Target)
    target._keep(**fields)
    return target


def _is_a_point(place: ArrayLike) -> bool:
    try:
        return np.shape(place) == (3,)
    except ValueError:  # rows of different lengths
        return False
