"""A robot: a Pinocchio model with names, limits, angles, placements and Jacobians."""

from __future__ import annotations

import math
import os
import threading
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from . import packages, robot_catalog, urdf
from .checks import as_finite_number, as_se3, as_vector
from .errors import InputError, RobotLoadError, UnknownNameError, UrdfWarning
from .model import build_model

if TYPE_CHECKING:
    from .solution import Solution
    from .solvers import Solver
    from .targets import Target

__all__ = ["Joint", "Robot", "load"]

Array = NDArray[np.float64]

_WIDEST_RANGE = 100.0  # [rad or m]: wider limits, such as the ±1e16 of some files, are none
_AXES = {
    "local_world_aligned": pinocchio.LOCAL_WORLD_ALIGNED,
    "local": pinocchio.LOCAL,
    "world": pinocchio.WORLD,
}


@dataclass(frozen=True)
class Joint:
    """One movable joint and its place in the model's vectors.

    Attributes:
        name: As in the URDF; the root joint of a free or planar root is "root_joint".
        kind: "revolute", "continuous", "prismatic", "floating" or "planar". A continuous joint holds (cos, sin) in q,
            or its angle where others mimic it.
        id: Index in `pinocchio.Model.joints`.
        idx_q, nq: First entry and number of entries in `q`; a follower has none of its own.
        idx_v, nv: The same in a tangent vector.
        axis: Unit vector (3,) in the joint's frame, for the one-axis kinds.
        leader: The joint that this one mimics, or None; then angle = multiplier · leader + offset.
    """

    name: str
    kind: str
    id: int
    idx_q: int
    nq: int
    idx_v: int
    nv: int
    axis: tuple[float, float, float]
    leader: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0

    @property
    def has_one_axis(self) -> bool:
        """Whether one scalar (rad, or m for prismatic) describes the joint."""
        return self.kind in ("revolute", "continuous", "prismatic")

    def range_to_draw_from(self, lower: float, upper: float, slide_about: float = 0.0) -> tuple[float, float]:
        """The limits [rad or m] made finite, for drawing angles at random.

        Without limits, or with limits so wide that they are none, ±π for a turning joint and ±1 m about `slide_about`
        for a sliding one; with one limit, as much from there on.
        """
        half = 1.0 if self.kind == "prismatic" else math.pi
        if upper - lower <= _WIDEST_RANGE:
            return lower, upper
        if abs(lower) <= _WIDEST_RANGE:
            return lower, lower + 2.0 * half
        if abs(upper) <= _WIDEST_RANGE:
            return upper - 2.0 * half, upper
        middle = slide_about if self.kind == "prismatic" else 0.0
        return middle - half, middle + half


