"""A Pinocchio model whose joints and frames are addressed by name: its placements and Jacobians."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ..description.reader import Description
from ..errors import InputError, UnknownNameError
from .configurations import checked, checked_many
from .jacobians import as_reference_frame, frame_jacobian, relative_jacobian
from .joint import Joint, joints_of

__all__ = ["NamedModel"]

Array = NDArray[np.float64]


class NamedModel:
    """A Pinocchio model whose joints and frames are addressed by name.

    Attributes:
        name: The name in the catalogue, or the name that the URDF gives.
        model: The `pinocchio.Model`, for use with Pinocchio's own functions; do not modify it. Its position limits are
            those of the robot.
        description: The checked URDF; `description.path` is its file, or None.
        joints: All movable joints in the model's order, including followers and the root joint. Pinocchio reads the
            tree depth first and the joints of a link by name, except that leaders come before their followers.
        joint_names: The names of the one-axis joints that are not followers, in the model's order.
        frame_names: The names of all frames, in the model's order.
        mimics: Follower → (leader, multiplier, offset), where follower = multiplier · leader + offset. The leader of a
            chain is the joint at its end, which follows no other. Where Pinocchio's model cannot have that joint before
            its followers, it follows one of them instead, and a warning says so; all angles stay as the file says.
    """

    def __init__(self, name: str, model: pinocchio.Model, description: Description) -> None:
        self.name, self.model, self.description = name, model, description
        self._local = threading.local()
        self._frames = _frames_by_name(model)
        self.frame_names = tuple(self._frames)
        self.joints = joints_of(model, description)
        self._joints_by_name = {joint.name: joint for joint in self.joints}
        self.joint_names = tuple(j.name for j in self.joints if j.has_one_axis and j.leader is None)
        self.mimics = {j.name: (j.leader, j.multiplier, j.offset) for j in self.joints if j.leader is not None}

    @property
    def data(self) -> Any:
        """The `pinocchio.Data` of the calling thread, which `placement` and `jacobian` use."""
        if not hasattr(self._local, "data"):
            self._local.data = self.model.createData()
        return self._local.data

    @property
    def local(self) -> threading.local:
        """For pinik itself: this thread's own storage, for this class and for what others keep with a robot."""
        return self._local

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
        """For pinik itself: the joint of this name, which must not be a follower.

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
