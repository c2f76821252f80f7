"""Where a robot stands when nothing was said, its ground and its size."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from .limits import Limits
from .robot_model import Robot

__all__ = ["home_configuration", "lowest_point", "robot_size"]

Array = NDArray[np.float64]

# Poses that robots rest in, by the names that SRDF files give them.
_HOME_POSES = ("relaxed", "home", "standing", "default", "half_sitting")
_BEND = 0.4  # [rad] what hinges of a robot without poses are bent by, so that it does not stand stretched out


def home_configuration(robot: Robot) -> Array:
    """Where a robot stands when nothing was said (nq,): in its resting pose, else slightly bent, inside the limits."""
    poses = robot.poses
    limits = Limits.of(robot)
    for name in (*_HOME_POSES, *poses):
        if name in poses:
            return limits.clip(limits.wrap(poses[name]))
    q = robot.neutral()
    if len(robot.joint_names) <= 8:
        for name in robot.joint_names:
            joint = robot.joint(name)
            if joint.kind != "prismatic":
                joint.set_angle(q, _BEND)
    return limits.clip(limits.wrap(q))


def lowest_point(robot: Robot, q: Array) -> float:
    """The height [m] of the lowest frame at `q` (nq,): about where a robot's ground is."""
    data = robot.model.createData()
    pinocchio.framesForwardKinematics(robot.model, data, q)
    return float(min(placement.translation[2] for placement in data.oMf))


def robot_size(robot: Robot) -> float:
    """The longest way [m] from the root's origin to a link's along the joints between them; 1 where that is nothing.

    Sliding joints are drawn out.
    """
    model = robot.model
    by_id = {joint.id: joint for joint in robot.joints}
    away = [0.0]  # [m] from the root's origin to each joint's
    for joint_id in range(1, model.njoints):
        joint = by_id[joint_id]
        ends = joint.range_to_draw_from(joint.lower, joint.upper) if joint.kind == "prismatic" else (0.0,)
        step = float(np.linalg.norm(model.jointPlacements[joint_id].translation)) + max(map(abs, ends))
        away.append(away[model.parents[joint_id]] + step)
    links = [model.frames[robot.frame_id(name)] for name in robot.description.links]
    size = max(away[link.parentJoint] + float(np.linalg.norm(link.placement.translation)) for link in links)
    return size or 1.0
