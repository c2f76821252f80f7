"""A configuration that a user gives: an array, angles by joint name, or an answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from ..model.robot_model import RobotModel
from .origin import as_start, not_by_name
from .solution import Solution

__all__ = ["Given", "as_configuration"]

Given: TypeAlias = ArrayLike | Mapping[str, float] | Solution


def as_configuration(robot: RobotModel, given: Given | None, what: str = "q") -> NDArray[np.float64]:
    """The configuration (nq,) that is given.

    Args:
        robot: The robot.
        given: A configuration (nq,); angles by joint name [rad, or m for prismatic joints], with all other joints
            neutral; or a `Solution`.
        what: What error messages call it.

    Raises:
        UnknownNameError: There is no such joint.
        InputError: It is none of these, or not one of this robot.
    """
    words = "must be a configuration, angles by joint name, or a Solution"
    if given is None:
        raise InputError(f"{words}; got None", argument=what)
    if isinstance(given, str):
        raise not_by_name(robot, given, what, words)
    if isinstance(given, Mapping):
        return as_start(robot.configuration(given), what)
    return as_start(robot.check_configuration(given.q if isinstance(given, Solution) else given, what), what)
