"""A robot as Pinocchio alone reads its file, with every joint free; limits and mimic joints come from the XML."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterable, Mapping
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import pinocchio
from numpy.typing import NDArray

Array = NDArray[np.float64]
Entries = tuple[str, slice, bool]

ROUNDING = 1e-12  # relative; for a follower's limit converted to its leader's
ROOTS = {"free_flyer": pinocchio.JointModelFreeFlyer, "planar": pinocchio.JointModelPlanar}


class Tag(NamedTuple):
    """What the file says about a joint: its kind, its own limits [rad or m], and (leader, multiplier, offset)."""

    kind: str
    lower: float
    upper: float
    mimics: tuple[str, float, float] | None


class PlainRobot:
    """Pinocchio's model of a URDF text, and the limits and mimic joints in that text.

    Attributes:
        model: Pinocchio's model, in which followers are free too.
        joints: Its joints and their entries of q.
        tags: Joint → what the file says about it, without the fixed joints.
    """

    def __init__(self, text: str | bytes, root: str = "fixed") -> None:
        tree = ElementTree.fromstring(text)
        self.tags = {tag.attrib["name"]: _tag(tag) for tag in tree.findall("joint") if tag.attrib["type"] != "fixed"}
        for part in tree.findall("link"):
            for shape in [*part.findall("visual"), *part.findall("collision")]:
                part.remove(shape)
        words = (ElementTree.tostring(tree, encoding="unicode"), *([ROOTS[root]()] if root in ROOTS else []))
        self.model = pinocchio.buildModelFromXML(*words)
        self.joints = entries_of(self.model)
        self._limits: dict[frozenset[str], dict[str, tuple[float, float]]] = {}
        self._thread = threading.local()

    def placements(
        self, frames: Iterable[str], angles: Mapping[str, float], free: Mapping[str, Array] | None = None
    ) -> list[Array]:
        """Return the 4×4 of each frame.

        Args:
            frames: Their names.
            angles: Joint → rad or m; followers that are not named here follow, others are at 0.
            free: Floating or planar joint → its entries of q; neutral where not given.
        """
        q = pinocchio.neutral(self.model)
        for name, entries, several in self.joints:
            if several:
                q[entries] = (free or {}).get(name, q[entries])
            else:
                angle = self.angle(name, angles)
                q[entries] = angle if entries.stop - entries.start == 1 else (math.cos(angle), math.sin(angle))
        if not hasattr(self._thread, "data"):
            self._thread.data = self.model.createData()
        pinocchio.forwardKinematics(self.model, self._thread.data, q)
        return [self._placement(self._thread.data, frame) for frame in frames]

    def _placement(self, data: pinocchio.Data, frame: str) -> Array:
        """The placement of the link of that name, or else of the joint."""
        if not self.model.existFrame(frame):
            raise KeyError(frame)
        link = self.model.existFrame(frame, pinocchio.BODY)
        number = self.model.getFrameId(frame, pinocchio.BODY) if link else self.model.getFrameId(frame)
        return np.array(pinocchio.updateFramePlacement(self.model, data, number).homogeneous)

    def angle(self, name: str, angles: Mapping[str, float]) -> float:
        """A joint's own angle [rad or m], or else the one that the file's mimic joints give it, or else 0."""
        source, multiplier, offset = self._source(name, frozenset(angles))
        return multiplier * angles.get(source, 0.0) + offset

    def limits(self, free: Iterable[str]) -> dict[str, tuple[float, float]]:
        """The limits [rad or m] of joints that do not follow others.

        The limits of followers narrow those of their leader, unless that would leave it no room to move.
        """
        names = frozenset(free)
        if names not in self._limits:
            self._limits[names] = {name: self._cut(name, names) for name in names}
        return self._limits[names]

    def outside(self, angles: Mapping[str, float]) -> dict[str, float]:
        """Joint → its distance from its limits [rad or m], for those outside; NaN for a NaN."""
        limits = self.limits(angles)
        return {
            name: float(np.maximum(limits[name][0] - angle, angle - limits[name][1]))
            for name, angle in angles.items()
            if not limits[name][0] <= angle <= limits[name][1]
        }

    def _cut(self, name: str, free: frozenset[str]) -> tuple[float, float]:
        lower, upper = self.tags[name].lower, self.tags[name].upper
        for follower, tag in self.tags.items():
            multiplier, offset = self._share(follower, name, free)
            if multiplier != 0.0 and (math.isfinite(tag.lower) or math.isfinite(tag.upper)):
                ends = sorted((end - offset) / multiplier for end in (tag.lower, tag.upper))
                slack = ROUNDING * max(1.0, *(abs(end) for end in ends))
                cut = max(lower, ends[0] - slack), min(upper, ends[1] + slack)
                if cut[1] - cut[0] > 4.0 * slack:
                    lower, upper = cut
        return lower, upper

    def _share(self, follower: str, leader: str, free: frozenset[str]) -> tuple[float, float]:
        """(multiplier, offset) of a follower, direct or indirect, with respect to a leader; (0, 0) for other joints."""
        source, multiplier, offset = self._source(follower, free)
        return (multiplier, offset) if follower != leader == source else (0.0, 0.0)

    def _source(self, name: str, free: frozenset[str]) -> tuple[str, float, float]:
        """(joint, multiplier, offset): the free joint that gives a joint its angle, and how; or a joint at 0.

        It is the joint itself, the nearest of its leaders, or else a joint that follows the same leader: joints that
        move together may change roles.
        """
        top, multiplier, offset = self._led_by(name, free)
        if top in free:
            return top, multiplier, offset
        for other in sorted(free & self.tags.keys()):
            leader, its_multiplier, its_offset = self._led_by(other, frozenset())
            if leader == top and its_multiplier != 0.0:
                share = multiplier / its_multiplier
                return other, share, offset - share * its_offset
        return top, multiplier, offset

    def _led_by(self, name: str, free: frozenset[str]) -> tuple[str, float, float]:
        """(leader, multiplier, offset): up to the first leader that is free, or that follows no other joint."""
        multiplier, offset = 1.0, 0.0
        while name not in free and (mimics := self.tags[name].mimics) is not None:
            name, its_multiplier, its_offset = mimics
            multiplier, offset = multiplier * its_multiplier, multiplier * its_offset + offset
        return name, multiplier, offset


def _tag(tag: ElementTree.Element) -> Tag:
    kind, limit, follows = tag.attrib["type"], tag.find("limit"), tag.find("mimic")
    lower, upper = -math.inf, math.inf
    if kind in ("revolute", "prismatic"):
        said = {} if limit is None else limit.attrib
        lower, upper = float(said.get("lower", 0.0)), float(said.get("upper", 0.0))
    if follows is None:
        return Tag(kind, lower, upper, None)
    said = follows.attrib
    return Tag(kind, lower, upper, (said["joint"], float(said.get("multiplier", 1.0)), float(said.get("offset", 0.0))))


def entries_of(model: pinocchio.Model) -> list[Entries]:
    """(name, entries of q, whether it has several freedoms) of each joint that has entries."""
    pairs = list(zip(model.names, model.joints, strict=True))[1:]
    return [(name, slice(j.idx_q, j.idx_q + j.nq), j.nv > 1) for name, j in pairs if j.nq]
