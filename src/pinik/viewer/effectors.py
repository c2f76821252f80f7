"""Which frames of a robot are worth a ball, and where they are at home."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..kinematics import Kinematics
from ..limits import Limits
from ..loop import iterate
from ..robot import Robot
from ..state import Status
from ..targets import Target
from .curves import Curve, polyline

__all__ = ["curve_axes", "home_configuration", "lowest_point", "principal_frames"]

Array = NDArray[np.float64]

# Poses that robots rest in, by the names that SRDF files give them.
_HOME_POSES = ("relaxed", "home", "standing", "default", "half_sitting")
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


def curve_axes(robot: Robot, frame: str, q: Array, center: Array, curve: Curve) -> Array:
    """The rows u, v, w (3, 3) [m] that a curve about `center` is drawn along, as large as the chain follows well.

    To the side is the world's y, up its z, towards the viewer its x; a chain that moves in a plane gets the plane's
    own axes. The size starts at a quarter of the chain's length and shrinks while the chain cannot follow.
    """
    kinematics = Kinematics(robot, Target(frame, center))
    axes = np.roll(np.eye(3), -1, axis=0) * (0.25 * kinematics.size_of_chain)
    plane = _plane(kinematics, robot, q)
    if plane is not None:
        axes = plane * (0.25 * kinematics.size_of_chain)
    for _ in range(4):
        if _follows(robot, frame, q, polyline(curve, center, axes, count=8)):
            break
        axes = 0.6 * axes
    return axes


def _plane(kinematics: Kinematics, robot: Robot, q: Array) -> Array | None:
    """Rows u, v and a zero (3, 3) for a chain whose frame keeps to a plane, u as level as it gets; else None."""
    rng = np.random.default_rng(0)
    columns = [kinematics.linearize(robot.random(rng) if k else q).J[:3] for k in range(6)]
    left, sigma, _ = np.linalg.svd(np.hstack(columns))
    if len(sigma) == 3 and sigma[2] > 1e-6 * sigma[0]:
        return None
    normal = left[:, 2]
    across = np.cross(normal, (0.0, 0.0, 1.0))
    u = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-6 else np.array([0.0, 1.0, 0.0])
    return np.vstack([u, np.cross(u, normal), np.zeros(3)])


def _follows(robot: Robot, frame: str, q: Array, points: Array) -> bool:
    states = iterate(robot, Target(frame, points[0]), "dls", q, max_iterations=60, tolerance=(1e-3, 1e-3))
    state = next(states)
    for point in points:
        state = states.send(Target(frame, point))
        while state.status is None:
            state = next(states)
        if state.status is not Status.CONVERGED:
            return False
    return True
