"""One movable joint: its place in Pinocchio's vectors, its angle or placement, and its limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.reader import Description
from ..description.vocabulary import BOUNDED_KINDS
from ..errors import InputError

__all__ = ["Joint", "joints_of"]

Array = NDArray[np.float64]

WIDEST_RANGE = 100.0  # [rad or m]: wider limits, such as ±1e16 in some files, count as none
_FREE = (-math.inf, math.inf)


@dataclass(frozen=True)
class Joint:
    """A movable joint, and its place in the vectors of the model.

    Attributes:
        name: The name in the URDF; the joint of a free or planar root is called "root_joint".
        kind: "revolute", "continuous", "prismatic", "floating" or "planar". A continuous joint is (cos, sin) in q, or
            its angle if another joint mimics it.
        id: Index in `pinocchio.Model.joints`.
        idx_q, nq: First entry and number of entries in q. A follower has nq = 0, and its leader's first entry.
        idx_v, nv: The same for tangent vectors.
        axis: Unit axis (3,) in the joint's frame, for joints with one axis; the normal of a planar joint's plane.
        lower, upper: Its own limits in the URDF [rad or m], infinite where there are none.
        leader: The name of the joint that it mimics, or None. It never mimics another joint itself.
        multiplier, offset: A follower's angle is multiplier · leader's angle + offset.
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
        """Whether one number describes the joint: its angle [rad], or its position [m] if it is prismatic."""
        return self.kind in ("revolute", "continuous", "prismatic")

    def angle(self, q: Array) -> float:
        """The angle of a one-axis joint at `q` [rad or m]; a follower's is computed from its leader's."""
        own = math.atan2(q[self.idx_q + 1], q[self.idx_q]) if self.nq == 2 else float(q[self.idx_q])
        return own if self.leader is None else self.multiplier * own + self.offset

    def angle_range(self, lower: float, upper: float) -> tuple[float, float]:
        """For pinik itself: the range of the angle [rad or m] while the entry of q runs from `lower` to `upper`.

        Both may be infinite. For a follower that entry is its leader's.
        """
        if self.multiplier == 0.0:
            return self.offset, self.offset
        first, last = self.multiplier * lower + self.offset, self.multiplier * upper + self.offset
        return min(first, last), max(first, last)

    def set_angle(self, q: Array, angle: float) -> None:
        """Set the angle of a one-axis joint [rad or m] in `q`, in place; for a follower, by setting its leader.

        Raises:
            InputError: A floating or planar joint, which has no angle, or a follower with multiplier 0.
        """
        if not self.has_one_axis:
            raise InputError(f"joint {self.name!r} is {self.kind} and has no angle; give its SE3 in joint_placements")
        if self.leader is not None:
            q[self.idx_q] = self._leader_angle(angle)
        elif self.nq == 2:
            q[self.idx_q : self.idx_q + 2] = math.cos(angle), math.sin(angle)
        else:
            q[self.idx_q] = angle

    def _leader_angle(self, angle: float) -> float:
        """The leader's angle [rad or m] that puts this follower at `angle`."""
        leader = (angle - self.offset) / self.multiplier if self.multiplier else math.inf
        if not math.isfinite(leader):
            raise InputError(
                f"joint {self.name!r} cannot be set: it mimics {self.leader!r} with multiplier {self.multiplier:g} "
                f"and stays at {self.offset:g}"
            )
        return leader

    def placement(self, q: Array) -> pinocchio.SE3:
        """The placement of a floating or planar joint in its parent at `q`."""
        if self.kind == "floating":
            return pinocchio.XYZQUATToSE3(q[self.idx_q : self.idx_q + 7])
        x, y, cosine, sine = q[self.idx_q : self.idx_q + 4]
        rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        to_plane = self.to_plane
        return to_plane * pinocchio.SE3(rotation, np.array([x, y, 0.0])) * to_plane.inverse()

    def set_placement(self, q: Array, placement: pinocchio.SE3) -> None:
        """Set the placement of a floating or planar joint in `q`, in place.

        Raises:
            InputError: The placement is outside the plane of a planar joint.
        """
        if self.kind == "floating":
            q[self.idx_q : self.idx_q + 7] = pinocchio.SE3ToXYZQUAT(placement)
            return
        to_plane = self.to_plane
        inside = to_plane.inverse() * placement * to_plane
        out_of_plane = max(abs(inside.translation[2]), abs(inside.rotation[2, 2] - 1.0))
        if out_of_plane > 1e-9:
            axis = tuple(round(value, 6) + 0.0 for value in self.axis)
            plane = "x-y plane and turns only about z" if axis == (0.0, 0.0, 1.0) else f"plane across {axis}"
            raise InputError(f"planar joint {self.name!r} moves only in its {plane}")
        cosine, sine = inside.rotation[0, 0], inside.rotation[1, 0]
        q[self.idx_q : self.idx_q + 4] = (*inside.translation[:2], cosine, sine)

    @property
    def to_plane(self) -> pinocchio.SE3:
        """For pinik itself: the turn that brings z onto the axis, as a placement without translation.

        It leads from the frame in which Pinocchio's planar joint moves to that of the joint. It is the shortest one; if
        the axis points to negative z, it is the shortest one from −z, after a half turn about x.
        """
        half_turn = np.diag([1.0, -1.0, -1.0]) if self.axis[2] < 0.0 else np.eye(3)
        x, y, z = half_turn @ self.axis
        # Rodrigues' formula for a turn about (-y, x, 0), whose sine is the length of that vector, and its cosine z.
        slope = 1.0 / (1.0 + z)
        turn = np.array(
            [[1.0 - x * x * slope, -x * y * slope, x], [-x * y * slope, 1.0 - y * y * slope, y], [-x, -y, z]]
        )
        return pinocchio.SE3(half_turn @ turn, np.zeros(3))

    def circle(self, q: Array) -> tuple[Array, str] | None:
        """For pinik itself: the entries of `q` that must have length 1, and their name in words; None without."""
        if self.nq == 2:
            return q[self.idx_q : self.idx_q + 2], "(cos, sin)"
        if self.kind == "floating":
            return q[self.idx_q + 3 : self.idx_q + 7], "the quaternion xyzw"
        if self.kind == "planar":
            return q[self.idx_q + 2 : self.idx_q + 4], "(cos, sin)"
        return None

    def slides(self, index: int = 0) -> bool:
        """For pinik itself: whether tangent coordinate `index` of the joint translates instead of rotating."""
        kind = self.kind
        return kind == "prismatic" or (kind == "floating" and index < 3) or (kind == "planar" and index < 2)

    def range_to_draw_from(
        self, lower: float, upper: float, slide_about: float = 0.0, slide_by: float = 1.0
    ) -> tuple[float, float]:
        """For pinik itself: a finite range inside the limits [rad or m], from which random angles are drawn.

        It is the whole range, unless that is infinite or wider than 100. Then it is ±π about 0 for turning joints and
        ±`slide_by` about `slide_about` [m] for sliding joints, shifted into the limits.
        """
        if upper - lower <= WIDEST_RANGE:
            return lower, upper
        half, middle = (slide_by, slide_about) if self.kind == "prismatic" else (math.pi, 0.0)
        half = min(half, 0.5 * (upper - lower))
        middle = min(max(middle, lower + half), upper - half)
        return middle - half, middle + half


