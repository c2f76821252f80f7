"""Many questions of the same kind, read from targets or from a frame and its places."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..checks import as_array, as_many, as_numbers, as_plain, as_points
from ..errors import InputError
from ..problem.target_values import as_position
from ..problem.targets import Target, as_targets
from ..rotations import as_rotations, as_se3
from .native.codec import goals_of, read_places

__all__ = ["read_placements", "read_questions"]

Array = NDArray[np.float64]


def read_questions(
    targets: Any, places: Any, tool: Any, relative_to: str | None, threads: int = 1
) -> tuple[tuple[Target, ...], Array]:
    """Read N questions of the same kind, given as targets or as a frame and its places.

    Args:
        targets: The name of a frame, or one Target as a pattern, with the N targets in `places`; or N targets of the
            same kind; or N sequences with the same number of targets of the same kinds.
        places: (N, 4, 4) homogeneous matrices or N SE3, for positions and rotations; or positions (N, 3) [m], with None
            along axes that are free, the same ones in all places.
        tool, relative_to: As for `Target`; only with the name of a frame.
        threads: The number of threads that read the places.

    Returns:
        The pattern of the targets, empty if there are none, and their numbers (N, targets, 18).

    Raises:
        InputError: The targets are faulty, or of different kinds; the message names the index of the first faulty one.
    """
    if not isinstance(targets, str) and (tool is not None or relative_to is not None):
        raise InputError(
            "tool= and relative_to= need the name of a frame; with Target objects, pass them to Target(...)"
        )
    if places is None:
        return _listed(targets)
    places, along = _with_free_axes(as_plain(places, "places"))
    goals, turned = _goals_at(places, threads)
    pattern = _pattern(targets, turned, along, tool, relative_to)
    if pattern.position is None:
        goals[:, :3] = 0.0
    if pattern.rotation is None:
        goals[:, 3:] = 0.0
    return (pattern,), goals[:, np.newaxis]


def _listed(targets: Any) -> tuple[tuple[Target, ...], Array]:
    """Problems given as Target objects."""
    if isinstance(targets, (str, Target)):
        raise InputError("places must say where the frame should be: (N, 4, 4) matrices, N SE3, or positions (N, 3)")
    if not isinstance(targets, Iterable) or isinstance(targets, memoryview):
        raise InputError(f"targets must be a frame's name, a Target, or a sequence of them; got {targets!r}")
    asked = [as_targets(each) for each in targets]
    if not asked:
        return (), np.zeros((0, 0, 18))
    kind = [target.shape for target in asked[0]]
    for number, each in enumerate(asked):
        if [target.shape for target in each] != kind:
            raise InputError(
                f"targets[{number}] must be of the same kind as targets[0]; solve each kind in a separate call"
            )
    return asked[0], np.array([goals_of(each) for each in asked])


def _with_free_axes(places: Any) -> tuple[Any, tuple[bool, bool, bool]]:
    """(the places, with 0 for coordinates of None; along which axes the places have numbers)."""
    rows = places.tolist() if isinstance(places, np.ndarray) and places.dtype == object else places
    everywhere = True, True, True
    if not (isinstance(rows, (list, tuple)) and any(map(_has_none, rows))):
        return places, everywhere
    points = [as_position(row, f"places[{k}]") for k, row in enumerate(rows)]
    free = np.isnan(points)
    for k in np.flatnonzero((free != free[0]).any(axis=1))[:1]:
        raise InputError(f"places[{k}] must leave the same axes free as places[0]; got {rows[k]!r} and {rows[0]!r}")
    x, y, z = (~free[0]).tolist()
    return np.nan_to_num(np.array(points)), (x, y, z)


def _has_none(place: Any) -> bool:
    return isinstance(place, (list, tuple, np.ndarray)) and any(part is None for part in place)


def _goals_at(places: Any, threads: int) -> tuple[Array, bool]:
    """(the numbers of the targets at these places (N, 18), whether they have rotations).

    The compiled engine reads what needs no conversion, and only the rest is checked here.
    """
    read = read_places(places, threads)
    if read is None:
        rotations, points = read_placements(places)
        return _as_goals(rotations, points), rotations is not None
    goals, doubtful = read
    if len(doubtful):
        try:
            rotations, points = read_placements(places[doubtful], doubtful)
        except InputError:
            read_placements(places)  # raises the error with the index of the place
            raise
        goals[doubtful] = _as_goals(rotations, points)
    return goals, places.ndim == 3


def _as_goals(rotations: Array | None, points: Array) -> Array:
    goals = np.zeros((len(points), 18))
    goals[:, :3] = points
    if rotations is not None:
        goals[:, 3:12] = rotations.reshape(-1, 9)
    return goals


def read_placements(places: Any, indices: NDArray[np.int64] | None = None) -> tuple[Array | None, Array]:
    """Read N places as rotations and points.

    Args:
        places: (N, 4, 4) homogeneous matrices, N SE3, or positions (N, 3) [m].
        indices: The places' indices, for warnings; 0, 1, … when None.

    Returns:
        (the rotation matrices (N, 3, 3), or None if there are only positions; the points (N, 3) [m]).

    Raises:
        InputError: A place is faulty; the message names the first one's index.
    """
    if isinstance(places, Sequence) and any(isinstance(place, pinocchio.SE3) for place in places):
        places = np.array([_matrix_of(place, f"places[{k}]") for k, place in enumerate(places)])
    numbers = as_numbers(places, "places")
    if numbers.shape == (0,):
        return np.zeros((0, 3, 3)), np.zeros((0, 3))
    if numbers.ndim != 3:
        return None, as_points(numbers, "places")
    matrices = as_many(numbers, (4, 4), "places")
    for k in np.flatnonzero((np.abs(matrices[:, 3] - (0.0, 0.0, 0.0, 1.0)) > 1e-9).any(axis=1))[:1]:
        as_se3(matrices[k], f"places[{k}]")
    return as_rotations(matrices[:, :3, :3], "places", indices), as_points(matrices[:, :3, 3], "places")


def _matrix_of(place: Any, what: str) -> Array:
    """A place (4, 4) in a list with SE3s; whether it is a placement is checked later, for all at once."""
    return np.array(place.homogeneous) if isinstance(place, pinocchio.SE3) else as_array(place, (4, 4), what)


def _pattern(targets: Any, turned: bool, along: tuple[bool, bool, bool], tool: Any, relative_to: str | None) -> Target:
    """The pattern of targets that are given as a frame or a pattern, and places."""
    if isinstance(targets, str):
        rotation = np.eye(3) if turned else None
        position = [0.0 if known else None for known in along]
        return Target(targets, position, rotation=rotation, tool=tool, relative_to=relative_to)
    if not isinstance(targets, Target):
        raise InputError(f"with places, targets must be a frame's name or one Target; got {targets!r}")
    if any(asked and not known for asked, known in zip(targets.along, along, strict=True)):
        raise InputError(
            f"places must have numbers along the axes where the target of {targets.frame!r} asks for them; leave the "
            "same axes free in the target, as in position=[None, None, 0.0]"
        )
    if targets.axis is not None or (targets.rotation is not None and not turned):
        raise InputError(f"places do not specify all that the target of {targets.frame!r} needs; give N Target objects")
    return targets
