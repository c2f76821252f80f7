"""The poses of instances whose joints lead, in the form that links need."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ...echoes import QUOTED, shortened
from ...errors import InputError
from ...robot import Robot
from ..simulation.session import Session

__all__ = ["Pose", "angle_messages", "led_angles", "placements"]

_ALL = "all"
_DECIMALS = 9  # so that balls that follow are where they were to the digits of their own text


Pose = dict[str, float | list[float]]


def led_angles(session: Session) -> dict[str, Pose]:
    """The angles of the instances whose joints lead: "all", or an instance's number → joint → angle [rad or m].

    Floating and planar joints, such as a free root, have placements instead. Followers are left out.
    """
    led = session.leading.among(session.balls.targets)
    if led >= set(range(session.view)):
        return {_ALL: _angles(session, 0)}
    return {str(index): _angles(session, index) for index in sorted(led) if index < session.view}


def _angles(session: Session, index: int) -> Pose:
    robot, q = session.robot, session.instances[index].q
    angles = robot.angles(q)
    return {name: round(angles[name], _DECIMALS) for name in robot.joint_names} | placements(robot, q)


def placements(robot: Robot, q: NDArray[np.float64]) -> dict[str, list[float]]:
    """Floating and planar joints, such as a free root → their placements [x, y, z, qx, qy, qz, qw] at q (nq,)."""
    found = robot.joint_placements(q)
    return {name: pinocchio.SE3ToXYZQUAT(placement).tolist() for name, placement in found.items()}


def angle_messages(session: Session, wanted: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the messages that set these angles, except those of instances that have them already and lead.

    Raises:
        InputError: A key is neither "all" nor the number of an instance.
    """
    present = led_angles(session)
    for key, angles in wanted.items():
        if key != _ALL and not (key.isdecimal() and len(key) == 1):
            raise InputError(f"set-up: angles must be of all or of an instance; got {shortened(key, QUOTED)!r}")
        if present.get(key) != angles:
            yield {"type": "angles", "instance": None if key == _ALL else int(key), "angles": angles}
