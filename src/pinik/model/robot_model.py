"""A robot: a Pinocchio model with names, limits, angles, placements and Jacobians."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Self

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..checks import as_finite_number
from ..description import reader as urdf
from ..description.packages import Surroundings
from ..errors import InputError, RobotLoadError, UrdfWarning
from ..rotations import as_se3
from .angles import set_angles
from .build import build_model
from .configurations import random_configuration
from .named_model import NamedModel
from .poses import Poses, read_poses
from .ranges import configuration_limits, velocity_limits

__all__ = ["RobotModel"]

Array = NDArray[np.float64]


class RobotModel(NamedModel):
    """A robot, loaded from a URDF by `pinik.load`: a Pinocchio model whose joints and frames are addressed by name.

    A *configuration* `q` is Pinocchio's own vector (nq,): a continuous joint takes two entries, (cos, sin), and a
    floating joint takes seven, xyz and a quaternion xyzw. *Angles* describe the same configuration by joint name, with
    one number for each joint that turns about or slides along one axis [rad or m]. `configuration` and `angles` convert
    between them. The world is the root link if the root is fixed, else the frame in which the root joint moves.

    All methods check their arguments, and none modifies them. Robots can be pickled and used from several threads.

    Attributes, besides those of every `NamedModel`:
        root: How the root link is attached to the world: "fixed", "free_flyer" or "planar".
        package_dirs: The folders that are searched first for the packages of meshes.
        allow_outside: Whether the URDF may open meshes outside its own folder, its packages and `package_dirs`.
        warnings: What was repaired or left out while loading.
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
        strict: bool = False,
    ) -> None:
        model, model_warnings = build_model(description, root=root, mimic=mimic)
        super().__init__(name or description.name, model, description)
        self.root = root
        self.package_dirs = tuple(Path(folder) for folder in package_dirs)
        self.allow_outside = allow_outside
        self.warnings = (*description.warnings, *model_warnings)
        self._mimic = mimic
        self._srdf = srdf
        self._strict = strict
        self._warns_of_poses = True
        self.lower_q, self.upper_q = configuration_limits(self.model, self.joints)
        first_entries = [self.joint(name).idx_q for name in self.joint_names]
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
        build = partial(build, strict=self._strict)
        return build, (self.description,), {"warnings": self.warnings}

    def with_root(self, root: str) -> Self:
        """The same robot with another root joint: "fixed", "free_flyer" or "planar".

        Raises:
            InputError: Another root than these.
        """
        settings: dict[str, Any] = {"package_dirs": self.package_dirs, "mimic": self._mimic, "srdf": self._srdf}
        settings |= {"allow_outside": self.allow_outside, "strict": self._strict}
        return type(self)(self.description, name=self.name, root=root, **settings)

    @property
    def surroundings(self) -> Surroundings:
        """For pinik itself: the files around the URDF, as they are now: what an address in it leads to."""
        return Surroundings(self.description.path, self.package_dirs, self.allow_outside)

    @property
    def urdf(self) -> str:
        """The robot as URDF text, as Pinocchio reads it: checked and with plain numbers, without shapes."""
        return self.description.xml

    @property
    def srdf(self) -> Path | None:
        """The SRDF file that belongs to the URDF, with its poses and disabled collisions; None if there is none."""
        return self._srdf

    @property
    def poses(self) -> Poses:
        """The named configurations in the SRDF file that belongs to the URDF: a mapping from names to q (nq,).

        The arrays are read-only; copy one to change it. Joints that a pose does not mention are neutral. Without an
        SRDF file there are no poses. The file is read when the poses are first asked for. A pose that sets a joint
        outside its limits is left out; asking for it by name raises an `UnknownNameError` that names the joint.

        Raises:
            RobotLoadError: The SRDF file cannot be read; or a pose in it has no number for a joint, sets a joint in two
                ways, misspells its name, or gives it a quaternion that is not of unit length; the message names the
                pose and the joint. For a robot that was loaded with `strict`, also if a pose is left out.

        Warns:
            UrdfWarning: A pose is left out; once for each robot.
        """
        poses = self.srdf_poses
        left_out = tuple(poses.left_out.values())
        if self._strict and left_out:
            raise RobotLoadError(left_out[0].cause, source=str(self._srdf), element=left_out[0].element)
        if self._warns_of_poses:
            self._warns_of_poses = False
            for words in left_out:
                warnings.warn(f"{self.name}: {words}", UrdfWarning, stacklevel=2)
        return poses

    @property
    def bodies(self) -> dict[str, int]:
        """For pinik itself: link → the joint of Pinocchio's model that carries it; those of one joint are one body."""
        return {link: self.model.frames[self.frame_id(link)].parentJoint for link in self.description.links}

    @cached_property
    def srdf_poses(self) -> Poses:
        """For pinik itself: what `poses` gives, without its warnings and without what `strict` makes of them."""
        if self._srdf is None:
            return Poses()
        names = {joint.name for joint in self.description.joints}
        return read_poses(self._srdf, self.model, self.joints, names)

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
