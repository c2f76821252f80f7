"""Load the robot that a command is about, with its warnings on stderr."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path

from ..errors import RobotLoadError, UnknownNameError, UrdfWarning
from ..loading import load
from ..robot import Robot
from . import output
from .exits import CommandError, ExitStatus

__all__ = ["load_robot"]


def load_robot(source: str, *, root: str = "fixed", package_dirs: Sequence[Path] | None = None) -> Robot:
    """`pinik.load`, where each warning is one line on stderr.

    Raises:
        CommandError: The robot could not be loaded; the exit status says so.
        InputError: An unknown root.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UrdfWarning)  # they are in robot.warnings, too
            robot = load(source, root=root, package_dirs=package_dirs or ())
    except (RobotLoadError, UnknownNameError, OSError) as error:
        raise CommandError(str(error), ExitStatus.NO_ROBOT) from None
    for words in dict.fromkeys(robot.warnings):
        output.warn(f"{robot.name}: {words}")
    return robot
