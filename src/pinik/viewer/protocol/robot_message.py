"""The `robot` message: a robot's joints, links and frames, as the page needs them to draw it."""

from __future__ import annotations

from typing import Any

import pinocchio

from ...model.home import robot_size
from ...model.joint import Joint
from ...robot import Robot
from ..simulation.by_hand import angle_range

__all__ = ["robot_message"]


def robot_message(robot: Robot, generation: int) -> dict[str, Any]:
    """Describe a robot's joints, links and frames by name and placement.

    `size` [m] is `robot_size`. `frames` are the links that a joint moves, links at the end of a chain first, or all
    links if no joint moves.
    """
    model = robot.model
    by_id = {joint.id: joint for joint in robot.joints}
    links = [model.frames[robot.frame_id(name)] for name in robot.description.links]
    moved = [link.name for link in links if link.parentJoint]
    carriers = {joint.parent for joint in robot.description.joints}
    return {
        "type": "robot",
        "generation": generation,
        "name": robot.name,
        "root": robot.root,
        "joints": [
            {
                "name": name,
                "parent": model.parents[joint_id],
                "kind": by_id[joint_id].kind if joint_id else "fixed",
                "placement": _seven(model.jointPlacements[joint_id]),
                "leader": by_id[joint_id].leader if joint_id else None,
                "range": list(reach) if (reach := joint_id and angle_range(robot, by_id[joint_id])) else None,
                **_axis(robot, by_id.get(joint_id)),
            }
            for joint_id, name in enumerate(model.names)
        ],
        "links": [
            {"name": link.name, "joint": link.parentJoint, "placement": _seven(link.placement)} for link in links
        ],
        "frames": sorted(moved, key=carriers.__contains__) or list(robot.description.links),
        "size": robot_size(robot),
        "warnings": list(robot.warnings),
    }


def _axis(robot: Robot, joint: Joint | None) -> dict[str, Any]:
    """The unit axis in the joint's frame, and the joint that it follows with how many times that one's angle."""
    if joint is None or not joint.has_one_axis:
        return {"axis": None, "follows": None, "multiplier": 1.0}
    leader = None if joint.leader is None else robot.model.getJointId(joint.leader)
    return {"axis": list(joint.axis), "follows": leader, "multiplier": joint.multiplier}


def _seven(placement: pinocchio.SE3) -> list[float]:
    """Return x, y, z [m], qx, qy, qz, qw."""
    return list(map(float, pinocchio.SE3ToXYZQUATtuple(placement)))
