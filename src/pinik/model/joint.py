"""One movable joint: where it stands in Pinocchio's vectors, its angle or placement, its limits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.reader import Description
from ..errors import InputError

__all__ = ["Joint", "joints_of", "limits_cut_by_followers"]

Array = NDArray[np.float64]

WIDEST_RANGE = 100.0  # [rad or m]: wider limits, such as the ±1e16 of some files, are none
LARGEST_UNIT_ERROR = 1e-3  # of the squared length of a (cos, sin) pair or quaternion
_FREE = (-math.inf, math.inf)


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
        lower, upper: Its own limits in the URDF [rad or m]; infinite for the kinds that have none.
        leader: The joint that this one mimics, or None; then angle = multiplier · leader + offset, and the entries of
            q and v are the leader's.
    """

    name: str
    kind: str
    id: int
    idx_q: int
    nq: int
    idx_v: int
    nv: int
    axis: tuple[float, float, float]
    lower: float
    upper: float
    leader: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0

    @property
    def has_one_axis(self) -> bool:
        """Whether one scalar (rad, or m for prismatic) describes the joint."""
        return self.kind in ("revolute", "continuous", "prismatic")

    def angle(self, q: Array) -> float:
        """A one-axis joint's angle at `q` [rad or m], a follower's too."""
        own = math.atan2(q[self.idx_q + 1], q[self.idx_q]) if self.nq == 2 else float(q[self.idx_q])
        return own if self.leader is None else self.multiplier * own + self.offset

    def set_angle(self, q: Array, angle: float) -> None:
        """Write a one-axis joint's angle [rad or m] into `q`, in place.

        Raises:
            InputError: A floating or planar joint, which has no angle.
        """
        if not self.has_one_axis:
            raise InputError(f"joint {self.name!r} is {self.kind} and has no angle; give its SE3 in joint_placements")
        if self.nq == 2:
            q[self.idx_q : self.idx_q + 2] = math.cos(angle), math.sin(angle)
        else:
            q[self.idx_q] = angle

    def placement(self, q: Array) -> pinocchio.SE3:
        """A floating or planar joint's SE3 in its parent at `q`."""
        if self.kind == "floating":
            return pinocchio.XYZQUATToSE3(q[self.idx_q : self.idx_q + 7])
        x, y, cosine, sine = q[self.idx_q : self.idx_q + 4]
        rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        return pinocchio.SE3(rotation, np.array([x, y, 0.0]))

    def set_placement(self, q: Array, placement: pinocchio.SE3) -> None:
        """Write a floating or planar joint's SE3 into `q`, in place.

        Raises:
            InputError: A placement outside a planar joint's plane.
        """
        if self.kind == "floating":
            q[self.idx_q : self.idx_q + 7] = pinocchio.SE3ToXYZQUAT(placement)
            return
        out_of_plane = max(abs(placement.translation[2]), abs(placement.rotation[2, 2] - 1.0))
        if out_of_plane > 1e-9:
            raise InputError(f"planar joint {self.name!r} moves in its x-y plane only and turns about z")
        cosine, sine = placement.rotation[0, 0], placement.rotation[1, 0]
        q[self.idx_q : self.idx_q + 4] = (*placement.translation[:2], cosine, sine)

    def circle(self, q: Array) -> tuple[Array, str] | None:
        """(the entries of `q` that have unit length, what they are), or None where there are none."""
        if self.nq == 2:
            return q[self.idx_q : self.idx_q + 2], "(cos, sin)"
        if self.kind == "floating":
            return q[self.idx_q + 3 : self.idx_q + 7], "its quaternion xyzw"
        if self.kind == "planar":
            return q[self.idx_q + 2 : self.idx_q + 4], "its (cos, sin)"
        return None

    def range_to_draw_from(self, lower: float, upper: float, slide_about: float = 0.0) -> tuple[float, float]:
        """The limits [rad or m] made finite, for drawing angles at random.

        Without limits, or with limits so wide that they are none, ±π about zero for a turning joint and ±1 m about
        `slide_about` for a sliding one; moved inside the limits where it would reach out.
        """
        if upper - lower <= WIDEST_RANGE:
            return lower, upper
        half, middle = (1.0, slide_about) if self.kind == "prismatic" else (math.pi, 0.0)
        middle = min(max(middle, lower + half), upper - half)
        return middle - half, middle + half


def joints_of(model: pinocchio.Model, description: Description) -> tuple[Joint, ...]:
    """Every movable joint of a model, in its order; what the model does not tell comes from the description."""
    tags = {tag.name: tag for tag in description.joints}
    joints = []
    for joint_id in range(1, model.njoints):
        name, shape = model.names[joint_id], model.joints[joint_id]
        tag = tags.get(name)
        mimic = tag.mimic if tag and shape.nq == 0 else None
        leader = model.joints[model.getJointId(mimic.leader)] if mimic else shape
        bounded = tag is not None and tag.kind in ("revolute", "prismatic")
        lower, upper = (tag.lower or 0.0, tag.upper or 0.0) if tag and bounded else _FREE
        joints.append(
            Joint(
                name=name,
                kind=tag.kind if tag else ("floating" if shape.nq == 7 else "planar"),
                id=joint_id,
                idx_q=leader.idx_q,
                nq=shape.nq,
                idx_v=leader.idx_v,
                nv=shape.nv,
                axis=tag.axis if tag else (0.0, 0.0, 1.0),
                lower=lower,
                upper=upper,
                leader=mimic.leader if mimic else None,
                multiplier=mimic.multiplier if mimic else 1.0,
                offset=mimic.offset if mimic else 0.0,
            )
        )
    return tuple(joints)


def limits_cut_by_followers(joint: Joint, joints: Iterable[Joint]) -> tuple[float, float]:
    """(lower, upper) of a joint [rad or m] that keep it and all that mimic it inside; lower > upper if nothing does."""
    lower, upper = joint.lower, joint.upper
    for follower in joints:
        if follower.leader == joint.name and follower.multiplier != 0.0:
            ends = [(limit - follower.offset) / follower.multiplier for limit in (follower.lower, follower.upper)]
            lower, upper = max(lower, min(ends)), min(upper, max(ends))
    return lower + 0.0, upper + 0.0  # a negative multiplier turns 0 into −0, which numpy holds to be below 0
