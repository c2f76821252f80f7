"""The configuration in which a robot is shown in its map: with the frame where the map is cut open."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..model.home import home_configuration
from ..robot import Robot
from .voxel_map import VoxelMap

__all__ = ["shown_configuration"]

Array = NDArray[np.float64]

_BESIDE = 0.15  # of the map's width: nearer to its middle, a frame is in front of no side
_ASIDE = np.deg2rad(60.0)
_OUT, _UP = 0.28, 0.1  # of the map's width, from its middle


def shown_configuration(reach: VoxelMap, robot: Robot, direction: Array) -> Array:
    """The rest configuration (nq,), or another one if the frame would be hidden from a camera.

    Args:
        reach: The map, which is cut open towards the camera.
        robot: The robot.
        direction: From the robot to the camera (3,).
    """
    home = home_configuration(robot)
    if reach.relative_to is not None:
        return home
    low, high = reach.bounds()
    middle, width = 0.5 * (low + high), float(np.ptp([low, high], axis=0)[:2].max())
    place = robot.placement(reach.frame, home).translation
    away = (place - middle)[:2]
    facing = np.array(direction[:2])
    if not np.linalg.norm(facing) > 1e-9 or np.linalg.norm(away) < _BESIDE * width:
        return home
    facing /= np.linalg.norm(facing)
    if away @ facing >= np.cos(_ASIDE) * np.linalg.norm(away):
        return home
    wanted = middle + width * np.array([*(_OUT * facing), _UP])
    answer = robot.solve(reach.frame, position=wanted, q0=home)
    return answer.q if answer.success else home
