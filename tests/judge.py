"""The judge of answers, for tests and benchmarks alike: plain Pinocchio on the robot's own file, without pinik.

It uses only two things of pinik's robot: the bytes of its file and the layout of `robot.model`. Pinocchio builds a
model from the file with every joint free (`plain_robot`); limits and mimic joints come from the XML; quaternions,
tools, reference frames and axes are computed here.
"""

from __future__ import annotations

import functools
import math
import weakref
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

import pinik
from plain_robot import Entries, PlainRobot, entries_of

Array = NDArray[np.float64]

TOLERANCE = (1e-4, 1e-3)  # [m], [rad]: pinik's default
ON_TOP = 1e-6  # [m]: nearer to the point that it should look at, a frame looks at it (docs/targets.md)
UNIT = 1e-6  # how far a quaternion or (cos, sin) may be from unit length
_CIRCLE = {1: 1, 2: 0, 4: 2, 7: 3}  # count of entries of q → where the (cos, sin) or quaternion in them begins
AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "-x": (-1, 0, 0), "-y": (0, -1, 0), "-z": (0, 0, -1)}


class Miss(NamedTuple):
    """How far one target is missed [m], [rad]; None for what it does not ask for.

    `offset` is the position error along the target's own axes, and `tolerance` what the target itself allows.
    """

    position: float | None
    orientation: float | None
    offset: tuple[float, ...] = ()
    tolerance: Any = None

    def is_within(self, tolerance: Sequence[Any]) -> bool:
        """Whether the errors are within the target's own tolerance, or else within `tolerance`."""
        metres, radians = tolerance if self.tolerance is None else self.tolerance
        if np.ndim(metres):
            near = all(abs(off) <= most for off, most in zip(self.offset, metres, strict=True)) or not self.offset
        else:
            near = self.position is None or self.position <= metres
        return near and (self.orientation is None or self.orientation <= radians)

    def scaled(self, factor: float) -> Miss:
        """All errors multiplied by a factor."""
        own = [None if error is None else factor * error for error in self[:2]]
        return Miss(own[0], own[1], tuple(factor * off for off in self.offset), self.tolerance)


class Errors(NamedTuple):
    """How far a configuration misses its targets and leaves its limits.

    Attributes:
        each: How far each target is missed.
        outside: Joint → its distance from its limits [rad or m], or of its (cos, sin) or quaternion from unit length.
    """

    each: tuple[Miss, ...]
    outside: dict[str, float]

    @property
    def position(self) -> float | None:
        """The largest position error [m]."""
        return _largest(miss.position for miss in self.each)

    @property
    def orientation(self) -> float | None:
        """The largest orientation error [rad]."""
        return _largest(miss.orientation for miss in self.each)

    def are_within(self, tolerance: Sequence[Any] = TOLERANCE, factor: float = 1.0) -> bool:
        """Whether every target is met within `factor` times its tolerance; limits are not considered."""
        return all(miss.scaled(1.0 / factor).is_within(tolerance) for miss in self.each)


def judge(robot: pinik.Robot, targets: Any, q: ArrayLike) -> Errors:
    """Return the errors of configuration `q`.

    `targets` is a Target, a mapping of Target's keywords, or several of these. With a mapping the judge converts
    rpy, quaternions and named axes itself, so that pinik's own conversion is judged as well.
    """
    plain, angles, free, off = _read(robot, np.asarray(q, dtype=np.float64))
    errors = judge_angles(plain, targets, angles, free)
    return errors._replace(outside=off | errors.outside)


def judge_angles(
    plain: PlainRobot, targets: Any, angles: Mapping[str, float], free: Mapping[str, Array] | None = None
) -> Errors:
    """Return the errors of joint angles [rad or m] and entries of q of floating and planar joints, by name."""
    several = [targets] if isinstance(targets, (pinik.Target, Mapping)) else list(targets)
    wishes = [asked(target) for target in several]
    named = [name for wish in wishes for name in (wish.frame, wish.relative_to) if name is not None]
    frames = dict(zip(named, plain.placements(named, angles, free), strict=True))
    return Errors(tuple(_miss(frames, wish) for wish in wishes), plain.outside(angles))


def is_good(
    robot: pinik.Robot, targets: Any, q: ArrayLike, tolerance: Sequence[float] = TOLERANCE, *, limits: bool = True
) -> bool:
    """Whether `q` meets every target inside every limit."""
    errors = judge(robot, targets, q)
    return errors.are_within(tolerance) and not (limits and errors.outside)


def is_inside(robot: pinik.Robot, q: ArrayLike) -> bool:
    """Whether `q` is inside every limit of the robot's file."""
    plain, angles, _, off = _read(robot, np.asarray(q, dtype=np.float64))
    return not off and not plain.outside(angles)


