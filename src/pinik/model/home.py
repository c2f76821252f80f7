"""A robot's home configuration, its ground level and its size."""

from __future__ import annotations

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..errors import RobotLoadError
from .chains import chain_of
from .limits import Limits
from .poses import Poses
from .robot_model import RobotModel

__all__ = ["home_configuration", "lowest_point", "robot_size"]

Array = NDArray[np.float64]

# Names that SRDF files commonly give to a resting pose, in order of preference.
_HOME_POSES = ("relaxed", "home", "standing", "default", "half_sitting")
_BEND = 0.4  # [rad] hinge angle for a robot without named poses, so that it is not fully stretched


def home_configuration(robot: RobotModel) -> Array:
    """The default configuration (nq,), inside the limits: the resting pose, or slightly bent if there is no pose.

    An SRDF file with a fault counts as none.
    """
    try:
        poses = robot.srdf_poses
    except RobotLoadError:  # nobody asked for a pose
        poses = Poses()
    limits = Limits.of(robot)
    for name in (*_HOME_POSES, *poses):
        if name in poses:
            return limits.wrap(poses[name])
    q = robot.neutral()
    if len(robot.joint_names) <= 8:
        for name in robot.joint_names:
            joint = robot.joint(name)
            if joint.kind != "prismatic":
                joint.set_angle(q, _BEND)
    return limits.wrap(q)


def lowest_point(robot: RobotModel, q: Array) -> float:
    """The height [m] of the lowest frame at `q` (nq,), which approximates the ground level."""
    data = robot.model.createData()
    pinocchio.framesForwardKinematics(robot.model, data, q)
    return float(min(placement.translation[2] for placement in data.oMf))


def robot_size(robot: RobotModel) -> float:
    """The length of a robot's longest chain [m]; the extent of its links if no joint moves; 1 if that is 0 too."""
    model = robot.model
    links = [robot.frame_id(name) for name in robot.description.links]
    longest = max(chain_of(model, robot.joints, link).length() for link in links)
    if longest == 0.0:
        places = np.array([model.frames[link].placement.translation for link in links])
        longest = float(np.ptp(places, axis=0).max())
    return longest or 1.0
