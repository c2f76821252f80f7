"""Compiled walks along a robot's joints, for placements and Jacobians of one frame at many configurations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pinocchio

from ...engine import load
from ...model.compiled import native_robot
from ...model.configurations import LARGEST_UNIT_ERROR, UNIT_ROUNDING
from ...model.robot_model import RobotModel

__all__ = ["make_walk"]

if TYPE_CHECKING:
    from ..._native import FrameWalk

_WORLD = (0, pinocchio.SE3.Identity())


def make_walk(robot: RobotModel, frame: int, reference: int | None) -> FrameWalk:
    """Compile the walk to a frame.

    Args:
        robot: The robot.
        frame: The frame's index.
        reference: The index of the frame that takes the place of the world; None for the world.
    """
    joint, placement = _fixed_to(robot, frame)
    reference_joint, reference_placement = _WORLD if reference is None else _fixed_to(robot, reference)
    walk: FrameWalk = load().FrameWalk(
        robot=native_robot(robot),
        frame_joint=joint,
        frame_rotation=placement.rotation,
        frame_translation=placement.translation,
        reference_joint=reference_joint,
        reference_rotation=reference_placement.rotation,
        reference_translation=reference_placement.translation,
        unit_rounding=UNIT_ROUNDING,
        largest_unit_error=LARGEST_UNIT_ERROR,
    )
    return walk


def _fixed_to(robot: RobotModel, frame: int) -> tuple[int, pinocchio.SE3]:
    """The joint to which a frame is fixed, and its placement there."""
    own = robot.model.frames[frame]
    return own.parentJoint, own.placement