def outside_rows(robot: pinik.Robot, q: Array) -> tuple[dict[str, float], dict[str, float]]:
    """How far configurations (n, nq) are outside what is allowed.

    Returns:
        Joint → its largest distance from its limits in the robot's file [rad or m], and joint → that of its (cos, sin)
        or quaternion from unit length; both for the joints that are outside only.
    """
    angles: dict[str, Array] = {}
    off: dict[str, float] = {}
    for name, entries, several in _layout(robot):
        own = q[:, entries]
        circle = own[:, _CIRCLE[own.shape[1]] :]
        if circle.shape[1] and not (np.abs(np.linalg.norm(circle, axis=1) - 1.0) <= UNIT).all():
            off[name] = float(np.abs(np.linalg.norm(circle, axis=1) - 1.0).max())
        if not several:
            angles[name] = own[:, 0] if own.shape[1] == 1 else np.arctan2(own[:, 1], own[:, 0])
    limits = _plain(robot.description.document, robot.root).limits(angles)
    outside = {}
    for name, (lower, upper) in limits.items():
        if not ((lower <= angles[name]) & (angles[name] <= upper)).all():
            outside[name] = float(np.maximum(lower - angles[name], angles[name] - upper).max())
    return outside, off


def plain_placement(robot: pinik.Robot, frame: str, q: ArrayLike, relative_to: str | None = None) -> pinocchio.SE3:
    """Where Pinocchio alone puts a frame, in the world or in another frame."""
    plain, angles, free, _ = _read(robot, np.asarray(q, dtype=np.float64))
    placement, reference = plain.placements([frame, relative_to or frame], angles, free)
    return pinocchio.SE3(placement if relative_to is None else _inverse(reference) @ placement)


def assert_honest(
    solution: pinik.Solution, targets: Any = None, *, tolerance: Sequence[float] = TOLERANCE, limits: bool = True
) -> None:
    """Assert that a solution's verdict and errors are right and, with `limits`, that its q is inside them.

    Give `targets` to judge it by what was asked instead of by what the solution says was asked.
    """
    errors = judge(solution.robot, solution.targets if targets is None else targets, solution.q)
    said = [*solution.errors, (solution.position_error, solution.orientation_error)]
    for one, other in zip(said, [*errors.each, (errors.position, errors.orientation)], strict=True):
        assert _agree(one[0], other[0], 1e-11), f"it says {said}, and the judge finds {errors}"
        assert _agree(one[1], other[1], 1e-6), f"it says {said}, and the judge finds {errors}"
    assert not (limits and errors.outside), f"outside the limits: {errors.outside}"
    hair = 1e-6  # rounding may decide either way at the tolerance itself
    if errors.are_within(tolerance, 1.0 - hair):
        assert solution.success, f"{solution.message}, and the judge finds {errors}"
    if not errors.are_within(tolerance, 1.0 + hair):
        assert not solution.success, f"{solution.message}, and the judge finds {errors}"


def assert_good(
    solution: pinik.Solution, targets: Any = None, *, tolerance: Sequence[float] = TOLERANCE, limits: bool = True
) -> None:
    """Assert that a solution claims success and that the claim is right."""
    assert solution.success, solution.message
    assert_honest(solution, targets, tolerance=tolerance, limits=limits)


class Asked(NamedTuple):
    """A target as 4×4 matrices and vectors."""

    frame: str
    relative_to: str | None
    tool: Array
    position: Array | None
    rotation: Array | None
    axis: Array | None
    direction: Array | None
    at: Array | None
    tolerance: Any


def asked(target: pinik.Target | Mapping[str, Any]) -> Asked:
    """Read a Target's fields, or convert a mapping of Target's keywords."""
    if isinstance(target, pinik.Target):
        names = ("frame", "position", "rotation", "axis", "direction", "at", "tool", "relative_to", "tolerance")
        return _asked(**{name: getattr(target, name) for name in names})
    return _asked(**target)


def _asked(
    frame: str, position: Any = None, rotation: Any = None, rpy: Any = None, quat_xyzw: Any = None,
    quat_wxyz: Any = None, placement: Any = None, axis: Any = None, direction: Any = None, at: Any = None,
    tool: Any = None, relative_to: str | None = None, weight: float = 1.0, tolerance: Any = None,
) -> Asked:  # fmt: skip
    if placement is not None:
        pose = _matrix(placement)
        position, rotation = pose[:3, 3], pose[:3, :3]
    elif rpy is not None:
        rotation = _about_axis("z", rpy[2]) @ _about_axis("y", rpy[1]) @ _about_axis("x", rpy[0])
    elif quat_xyzw is not None:
        rotation = rotation_of_quaternion(*quat_xyzw)
    elif quat_wxyz is not None:
        w, x, y, z = quat_wxyz
        rotation = rotation_of_quaternion(x, y, z, w)
    axis = AXES[axis] if isinstance(axis, str) else axis
    numbers = (position, rotation, axis, direction, at)
    numbers = [None if n is None else np.array(n, dtype=float) for n in numbers]  # None in a position becomes NaN
    return Asked(frame, relative_to, _matrix(tool), *numbers, tolerance)


