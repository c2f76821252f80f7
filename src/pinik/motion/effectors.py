"""The principal end effectors of a robot, found by the names and chains of its links."""

from __future__ import annotations

import re

import numpy as np

from ..model.chains import chain_of
from ..model.home import home_configuration
from ..robot import Robot

__all__ = ["principal_frames"]

# Common names of end effectors, in order of rank. The end of an arm with an unknown name goes before a head.
_NAMES_OF_ENDS = (
    r"tcp|tool|^tip$|_ee$|^ee_|end_?effector|eef|paw",
    r"grip|hand|palm|wrist|foot|sole|nose|flange",
    r"arm|leg|finger|tip",
    r"^(?!.*head)",
)
_NO_ENDS = (
    r"imu|gyro|acceler|cam|d4\d\d|lidar|mid360|optic|depth|laser|sensor|fsr|rotor|motor_|collision|visual|shape"
    r"|shoulder|wheel|caster|hole|logo|_itb|_dh_"
)
_UNKNOWN = len(_NAMES_OF_ENDS) - 1  # the rank of a name that says nothing
_MOST = 6
_POINT = 1e-6  # [m]: a shorter chain turns its end in place
_APART = 0.12  # of the longest chain: ends closer to each other than this belong to one hand


def principal_frames(robot: Robot) -> list[str]:
    """The principal end effectors, best first, at most six: the ends of arms, legs, head and tail.

    A link that carries nothing but sensors is an end too. Of ends close to each other, such as the fingers of a hand,
    only the one with the best name and the longest chain is listed.
    """
    carriers = {joint.parent for joint in robot.description.joints}
    leaves = [link for link in robot.description.links if link not in carriers]
    ends = [link for link in leaves if _may_be_end(link)]
    ends = [*ends, *_last_links(robot, ends)] or leaves
    q = home_configuration(robot)
    places = {link: robot.placement(link, q).translation for link in ends}
    chains = {link: chain_of(robot.model, robot.joints, robot.frame_id(link)) for link in ends}
    lengths = {link: chains[link].length() for link in ends if chains[link].joints}
    moved = [link for link in lengths if lengths[link] > _POINT] or list(lengths)
    moved.sort(key=lambda link: (_rank(link), -len(chains[link].joints), -lengths[link]))
    apart = _APART * max(lengths.values(), default=0.0)
    chosen: list[str] = []
    for link in moved:
        if all(np.linalg.norm(places[link] - places[other]) >= apart for other in chosen):
            chosen.append(link)
    return chosen[:_MOST] or list(robot.frame_names[-1:])


def _may_be_end(link: str) -> bool:
    return not re.search(_NO_ENDS, link.lower())


def _last_links(robot: Robot, ends: list[str]) -> list[str]:
    """The end of each branch that has none yet: of the links on its last joint, the one with the best name."""
    model, bodies = robot.model, robot.bodies
    ended = {bodies[link] for link in ends}
    last = [j for j in range(1, model.njoints) if not model.children[j] and j not in ended]
    links = sorted(filter(_may_be_end, bodies), key=robot.frame_id)
    found = [[link for link in links if bodies[link] == j] for j in last]
    return [min(some, key=lambda link: min(_rank(link), _UNKNOWN)) for some in found if some]


def _rank(name: str) -> int:
    ranks = [rank for rank, pattern in enumerate(_NAMES_OF_ENDS) if re.search(pattern, name.lower())]
    return ranks[0] if ranks else len(_NAMES_OF_ENDS)
