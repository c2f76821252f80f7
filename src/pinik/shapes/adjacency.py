"""Links that cannot collide because of how they are joined: fixed to each other, or neighbours at a joint."""

from __future__ import annotations

from collections.abc import Collection

from ..model.robot_model import RobotModel
from .disabled_pairs import LinkPair, link_pair

__all__ = ["adjacent_pairs", "rigid_pairs"]


def rigid_pairs(robot: RobotModel, links: Collection[str]) -> set[LinkPair]:
    """The pairs of these links that are fixed to each other, and so never move apart or together."""
    bodies = robot.bodies
    names = list(links)
    return {link_pair(a, b) for k, a in enumerate(names) for b in names[k + 1 :] if bodies[a] == bodies[b] and a != b}


def adjacent_pairs(robot: RobotModel, links: Collection[str]) -> set[LinkPair]:
    """The pairs of these links that are joined by a joint.

    Links that are fixed to each other are one body. Bodies without mass and without any of these links, such as those
    between the three hinges of a ball joint, count as part of the joint.

    Args:
        robot: The robot.
        links: The links that have collision shapes.
    """
    bodies = robot.bodies
    solid = {bodies[name] for name in links}
    heavy = {
        bodies[link.name]
        for link in robot.description.link_tags
        if link.inertial is not None and link.inertial.mass > 0.0
    }
    parents = list(robot.model.parents)
    pairs = set()
    for body in solid - {0}:
        above = parents[body]
        while above != 0 and above not in solid and above not in heavy:
            above = parents[above]
        pairs |= {link_pair(a, b) for a in links if bodies[a] == body for b in links if bodies[b] == above}
    return pairs