def rotation_of_quaternion(x: float, y: float, z: float, w: float) -> Array:
    """The rotation q v q* of a quaternion of any length (Hamilton): its columns are the turned unit vectors."""
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    ) / (x * x + y * y + z * z + w * w)


def _about_axis(name: str, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}
    return np.array(rows.get(name, [[c, -s, 0], [s, c, 0], [0, 0, 1]]))


def _matrix(placement: Any) -> Array:
    """4×4 of an SE3, a 4×4, a point, or nothing."""
    if isinstance(placement, pinocchio.SE3):
        return np.array(placement.homogeneous)
    matrix = np.eye(4)
    if placement is not None:
        given = np.array(placement, dtype=np.float64)
        matrix[:3] = given[:3] if given.ndim == 2 else np.column_stack([np.eye(3), given])
    return matrix


def _inverse(M: Array) -> Array:
    inverse = np.eye(4)
    inverse[:3, :3], inverse[:3, 3] = M[:3, :3].T, -M[:3, :3].T @ M[:3, 3]
    return inverse


def _miss(frames: Mapping[str, Array], wish: Asked) -> Miss:
    """Compare frame and target in the axes of the reference frame."""
    found = frames[wish.frame] @ wish.tool
    if wish.relative_to is not None:
        found = _inverse(frames[wish.relative_to]) @ found
    p, R = found[:3, 3], found[:3, :3]
    position, offset = None, ()
    if wish.position is not None:
        missed = np.where(np.isnan(wish.position), 0.0, p - wish.position)
        position = float(np.linalg.norm(missed))
        offset = tuple(missed if wish.rotation is None else wish.rotation.T @ missed)
    if wish.rotation is not None:
        turn = wish.rotation.T @ R
        skew = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        angle = math.atan2(float(np.linalg.norm(skew)), float(np.trace(turn)) - 1.0)
        return Miss(position, angle, offset, wish.tolerance)
    if wish.axis is None:
        return Miss(position, None, offset, wish.tolerance)
    line = wish.direction if wish.at is None else wish.at - p
    if wish.at is not None and np.linalg.norm(line) < ON_TOP:
        return Miss(position, 0.0, offset, wish.tolerance)
    pointing = R @ wish.axis
    angle = math.atan2(float(np.linalg.norm(np.cross(pointing, line))), float(pointing @ line))
    return Miss(position, angle, offset, wish.tolerance)


def _read(robot: pinik.Robot, q: Array) -> tuple[PlainRobot, dict[str, float], dict[str, Array], dict[str, float]]:
    """(the plain robot, angles, entries of floating and planar joints, joints off their unit circles) at `q`."""
    angles: dict[str, float] = {}
    free: dict[str, Array] = {}
    off: dict[str, float] = {}
    for name, entries, several in _layout(robot):
        own = q[entries]
        circle = own[_CIRCLE[len(own)] :]
        if len(circle) and not abs(np.linalg.norm(circle) - 1.0) <= UNIT:
            off[name] = float(np.linalg.norm(circle) - 1.0)
        if several:
            free[name] = own
        else:
            angles[name] = float(own[0]) if len(own) == 1 else math.atan2(own[1], own[0])
    return _plain(robot.description.document, robot.root), angles, free, off


def _layout(robot: pinik.Robot) -> list[Entries]:
    if robot not in _LAYOUTS:
        _LAYOUTS[robot] = entries_of(robot.model)
    return _LAYOUTS[robot]


_LAYOUTS: weakref.WeakKeyDictionary[pinik.Robot, list[Entries]] = weakref.WeakKeyDictionary()


@functools.lru_cache(maxsize=64)
def _plain(document: bytes, root: str) -> PlainRobot:
    return PlainRobot(document, root)


def _largest(errors: Iterable[float | None]) -> float | None:
    known = [error for error in errors if error is not None]
    return float(np.max(known)) if known else None


def _agree(said: float | None, found: float | None, most: float) -> bool:
    if said is None or found is None:
        return said is found
    return math.isclose(said, found, rel_tol=1e-9, abs_tol=most)