def joints_of(model: pinocchio.Model, description: Description) -> tuple[Joint, ...]:
    """All movable joints of a model, in its order, with what only the description knows.

    Who follows whom is read from the model.
    """
    tags = {tag.name: tag for tag in description.joints}
    owners: dict[int, str] = {}  # first entry of q → the joint that it belongs to
    joints = []
    for joint_id in range(1, model.njoints):
        name, shape = model.names[joint_id], model.joints[joint_id]
        tag = tags.get(name)
        leader = owners.setdefault(shape.idx_q, name)
        mimic = None if leader == name else shape.extract()
        bounded = tag is not None and tag.kind in BOUNDED_KINDS
        lower, upper = (tag.lower or 0.0, tag.upper or 0.0) if tag and bounded else _FREE
        joints.append(
            Joint(
                name=name,
                kind=tag.kind if tag else ("floating" if shape.nq == 7 else "planar"),
                id=joint_id,
                idx_q=shape.idx_q,
                nq=shape.nq,
                idx_v=shape.idx_v,
                nv=shape.nv,
                axis=tag.axis if tag else (0.0, 0.0, 1.0),
                lower=lower,
                upper=upper,
                leader=leader if mimic else None,
                multiplier=mimic.scaling if mimic else 1.0,
                offset=mimic.offset if mimic else 0.0,
            )
        )
    return tuple(joints)
