"""How a robot is named in Python and on the command line, so that the same robot is loaded again."""

from __future__ import annotations

import shlex

from ...description.catalog import catalog, find
from ...robot import Robot

__all__ = ["is_named", "live_command", "robot_words", "source_of"]


def is_named(robot: Robot) -> bool:
    """Whether it is the robot that the catalogue has under its name."""
    return robot.name in catalog() and find(robot.name).urdf == robot.description.path


def source_of(robot: Robot) -> str:
    """What `pinik.load` and the command take: a name in the catalogue, or the path as it was given."""
    return robot.name if is_named(robot) else robot.description.source


def robot_words(robot: Robot) -> list[str]:
    """The words of a command that name a robot: its source, and the options with which it was loaded."""
    words = [source_of(robot)] + ([] if robot.root == "fixed" else ["--root", robot.root])
    for folder in () if is_named(robot) else robot.package_dirs:
        words += ["--package-dir", str(folder)]
    return words + (["--allow-outside"] if robot.allow_outside else [])


def live_command(robot: Robot, watched: bool) -> str | None:
    """The command that shows a robot in the live view; None if it was not read from a file.

    Args:
        robot: The robot.
        watched: Whether its file is watched.
    """
    if robot.description.path is None:
        return None
    return shlex.join(["pinik", "live", *robot_words(robot)] + ["--watch"] * watched)
