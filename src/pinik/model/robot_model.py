"""A robot: a Pinocchio model with names, limits, angles, placements and Jacobians."""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import cache, cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number, as_many, as_se3, as_vector
from ..description import reader as urdf
from ..errors import InputError, RobotLoadError, UnknownNameError
from .build import build_model
from .joint import LARGEST_UNIT_ERROR, Joint, joints_of, limits_cut_by_followers
from .poses import read_poses

if TYPE_CHECKING:
    from ..problem.targets import Target
    from ..solvers.base import Solver
    from ..solving.solution import Solution

__all__ = ["Robot"]

Array = NDArray[np.float64]

_AXES = {
    "local_world_aligned": pinocchio.LOCAL_WORLD_ALIGNED,
    "local": pinocchio.LOCAL,
    "world": pinocchio.WORLD,
}


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
        self.joints = joints_of(self.model, description)
        self._joints_by_name = {joint.name: joint for joint in self.joints}
        self._settable = tuple(j for j in self.joints if j.has_one_axis and j.leader is None)
        self.joint_names = tuple(j.name for j in self._settable)
        self.mimics = {j.name: (j.leader, j.multiplier, j.offset) for j in self.joints if j.leader is not None}
        self.lower, self.upper = self._joint_limits()
        self.lower_q, self.upper_q = self._configuration_limits()
        for limits in (self.lower, self.upper, self.lower_q, self.upper_q):
            limits.setflags(write=False)

    def __repr__(self) -> str:
        return (
            f"<Robot {self.name!r}: {len(self.joint_names)} joints, {len(self.frame_names)} frames, {self.root} root>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # Built anew: a serialized Pinocchio 4.1.0 model with mimic joints crashes when it is used.
        build = partial(Robot, name=self.name, root=self.root, package_dirs=self.package_dirs)
        return partial(build, mimic=self._mimic, srdf=self._srdf), (self.description,), {"warnings": self.warnings}

    def with_root(self, root: str) -> Robot:
        """The same robot, hung in the world otherwise: "fixed", "free_flyer" or "planar"."""
        settings: dict[str, Any] = {"package_dirs": self.package_dirs, "mimic": self._mimic, "srdf": self._srdf}
        return Robot(self.description, name=self.name, root=root, **settings)

    @property
    def data(self) -> Any:
        """This thread's `pinocchio.Data`, used by `placement` and `jacobian`."""
        if not hasattr(self._local, "data"):
            self._local.data = self.model.createData()
        return self._local.data

    @property
    def kept(self) -> dict[Any, Any]:
        """This thread's own store for what others compiled for this robot."""
        try:
            kept: dict[Any, Any] = self._local.kept
        except AttributeError:
            kept = self._local.kept = {}
        return kept

    @property
    def poses(self) -> dict[str, Array]:
        """Named configurations from the SRDF beside the URDF: name → q (nq,), read-only; copy one to change it.

        Raises:
            RobotLoadError: There is an SRDF, and it is faulty.
        """
        poses = {name: q.copy() for name, q in self._poses.items()}
        for q in poses.values():
            q.setflags(write=False)
        return poses

    @cached_property
    def _poses(self) -> dict[str, Array]:
        return {} if self._srdf is None else read_poses(self._srdf, self.model, self.joints)

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
        try:
            rng = np.random.default_rng(rng)
        except (TypeError, ValueError):
            raise InputError(f"rng is a numpy Generator or a seed, a whole number from 0; got {rng!r}") from None
        q = self.neutral()
        for joint, lower, upper in zip(self._settable, self.lower, self.upper, strict=True):
            low, high = joint.range_to_draw_from(lower, upper)
            joint.set_angle(q, rng.uniform(low, high))
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
        for given in (angles, joint_placements):
            if given is not None and not isinstance(given, Mapping):
                raise InputError(f"joints are given by name, as in {{'joint': 0.3}}; got {given!r}")
        q = self.neutral()
        for name, value in (angles or {}).items():
            joint = self.settable_joint(name)
            joint.set_angle(q, as_finite_number(value, f"the angle of joint {name!r}"))
        for name, placement in (joint_placements or {}).items():
            joint = self.settable_joint(name)
            if joint.has_one_axis:
                raise InputError(f"joint {name!r} is {joint.kind}; give its scalar in angles")
            joint.set_placement(q, as_se3(placement, f"the placement of joint {name!r}"))
        return q

    def angles(self, q: ArrayLike) -> dict[str, float]:
        """Joint name → angle (rad, or m for prismatic) at `q`, followers included.

        A continuous joint's angle lies in (−π, π], unless others mimic it.
        """
        values = self.check_configuration(q)
        return {joint.name: joint.angle(values) for joint in self.joints if joint.has_one_axis}

    def joint_placements(self, q: ArrayLike) -> dict[str, pinocchio.SE3]:
        """Name → SE3 in its parent, for the floating and planar joints and a free root."""
        values = self.check_configuration(q)
        return {j.name: j.placement(values) for j in self.joints if not j.has_one_axis}

    def check_configuration(self, q: ArrayLike, what: str = "q") -> Array:
        """A fresh float64 copy of `q`, checked.

        Raises:
            InputError: Wrong shape, not finite, or a (cos, sin) pair or quaternion that is not of unit length.
        """
        values = as_vector(q, self.model.nq, what, f"the configuration of {self.name!r}")
        if self.model.nq == self.model.nv:  # only numbers, each for itself
            return values
        for joint in self.joints:
            circle = joint.circle(values)
            if circle is not None and abs(float(circle[0] @ circle[0]) - 1.0) > LARGEST_UNIT_ERROR:
                got, words = circle
                raise InputError(
                    f"{what}: {joint.kind} joint {joint.name!r} holds {words}, of unit length; got {got.tolist()}"
                )
        return np.array(pinocchio.normalize(self.model, values))

    def check_configurations(self, q: ArrayLike, what: str = "q") -> Array:
        """A fresh float64 copy of N configurations (N, nq), each checked as `check_configuration` does."""
        values = as_many(q, (self.model.nq,), what)
        for joint in self.joints:
            circle = joint.circle(values.T)
            if circle is not None:
                lengths = np.linalg.norm(circle[0], axis=0)
                for k in np.flatnonzero(np.abs(lengths**2 - 1.0) > LARGEST_UNIT_ERROR)[:1]:
                    self.check_configuration(values[k], f"{what}[{k}]")
                circle[0][:] /= lengths
        return values

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
        return _solve_from_keywords()(self, targets, position, method, options)

    def _joint_limits(self) -> tuple[Array, Array]:
        cut = [limits_cut_by_followers(joint, self.joints) for joint in self._settable]
        for joint, (lower, upper) in zip(self._settable, cut, strict=True):
            if lower > upper:
                raise RobotLoadError(
                    "the limits of the joints that mimic it leave it no room",
                    source=self.description.source,
                    element=f"joint {joint.name!r}",
                )
            if lower == upper and joint.lower < joint.upper:
                words = "the limits of the joints that mimic it leave it only the value"
                self.warnings += (f"joint {joint.name!r}: {words} {lower:g}",)
        return np.array([lower for lower, _ in cut]), np.array([upper for _, upper in cut])

    def _configuration_limits(self) -> tuple[Array, Array]:
        lower, upper = np.full(self.model.nq, -np.inf), np.full(self.model.nq, np.inf)
        for joint, low, high in zip(self._settable, self.lower, self.upper, strict=True):
            if joint.nq == 1:
                lower[joint.idx_q], upper[joint.idx_q] = low, high
        return lower, upper


@cache
def _solve_from_keywords() -> Callable[..., Solution]:
    """The loop's front, which stands below in the order of modules; looked up once, as that takes a microsecond."""
    from ..solving.front import solve_from_keywords

    return solve_from_keywords


def _frames_by_name(model: pinocchio.Model) -> dict[str, int]:
    links = {frame.name: i for i, frame in enumerate(model.frames) if frame.type == pinocchio.BODY}
    return {frame.name: links.get(frame.name, i) for i, frame in enumerate(model.frames)}
