"""Which frames of a robot are worth a ball."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from ..model.home import home_configuration
from ..model.robot_model import Robot

__all__ = ["principal_frames"]

# What people call a robot's ends; the first that fits counts most.
_NAMES_OF_ENDS = (
    r"tcp|tool|^tip$|_ee$|^ee_|end_?effector|eef|paw",
    r"grip|hand|palm|wrist|foot|sole|nose|flange",
    r"head|arm|leg|finger|tip",
)
_NO_ENDS = (
    r"imu|gyro|cam|optic|depth|laser|sensor|fsr|rotor|motor_|collision|visual|shape|shoulder|wheel|hole|_itb|_dh_"
)
_MOST = 6
_APART = 0.12  # of the robot's size: ends nearer to each other than this are fingers of one hand


def principal_frames(robot: Robot) -> list[str]:
    """The frames that most deserve a ball, best first, at most six: the ends of arms, legs, head and tail.

    Of ends close to each other, such as the fingers of a hand, only the best named and longest chain counts.
    """
    carriers = {joint.parent for joint in robot.description.joints}
    ends = [link for link in robot.description.links if link not in carriers]
    ends = [link for link in ends if not re.search(_NO_ENDS, link.lower())] or ends
    q = home_configuration(robot)
    places = {link: robot.placement(link, q).translation for link in ends}
    chains = {link: _chain(robot, link) for link in ends}
    moved = [link for link in ends if chains[link].joints]
    moved.sort(key=lambda link: (_rank(link), -chains[link].joints, -chains[link].length))
    apart = _APART * max((chains[link].length for link in moved), default=0.0)
    chosen: list[str] = []
    for link in moved:
        if all(np.linalg.norm(places[link] - places[other]) >= apart for other in chosen):
            chosen.append(link)
    return chosen[:_MOST] or list(robot.frame_names[-1:])


class _Chain(NamedTuple):
    """What moves a frame.

    Attributes:
        joints: How many.
        length: Sum of the distances between their origins, the frame's included [m].
    """

    joints: int
    length: float


def _chain(robot: Robot, frame: str) -> _Chain:
    model = robot.model
    at = model.frames[robot.frame_id(frame)]
    joints = [joint_id for joint_id in model.supports[at.parentJoint] if joint_id > 0]
    offsets = [at.placement.translation, *(model.jointPlacements[joint_id].translation for joint_id in joints[1:])]
    return _Chain(len(joints), sum(float(np.linalg.norm(offset)) for offset in offsets))


def _rank(name: str) -> int:
    ranks = [rank for rank, pattern in enumerate(_NAMES_OF_ENDS) if re.search(pattern, name.lower())]
    return ranks[0] if ranks else len(_NAMES_OF_ENDS)
