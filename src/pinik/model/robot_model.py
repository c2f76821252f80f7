"""A robot: a Pinocchio model with names, limits, angles, placements and Jacobians."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Self

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number, as_se3
from ..description import reader as urdf
from ..description.packages import Surroundings
from ..errors import InputError, UnknownNameError
from .angles import set_angles
from .build import build_model
from .configurations import checked, checked_many, random_configuration
from .jacobians import as_reference_frame, frame_jacobian, relative_jacobian
from .joint import Joint, joints_of
from .poses import read_poses
from .ranges import configuration_limits, velocity_limits

__all__ = ["RobotModel"]

Array = NDArray[np.float64]


class RobotModel:
    """A robot, loaded from a URDF by `pinik.load`: a Pinocchio model whose joints and frames are addressed by name.

    A *configuration* `q` is Pinocchio's own vector (nq,): a continuous joint takes two entries, (cos, sin), and a
    floating joint takes seven, xyz and a quaternion xyzw. *Angles* describe the same configuration by joint name, with
    one number for each joint that turns about or slides along one axis [rad or m]. `configuration` and `angles` convert
    between them. The world is the root link if the root is fixed, else the frame in which the root joint moves.

    All methods check their arguments, and none modifies them. Robots can be pickled and used from several threads.

    Attributes:
        name: The name in the catalogue, or the name that the URDF gives.
        model: The `pinocchio.Model`, for use with Pinocchio's own functions; do not modify it. Its position limits are
            those of the robot.
        description: The checked URDF.
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: The folders that are searched first for the packages of meshes.
        allow_outside: Whether the URDF may open meshes outside its own folder, its packages and `package_dirs`.
        warnings: What was repaired or left out while loading.
        joints: All movable joints in the model's order, including followers and the root joint. Pinocchio reads the
            tree depth first and the joints of a link by name, except that leaders come before their followers.
        joint_names: The names of the one-axis joints that are not followers, in the model's order.
        frame_names: The names of all frames, in the model's order.
        mimics: Follower → (leader, multiplier, offset), where follower = multiplier · leader + offset. The leader of a
            chain is the joint at its end, which follows no other. Where Pinocchio's model cannot have that joint before
            its followers, it follows one of them instead, and a warning says so; all angles stay as the file says.
        lower, upper: Joint limits (n_joints,) in the order of `joint_names` [rad or m], infinite where there are none.
            Those of a leader also keep its followers inside their limits.
        velocity_limits: The largest velocities (n_joints,) that the file gives, in the order of `joint_names` [rad/s or
            m/s]; infinite where it gives none, or 0. Those of a leader also keep its followers within theirs.
        lower_q, upper_q: The same limits for the entries of q (nq,), infinite for entries that are not an angle.
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
        allow_outside: bool = False,
    ) -> None:
        self.description = description
        self.name = name or description.name
        self.root = root
        self.package_dirs = tuple(Path(folder) for folder in package_dirs)
        self.allow_outside = allow_outside
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
        self.lower_q, self.upper_q = configuration_limits(self.model, self.joints)
        first_entries = [joint.idx_q for joint in self._settable]
        self.lower, self.upper = self.lower_q[first_entries], self.upper_q[first_entries]
        self.velocity_limits = velocity_limits(self.joint_names, self.joints, description)
        for limits in (self.lower, self.upper, self.lower_q, self.upper_q, self.velocity_limits):
            limits.setflags(write=False)

    def __repr__(self) -> str:
        counts = f"{len(self.joint_names)} joints, {len(self.frame_names)} frames"
        return f"<{type(self).__name__} {self.name!r}: {counts}, {self.root} root>"

    def __reduce__(self) -> tuple[Any, ...]:
        # The model is built again, because Pinocchio 4.1.0 crashes when it uses a deserialised model with mimic joints.
        build = partial(type(self), name=self.name, root=self.root, package_dirs=self.package_dirs)
        build = partial(build, mimic=self._mimic, srdf=self._srdf, allow_outside=self.allow_outside)
        return build, (self.description,), {"warnings": self.warnings}

    def with_root(self, root: str) -> Self:
        """The same robot with another root joint: "fixed", "free_flyer" or "planar".

        Raises:
            InputError: Another root than these.
        """
        settings: dict[str, Any] = {"package_dirs": self.package_dirs, "mimic": self._mimic, "srdf": self._srdf}
        settings["allow_outside"] = self.allow_outside
        return type(self)(self.description, name=self.name, root=root, **settings)

    @property
    def surroundings(self) -> Surroundings:
        """The files around the URDF, as they are now: what an address in it leads to."""
        return Surroundings(self.description.path, self.package_dirs, self.allow_outside)

    @property
    def data(self) -> Any:
        """The `pinocchio.Data` of the calling thread, which `placement` and `jacobian` use."""
        if not hasattr(self._local, "data"):
            self._local.data = self.model.createData()
        return self._local.data

    @property
    def local(self) -> threading.local:
        """This thread's own storage, for this class and for what others keep with a robot."""
        return self._local

    @property
    def urdf(self) -> str:
        """The robot as URDF text, as Pinocchio reads it: checked and with plain numbers, without shapes."""
        return self.description.xml

    @property
    def srdf(self) -> Path | None:
        """The SRDF file that belongs to the URDF, with its poses and disabled collisions; None if there is none."""
        return self._srdf

    @property
    def poses(self) -> dict[str, Array]:
        """The named configurations in the SRDF file that belongs to the URDF: name → q (nq,).

        The arrays are read-only; copy one to change it. Joints that a pose does not mention are neutral. Without an
        SRDF file there are no poses. The file is read when the poses are first asked for.

        Raises:
            RobotLoadError: The SRDF file cannot be read; or a pose in it has no number for a joint, or one outside its
                limits, sets a joint in two ways, or misspells its name; the message names the pose and the joint.
        """
        poses = {name: q.copy() for name, q in self._poses.items()}
        for q in poses.values():
            q.setflags(write=False)
        return poses

    @cached_property
    def _poses(self) -> dict[str, Array]:
        if self._srdf is None:
            return {}
        names = {joint.name for joint in self.description.joints}
        return read_poses(self._srdf, self.model, self.joints, names)

    def frame_id(self, name: str) -> int:
        """The index of a frame in the model. If a link and a joint share the name, it is the link's.

        Raises:
            UnknownNameError: No such frame; the message lists near names.
        """
        try:
            return self._frames[name]
        except (KeyError, TypeError):
            raise UnknownNameError("frame", name, self.frame_names) from None

    def joint(self, name: str) -> Joint:
        """The movable joint of this name.

        Raises:
            UnknownNameError: No such joint; the message lists near names.
        """
        try:
            return self._joints_by_name[name]
        except (KeyError, TypeError):
            fixed = any(tag.name == name and tag.kind == "fixed" for tag in self.description.joints)
            hint = "it is a fixed joint" if fixed else ""
            raise UnknownNameError("joint", name, self._joints_by_name, hint) from None

    def settable_joint(self, name: str) -> Joint:
        """The joint of this name, which must not be a follower.

        Raises:
            UnknownNameError: No such joint; the message lists near names.
            InputError: The joint mimics another one; the message names that one.
        """
        joint = self.joint(name)
        if joint.leader is not None:
            raise InputError(
                f"joint {name!r} mimics {joint.leader!r} and does not move by itself; set {joint.leader!r} instead"
            )
        return joint

    def neutral(self) -> Array:
        """The neutral configuration (nq,): joints that are not followers at 0, joint placements the identity."""
        return np.array(pinocchio.neutral(self.model))

    def random(self, rng: np.random.Generator | int | None = None) -> Array:
        """A random configuration (nq,) inside the limits.

        Angles are uniform between their limits; without limits, in ±π for turning joints and in ±1 m for sliding
        joints (`Joint.range_to_draw_from`). Placements of floating and planar joints are uniform in orientation, and in
        ±1 m along each axis.

        Args:
            rng: A `numpy.random.Generator`, or a seed for one; None for a different configuration each time.

        Raises:
            InputError: `rng` is neither a generator nor a seed.
        """
        try:
            rng = np.random.default_rng(rng)
        except (TypeError, ValueError):
            raise InputError(f"rng must be a numpy Generator or a whole number of at least 0; got {rng!r}") from None
        return random_configuration(self.neutral(), self.joints, (self.lower_q, self.upper_q), rng)

    def configuration(
        self,
        angles: Mapping[str, float] | None = None,
        joint_placements: Mapping[str, pinocchio.SE3 | ArrayLike] | None = None,
    ) -> Array:
        """The configuration (nq,) with these angles and joint placements; all other joints are neutral.

        Limits are not checked. Followers may be given too: one that is given without its leader sets the leader, and
        one that is given with it must agree. `configuration(angles(q), joint_placements(q))` returns `q`, except for
        rounding and the signs of quaternions.

        Args:
            angles: Joint name → angle [rad], or position [m] for prismatic joints.
            joint_placements: Name of a floating or planar joint → how far it moved from where it is when neutral, along
                the axes of its frame: an SE3 or a 4×4 matrix. A planar joint moves across its axis.

        Raises:
            UnknownNameError: No such joint; the message lists near names.
            InputError: A follower that disagrees with its leader, a joint of the wrong kind, a number that is not
                finite, or a placement outside the plane of a planar joint.
        """
        for given in (angles, joint_placements):
            if given is not None and not isinstance(given, Mapping):
                raise InputError(f"joints must be given by name, as in {{'joint': 0.3}}; got {given!r}")
        q = self.neutral()
        set_angles(
            q,
            {
                self.joint(name): as_finite_number(angle, f"the angle of joint {name!r}")
                for name, angle in (angles or {}).items()
            },
        )
        for name, placement in (joint_placements or {}).items():
            joint = self.joint(name)
            if joint.has_one_axis:
                raise InputError(f"joint {name!r} is {joint.kind}; give its angle in angles, not a placement")
            joint.set_placement(q, as_se3(placement, f"the placement of joint {name!r}"))
        return q

    def angles(self, q: ArrayLike) -> dict[str, float]:
        """The angles of all one-axis joints at `q`, followers included: joint name → angle [rad or m].

        The angle of a continuous joint lies in (−π, π], unless another joint mimics it.

        Raises:
            InputError: `q` is not a configuration of this robot.
        """
        values = self.check_configuration(q)
        return {joint.name: joint.angle(values) for joint in self.joints if joint.has_one_axis}

    def joint_placements(self, q: ArrayLike) -> dict[str, pinocchio.SE3]:
        """The placements of all floating and planar joints at `q`, a free root included: name → SE3.

        Each is relative to where the joint is when it is neutral, along the axes of its frame.

        Raises:
            InputError: `q` is not a configuration of this robot.
        """
        values = self.check_configuration(q)
        return {j.name: j.placement(values) for j in self.joints if not j.has_one_axis}

    def check_configuration(self, q: ArrayLike, what: str = "q") -> Array:
        """Check that `q` is a configuration of this robot, and return a copy as float64.

        Quaternions and (cos, sin) pairs are normalised.

        Args:
            q: The configuration (nq,).
            what: What the error message calls it.

        Raises:
            InputError: A wrong shape, a number that is not finite, or a quaternion or (cos, sin) pair that is not of
                unit length.
        """
        return checked(self.model, self.joints, q, what, f"the configuration of {self.name!r}")

    def check_configurations(self, q: ArrayLike, what: str = "q") -> Array:
        """Check N configurations (N, nq) as `check_configuration` does, and return a copy as float64."""
        return checked_many(self.model, self.joints, q, what)

    def placement(self, frame: str, q: ArrayLike, relative_to: str | None = None) -> pinocchio.SE3:
        """The placement of a frame, by forward kinematics.

        Args:
            frame: The name of the frame.
            q: The configuration (nq,).
            relative_to: The frame in which the placement is expressed; the world when None.

        Returns:
            The SE3 of the frame [m]: oMf, or rMf where r is `relative_to`.

        Raises:
            UnknownNameError: No such frame; the message lists near names.
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
        """The Jacobian of a frame: J v is the velocity of the frame for joint velocities v (nv,).

        Args:
            frame: The name of the frame.
            q: The configuration (nq,).
            axes: Where and in which axes the velocity is expressed: "local_world_aligned" (at the frame's origin, in
                the world's axes), "local" (at the frame's origin, in its own axes), "world" (at the world's origin, in
                its axes), or a `pinocchio.ReferenceFrame`.
            relative_to: A frame that replaces the world: the velocity is relative to it, and expressed in its axes.

        Returns:
            J (6, nv), with the linear rows first [m/rad or m/m], then the angular rows [rad/rad or rad/m].

        Raises:
            UnknownNameError: No such frame; the message lists near names.
            InputError: Unknown axes, or `q` is not a configuration of this robot.
        """
        axes = as_reference_frame(axes)
        frame_id = self.frame_id(frame)
        reference = None if relative_to is None else self.frame_id(relative_to)
        pinocchio.computeJointJacobians(self.model, self.data, self.check_configuration(q))
        if reference is None:
            return frame_jacobian(self.model, self.data, frame_id, axes)
        return relative_jacobian(self.model, self.data, frame_id, reference, axes)


def _frames_by_name(model: pinocchio.Model) -> dict[str, int]:
    links = {frame.name: i for i, frame in enumerate(model.frames) if frame.type == pinocchio.BODY}
    return {frame.name: links.get(frame.name, i) for i, frame in enumerate(model.frames)}