class Robot:
    """A Pinocchio model that speaks in names.

    Made by `pinik.load`. Configurations `q` are Pinocchio's own vectors; people and files use *angles*, one scalar
    per one-axis joint by name (rad, or m for prismatic joints).

    Attributes:
        name: The catalogue's name, or the one that the URDF gives itself.
        model: The `pinocchio.Model`; do not modify it.
        description: The checked URDF.
        root: "fixed", "free_flyer" or "planar".
        package_dirs: Where the meshes' packages are looked for first.
        warnings: What was mended or left out while loading, in words.
        joints: Every movable joint, followers and the root joint included, in the model's order.
        joint_names: The one-axis joints that can be set, in the model's order.
        frame_names: Every frame, in the model's order, links before joints of the same name.
        mimics: follower → (leader, multiplier, offset).
        lower, upper: Limits (n_joints,) in the order of `joint_names` [rad or m], infinite where unbounded;
            a leader's are cut by its followers'.
    """

    def __init__(
        self,
        description: urdf.Description,
        *,
        name: str | None = None,
        root: str = "fixed",
        package_dirs: Sequence[str | os.PathLike[str]] = (),
        mimic: bool = True,
        srdf: Path | None = None,
    ) -> None:
        self.description = description
        self.name = name or description.name
        self.root = root
        self.package_dirs = tuple(Path(folder) for folder in package_dirs)
        self.model, model_warnings = build_model(description, root=root, mimic=mimic)
        self.warnings = (*description.warnings, *model_warnings)
        self._mimic = mimic
        self._srdf = srdf
        self._local = threading.local()
        self._frames = _frames_by_name(self.model)
        self.frame_names = tuple(self._frames)
        self.joints = _joints(self.model, description)
        self._joints_by_name = {joint.name: joint for joint in self.joints}
        self._settable = tuple(j for j in self.joints if j.has_one_axis and j.leader is None)
        self.joint_names = tuple(j.name for j in self._settable)
        self.mimics = {j.name: (j.leader, j.multiplier, j.offset) for j in self.joints if j.leader is not None}
        self.lower, self.upper = self._joint_limits()
        self.lower_q, self.upper_q = self._configuration_limits()

    def __repr__(self) -> str:
        return (
            f"<Robot {self.name!r}: {len(self.joint_names)} joints, {len(self.frame_names)} frames, {self.root} root>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # Built anew: a serialized Pinocchio 4.1.0 model with mimic joints crashes when it is used.
        build = partial(Robot, name=self.name, root=self.root, package_dirs=self.package_dirs)
        return partial(build, mimic=self._mimic, srdf=self._srdf), (self.description,), {"warnings": self.warnings}

    @property
    def data(self) -> Any:
        """This thread's `pinocchio.Data`, used by `placement` and `jacobian`."""
        if not hasattr(self._local, "data"):
            self._local.data = self.model.createData()
        return self._local.data

    @cached_property
    def poses(self) -> dict[str, Array]:
        """Named configurations from the SRDF beside the URDF: name → q (nq,).

        Raises:
            RobotLoadError: There is an SRDF, and it is faulty.
        """
        if self._srdf is None:
            return {}
        model = pinocchio.Model(self.model)
        try:
            pinocchio.loadReferenceConfigurations(model, str(self._srdf), False)
        except (RuntimeError, ValueError) as error:
            raise RobotLoadError(f"the SRDF cannot be read: {error}", source=str(self._srdf)) from error
        references = model.referenceConfigurations
        return {entry.key(): pinocchio.normalize(model, np.array(entry.data())) for entry in references}

    def frame_id(self, name: str) -> int:
        """The model's index of a frame; a link is meant where a link and a joint share the name.

        Raises:
            UnknownNameError: No such frame; the message lists near names.
        """
        try:
            return self._frames[name]
        except (KeyError, TypeError):
            raise UnknownNameError("frame", name, self.frame_names) from None

    def joint(self, name: str) -> Joint:
        """The movable joint of that name.

        Raises:
            UnknownNameError: No such joint; the message lists near names.
        """
        try:
            return self._joints_by_name[name]
        except (KeyError, TypeError):
            fixed = any(tag.name == name and tag.kind == "fixed" for tag in self.description.joints)
            hint = "that one is a fixed joint" if fixed else ""
            raise UnknownNameError("joint", name, self._joints_by_name, hint) from None

    def settable_joint(self, name: str) -> Joint:
        """The joint of that name, if it can be set: not a follower.

        Raises:
            UnknownNameError: No such joint.
            InputError: The joint mimics another one; the message names it.
        """
        joint = self.joint(name)
        if joint.leader is not None:
            raise InputError(
                f"joint {name!r} mimics {joint.leader!r} and cannot be set by itself; set {joint.leader!r}"
            )
        return joint

    def neutral(self) -> Array:
        """Pinocchio's neutral configuration (nq,): every angle 0, every joint placement the identity."""
        return np.array(pinocchio.neutral(self.model))

    def random(self, rng: np.random.Generator | int | None = None) -> Array:
        """A random configuration (nq,).

        Angles are uniform inside the limits; where there are none, in ±π for a turning joint and ±1 m for a sliding
        one (see `Joint.range_to_draw_from`); free joint placements are uniform in orientation and in a cube of ±1 m.

        Args:
            rng: A `numpy.random.Generator`, or a seed for one.
        """
        rng = np.random.default_rng(rng)
        q = self.neutral()
        for joint, lower, upper in zip(self._settable, self.lower, self.upper, strict=True):
            low, high = joint.range_to_draw_from(lower, upper)
            self.set_angle(q, joint, rng.uniform(low, high))
        for joint in self.joints:
            if joint.kind == "floating":
                quaternion = rng.normal(size=4)
                q[joint.idx_q : joint.idx_q + 3] = rng.uniform(-1, 1, 3)
                q[joint.idx_q + 3 : joint.idx_q + 7] = quaternion / np.linalg.norm(quaternion)
            elif joint.kind == "planar":
                angle = rng.uniform(-math.pi, math.pi)
                q[joint.idx_q : joint.idx_q + 4] = (*rng.uniform(-1, 1, 2), math.cos(angle), math.sin(angle))
        return q

    def configuration(
        self,
        angles: Mapping[str, float] | None = None,
        joint_placements: Mapping[str, pinocchio.SE3 | ArrayLike] | None = None,
    ) -> Array:
        """The configuration (nq,) with these angles and joint placements, the rest neutral.

        Args:
            angles: Joint name → rad, or m for prismatic joints.
            joint_placements: Name of a floating or planar joint → its SE3 (or 4×4 matrix) in its parent.

        Raises:
            UnknownNameError: No such joint.
            InputError: A follower, a joint of the other kind, a number that is not finite, or a placement of a
                planar joint outside its plane.
        """
        q = self.neutral()
        for name, value in (angles or {}).items():
            joint = self.settable_joint(name)
            if not joint.has_one_axis:
                raise InputError(f"joint {name!r} is {joint.kind}; give its SE3 in joint_placements")
            self.set_angle(q, joint, as_finite_number(value, f"the angle of joint {name!r}"))
        for name, given in (joint_placements or {}).items():
            joint = self.settable_joint(name)
            if joint.has_one_axis:
                raise InputError(f"joint {name!r} is {joint.kind}; give its scalar in angles")
            self._set_joint_placement(q, joint, as_se3(given, f"the placement of joint {name!r}"))
        return q

    @staticmethod
    def set_angle(q: Array, joint: Joint, angle: float) -> None:
        """Write a one-axis joint's angle (rad, or m for prismatic) into `q`, in place."""
        if joint.nq == 2:
            q[joint.idx_q : joint.idx_q + 2] = math.cos(angle), math.sin(angle)
        else:
            q[joint.idx_q] = angle

    def angles(self, q: ArrayLike) -> dict[str, float]:
        """Joint name → angle (rad, or m for prismatic) at `q`, followers included.

        A continuous joint's angle lies in (−π, π], unless others mimic it.
        """
        values = self.check_configuration(q)
        return {joint.name: self._angle(values, joint) for joint in self.joints if joint.has_one_axis}

    def joint_placements(self, q: ArrayLike) -> dict[str, pinocchio.SE3]:
        """Name → SE3 in its parent, for the floating and planar joints and a free root."""
        values = self.check_configuration(q)
        return {j.name: _joint_placement(values, j) for j in self.joints if not j.has_one_axis}

    def check_configuration(self, q: ArrayLike, what: str = "q") -> Array:
        """A fresh float64 copy of `q`, checked.

        Raises:
            InputError: Wrong shape, not finite, or a (cos, sin) pair or quaternion that is not of unit length.
        """
        values = as_vector(q, self.model.nq, what, f"the configuration of {self.name!r}")
        for joint in self.joints:
            part = None
            if joint.nq == 2:
                part, words = values[joint.idx_q : joint.idx_q + 2], "(cos, sin)"
            elif joint.kind == "floating":
                part, words = values[joint.idx_q + 3 : joint.idx_q + 7], "its quaternion xyzw"
            elif joint.kind == "planar":
                part, words = values[joint.idx_q + 2 : joint.idx_q + 4], "its (cos, sin)"
            if part is not None and abs(float(part @ part) - 1.0) > 1e-3:
                raise InputError(
                    f"{what}: {joint.kind} joint {joint.name!r} holds {words}, of unit length; got {part.tolist()}"
                )
        return np.array(pinocchio.normalize(self.model, values))

    def placement(self, frame: str, q: ArrayLike, relative_to: str | None = None) -> pinocchio.SE3:
        """Where a frame is.

        Args:
            frame: Its name.
            q: The configuration (nq,).
            relative_to: A frame to express it in; the world when None.

        Returns:
            oMf, or rMf with `relative_to` [m].

        Raises:
            UnknownNameError: No such frame.
            InputError: `q` is not a configuration of this robot.
        """
        frame_id = self.frame_id(frame)
        reference = None if relative_to is None else self.frame_id(relative_to)
        pinocchio.forwardKinematics(self.model, self.data, self.check_configuration(q))
        placement = pinocchio.updateFramePlacement(self.model, self.data, frame_id).copy()
        if reference is None:
            return placement
        return pinocchio.updateFramePlacement(self.model, self.data, reference).actInv(placement)

    def jacobian(
        self,
        frame: str,
        q: ArrayLike,
        axes: str | pinocchio.ReferenceFrame = "local_world_aligned",
        relative_to: str | None = None,
    ) -> Array:
        """The Jacobian (6, nv) of a frame: its velocity is J·v, linear rows [m] first, then angular rows [rad].

        Args:
            frame: Its name.
            q: The configuration (nq,).
            axes: "local_world_aligned" (the frame's origin, the world's axes), "local" (the frame's origin and
                axes), "world" (the world's origin and axes), or a `pinocchio.ReferenceFrame`.
            relative_to: A frame that takes the world's place: the motion is that relative to it, in its axes.

        Raises:
            UnknownNameError: No such frame.
            InputError: Unknown axes, or `q` is not a configuration of this robot.
        """
        if not isinstance(axes, pinocchio.ReferenceFrame):
            if not isinstance(axes, str) or axes not in _AXES:
                raise InputError(
                    f"axes is one of {', '.join(map(repr, _AXES))} or a pinocchio.ReferenceFrame; got {axes!r}"
                )
            axes = _AXES[axes]
        frame_id = self.frame_id(frame)
        reference = None if relative_to is None else self.frame_id(relative_to)
        values = self.check_configuration(q)
        pinocchio.computeJointJacobians(self.model, self.data, values)
        if reference is None:
            return self._frame_jacobian(frame_id, axes)
        return self._relative_jacobian(frame_id, reference, axes)

    def _frame_jacobian(self, frame_id: int, axes: pinocchio.ReferenceFrame) -> Array:
        if self.model.nv == 0:
            return np.zeros((6, 0))  # without a column Pinocchio ends the process
        J = np.array(pinocchio.getFrameJacobian(self.model, self.data, frame_id, axes))
        return J.reshape(6, self.model.nv)  # a single one comes back as (6,)

    def _relative_jacobian(self, frame_id: int, reference: int, axes: pinocchio.ReferenceFrame) -> Array:
        local = self._frame_jacobian(frame_id, pinocchio.LOCAL)
        moving = self._frame_jacobian(reference, pinocchio.LOCAL)
        oMf = pinocchio.updateFramePlacement(self.model, self.data, frame_id)
        rMf = pinocchio.updateFramePlacement(self.model, self.data, reference).actInv(oMf)
        J = local - rMf.toActionMatrixInverse() @ moving
        if axes == pinocchio.LOCAL:
            return np.array(J)
        if axes == pinocchio.WORLD:
            return np.array(rMf.toActionMatrix() @ J)
        return np.vstack([rMf.rotation @ J[:3], rMf.rotation @ J[3:]])

    def solve(
        self,
        targets: str | Target | Sequence[Target],
        position: ArrayLike | None = None,
        *,
        method: str | type[Solver] | Solver = "dls",
        **options: Any,
    ) -> Solution:
        """Joint values that put frames where the targets want them; see `pinik.solve` for every option.

        Args:
            targets: A frame's name, followed by `Target`'s keywords (position, rotation, axis, …); or one Target,
                or several.
            position: Target position (3,) [m] when `targets` is a frame's name.
            method: A solver's name, class or instance.
            **options: `Target`'s keywords, `pinik.solve`'s options and the solver's parameters.
        """
        from .loop import solve_from_keywords

        return solve_from_keywords(self, targets, position, method, options)

    def _joint_limits(self) -> tuple[Array, Array]:
        lower, upper = [], []
        for joint in self._settable:
            low, high = self._own_limits(joint)
            for follower in self.joints:
                if follower.leader != joint.name or follower.multiplier == 0.0:
                    continue
                ends = [(limit - follower.offset) / follower.multiplier for limit in self._own_limits(follower)]
                low, high = max(low, min(ends)), min(high, max(ends))
            if low > high:
                raise RobotLoadError(
                    "the limits of the joints that mimic it leave it no room",
                    source=self.description.source,
                    element=f"joint {joint.name!r}",
                )
            if low == high and len(set(self._own_limits(joint))) == 2:
                words = f"joint {joint.name!r}: the limits of the joints that mimic it leave it only the value {low:g}"
                self.warnings += (words,)
            lower.append(low + 0.0)  # a negative multiplier turns 0 into −0, which numpy holds to be below 0
            upper.append(high + 0.0)
        return np.array(lower), np.array(upper)

    def _own_limits(self, joint: Joint) -> tuple[float, float]:
        tag = next(tag for tag in self.description.joints if tag.name == joint.name)
        if joint.kind == "continuous":
            return -math.inf, math.inf
        return tag.lower or 0.0, tag.upper or 0.0

    def _configuration_limits(self) -> tuple[Array, Array]:
        lower, upper = np.full(self.model.nq, -np.inf), np.full(self.model.nq, np.inf)
        for joint, low, high in zip(self._settable, self.lower, self.upper, strict=True):
            if joint.nq == 1:
                lower[joint.idx_q], upper[joint.idx_q] = low, high
        return lower, upper

    def _angle(self, q: Array, joint: Joint) -> float:
        if joint.leader is not None:
            return joint.multiplier * self._angle(q, self._joints_by_name[joint.leader]) + joint.offset
        if joint.nq == 2:
            return math.atan2(q[joint.idx_q + 1], q[joint.idx_q])
        return float(q[joint.idx_q])

    @staticmethod
    def _set_joint_placement(q: Array, joint: Joint, placement: pinocchio.SE3) -> None:
        if joint.kind == "floating":
            q[joint.idx_q : joint.idx_q + 7] = pinocchio.SE3ToXYZQUAT(placement)
            return
        out_of_plane = max(abs(placement.translation[2]), abs(placement.rotation[2, 2] - 1.0))
        if out_of_plane > 1e-9:
            raise InputError(f"planar joint {joint.name!r} moves in its x-y plane only and turns about z")
        cosine, sine = placement.rotation[0, 0], placement.rotation[1, 0]
        q[joint.idx_q : joint.idx_q + 4] = (*placement.translation[:2], cosine, sine)


def load(
    source: str | os.PathLike[str],
    *,
    root: str = "fixed",
    package_dirs: Iterable[str | os.PathLike[str]] = (),
    mimic: bool = True,
) -> Robot:
    """Load a robot.

    Args:
        source: A catalogue name ("arm", "lion", "panda", …: `pinik.catalog()`), a path to a .urdf file, or URDF text.
        root: How the root link hangs in the world: "fixed", "free_flyer" or "planar".
        package_dirs: Folders in which `package://` addresses of meshes are looked for first.
        mimic: Whether mimic joints follow their leaders; False leaves them all free.

    Raises:
        RobotLoadError: The description is faulty; the message names the element and the cause.
        UnknownNameError: No robot of that name.
        InputError: An unknown root, a source that is neither name nor path nor text, or one folder for a list.

    Warns:
        UrdfWarning: For whatever was mended or left out, and for meshes that were not found.
    """
    if isinstance(package_dirs, (str, os.PathLike)):
        raise InputError(f"package_dirs takes a list of folders; got the single {package_dirs!r}")
    name, srdf, path_or_text = _locate(source)
    description = urdf.read(path_or_text)
    robot = Robot(description, name=name, root=root, package_dirs=tuple(package_dirs), mimic=mimic, srdf=srdf)
    missing = [a for a in description.meshes if not _mesh_found(a, description.path, robot.package_dirs)]
    if missing:
        count = "1 mesh was" if len(missing) == 1 else f"{len(missing)} meshes were"
        robot.warnings += (
            f"{count} not found ({missing[0]}{', …' if len(missing) > 1 else ''}); kinematics needs none",
        )
    for words in robot.warnings:
        warnings.warn(f"{robot.name}: {words}", UrdfWarning, stacklevel=2)
    return robot


def _locate(source: str | os.PathLike[str]) -> tuple[str | None, Path | None, str | Path]:
    """(catalogue name, SRDF, path or text) for what a person gave."""
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(f"a robot is a catalogue name, a path or URDF text; got {source!r}")
    if isinstance(source, str):
        if source.lstrip("\ufeff \t\r\n").startswith("<"):
            return None, None, source
        looks_like_path = os.sep in source or source.endswith((".urdf", ".xml", ".xacro"))
        if not looks_like_path and (source in robot_catalog.catalog() or not os.path.exists(source)):
            entry = robot_catalog.find(source)
            return entry.name, entry.srdf, entry.urdf
    path = Path(source)
    srdf = path.with_suffix(".srdf")
    return None, srdf if srdf.is_file() else None, path


def _mesh_found(address: str, urdf_path: Path | None, package_dirs: Sequence[Path]) -> bool:
    return packages.resolve(address, urdf_path=urdf_path, package_dirs=package_dirs) is not None


def _frames_by_name(model: pinocchio.Model) -> dict[str, int]:
    links = {frame.name: i for i, frame in enumerate(model.frames) if frame.type == pinocchio.BODY}
    return {frame.name: links.get(frame.name, i) for i, frame in enumerate(model.frames)}


def _joints(model: pinocchio.Model, description: urdf.Description) -> tuple[Joint, ...]:
    tags = {tag.name: tag for tag in description.joints}
    joints = []
    for joint_id in range(1, model.njoints):
        name = model.names[joint_id]
        shape = model.joints[joint_id]
        tag = tags.get(name)
        kind = tag.kind if tag else ("floating" if shape.nq == 7 else "planar")
        mimic = tag.mimic if tag and shape.nq == 0 else None
        joints.append(
            Joint(
                name=name,
                kind=kind,
                id=joint_id,
                idx_q=shape.idx_q,
                nq=shape.nq,
                idx_v=shape.idx_v,
                nv=shape.nv,
                axis=tag.axis if tag else (0.0, 0.0, 1.0),
                leader=mimic.leader if mimic else None,
                multiplier=mimic.multiplier if mimic else 1.0,
                offset=mimic.offset if mimic else 0.0,
            )
        )
    return tuple(joints)


def _joint_placement(q: Array, joint: Joint) -> pinocchio.SE3:
    if joint.kind == "floating":
        return pinocchio.XYZQUATToSE3(q[joint.idx_q : joint.idx_q + 7])
    x, y, cosine, sine = q[joint.idx_q : joint.idx_q + 4]
    rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return pinocchio.SE3(rotation, np.array([x, y, 0.0]))
