"""The principal end effectors of a robot, found by the names and chains of its links."""

from __future__ import annotations

import re

import numpy as np

from ..model.chains import chain_of
from ..model.home import home_configuration
from ..robot import Robot

__all__ = ["principal_frames"]

# Common names of end effectors, in order of rank.
_NAMES_OF_ENDS = (
    r"tcp|tool|^tip$|_ee$|^ee_|end_?effector|eef|paw",
    r"grip|hand|palm|wrist|foot|sole|nose|flange",
    r"head|arm|leg|finger|tip",
)
_NO_ENDS = (
    r"imu|gyro|cam|optic|depth|laser|sensor|fsr|rotor|motor_|collision|visual|shape|shoulder|wheel|hole|_itb|_dh_"
)
_MOST = 6
_APART = 0.12  # of the longest chain: ends closer to each other than this belong to one hand


def principal_frames(robot: Robot) -> list[str]:
    """The principal end effectors, best first, at most six: the ends of arms, legs, head and tail.

    Of ends close to each other, such as the fingers of a hand, only the one with the best name and the longest chain
    is listed.
    """
    carriers = {joint.parent for joint in robot.description.joints}
    ends = [link for link in robot.description.links if link not in carriers]
    ends = [link for link in ends if not re.search(_NO_ENDS, link.lower())] or ends
    q = home_configuration(robot)
    places = {link: robot.placement(link, q).translation for link in ends}
    chains = {link: chain_of(robot.model, robot.joints, robot.frame_id(link)) for link in ends}
    moved = [link for link in ends if chains[link].joints]
    lengths = {link: chains[link].length() for link in moved}
    moved.sort(key=lambda link: (_rank(link), -len(chains[link].joints), -lengths[link]))
    apart = _APART * max(lengths.values(), default=0.0)
    chosen: list[str] = []
    for link in moved:
        if all(np.linalg.norm(places[link] - places[other]) >= apart for other in chosen):
            chosen.append(link)
    return chosen[:_MOST] or list(robot.frame_names[-1:])


def _rank(name: str) -> int:
    ranks = [rank for rank, pattern in enumerate(_NAMES_OF_ENDS) if re.search(pattern, name.lower())]
    return ranks[0] if ranks else len(_NAMES_OF_ENDS)
