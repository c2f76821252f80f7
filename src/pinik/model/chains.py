"""The chain of joints that moves a frame: its joints, its two ends and its length."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .joint import Joint

__all__ = ["Chain", "chain_of"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Chain:
    """The joints that move a frame relative to a reference.

    If the reference is on another branch, the chain goes down that branch and up the branch of the frame.

    Attributes:
        joints: The joints of the chain, mimic joints included, base first.
        frame_joint, reference_joint: The ids of the joints that carry the frame and the reference (0: the world).
        frame_placement: The placement of the frame, or of the tool in it, relative to its joint.
        reference_placement: The placement of the reference relative to its joint; None for the world.
        frame_support, reference_support: The ids of all joints between the world and the frame or the reference.
        model: The Pinocchio model.
    """

    joints: tuple[Joint, ...]
    frame_joint: int
    reference_joint: int
    frame_placement: pinocchio.SE3
    reference_placement: pinocchio.SE3 | None
    frame_support: frozenset[int]
    reference_support: frozenset[int]
    model: pinocchio.Model

    @property
    def is_one_branch(self) -> bool:
        """Whether no joint of the chain moves the reference, so that the chain leads from base to frame directly."""
        return not any(joint.id in self.reference_support for joint in self.joints)

    @property
    def offsets(self) -> tuple[Array, ...]:
        """The steps along the frame's branch, each (3,) in the frame of the joint where it begins [m].

        They go from joint to joint and from the last joint to the frame, its tool included; there is one per joint.
        """
        return self._offsets([joint for joint in self.joints if joint.id in self.frame_support], self.frame_placement)

    def length(self, still: Collection[int] = ()) -> float:
        """The length of the moving part [m]: the sum of the distances from joint to joint up to the frame or its tool.

        Prismatic joints count at full extension. The distance from the base to the first moving joint does not count,
        so the length does not depend on where the chain is mounted.

        Args:
            still: Ids of joints that do not move.
        """
        own = [joint for joint in self.joints if joint.id in self.frame_support]
        other = [joint for joint in self.joints if joint.id not in self.frame_support]
        length = self._branch(own, self.frame_placement, still)
        if other:
            assert self.reference_placement is not None
            length += self._branch(other, self.reference_placement, still)
            if own:
                first, last = (self.model.jointPlacements[branch[0].id].translation for branch in (own, other))
                length += float(np.linalg.norm(first - last))
        return length

    def _branch(self, joints: list[Joint], end: pinocchio.SE3, still: Collection[int]) -> float:
        while joints and joints[0].id in still:
            joints = joints[1:]
        if not joints:
            return 0.0
        ways = sum(float(np.linalg.norm(offset)) for offset in self._offsets(joints, end))
        return ways + sum(_travel(joint) for joint in joints if joint.kind == "prismatic" and joint.id not in still)

    def _offsets(self, joints: Sequence[Joint], end: pinocchio.SE3) -> tuple[Array, ...]:
        if not joints:
            return ()
        return (*(self.model.jointPlacements[joint.id].translation for joint in joints[1:]), end.translation)


def chain_of(
    model: pinocchio.Model,
    joints: Iterable[Joint],
    frame: int,
    reference: int | None = None,
    tool: pinocchio.SE3 | None = None,
) -> Chain:
    """The chain that moves a frame.

    Args:
        model: The model.
        joints: Its joints.
        frame: The frame's index.
        reference: The index of the reference frame; the world when None.
        tool: The placement of the tool in the frame; the frame itself when None.
    """
    at = model.frames[frame]
    base = None if reference is None else model.frames[reference]
    reference_joint = 0 if base is None else base.parentJoint
    frame_support = frozenset(model.supports[at.parentJoint])
    reference_support = frozenset(model.supports[reference_joint])
    one_sided = frame_support ^ reference_support
    return Chain(
        tuple(joint for joint in joints if joint.id in one_sided),
        at.parentJoint,
        reference_joint,
        at.placement if tool is None else at.placement * tool,
        None if base is None else base.placement,
        frame_support,
        reference_support,
        model,
    )


def _travel(joint: Joint) -> float:
    """The largest distance of a prismatic joint from zero [m]."""
    return max(map(abs, joint.range_to_draw_from(joint.lower, joint.upper)))
