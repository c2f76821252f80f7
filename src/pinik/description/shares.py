"""Where packages are installed: example-robot-data, and the folders that ROS names in its environment variables."""

from __future__ import annotations

import functools
import glob
import os
import sys
from collections.abc import Iterator
from pathlib import Path

__all__ = ["entries", "example_robot_data", "installed_places", "installed_roots"]

# ROS 1 searches packages anywhere below the entries of ROS_PACKAGE_PATH; workspaces nest them this deep.
NESTED_PACKAGES = ("", "*/", "*/*/")


@functools.cache
def example_robot_data() -> Path | None:
    """The robots folder of example-robot-data, or None if that package is not installed."""
    prefixes = [Path(entry) / "cmeel.prefix" for entry in sys.path] + [Path(sys.prefix)]
    for prefix in prefixes:
        robots = prefix / "share" / "example-robot-data" / "robots"
        if robots.is_dir():
            return robots
    return None


def installed_places(name: str) -> Iterator[Path]:
    """The folders in which an installed package of this name may be."""
    robots = example_robot_data()
    if robots is not None:
        yield robots.parent.parent / name
        yield robots / name
    for entry in entries("ROS_PACKAGE_PATH"):
        if entry.name == name:
            yield entry
        for nesting in NESTED_PACKAGES:
            yield from entry.glob(nesting + glob.escape(name))
    for entry in entries("AMENT_PREFIX_PATH"):
        yield entry / "share" / name


def installed_roots() -> list[Path]:
    """The folders below which everything belongs to installed packages."""
    robots = example_robot_data()
    shares = [entry / "share" for entry in entries("AMENT_PREFIX_PATH")]
    return [*([] if robots is None else [robots.parent]), *entries("ROS_PACKAGE_PATH"), *shares]


def entries(variable: str) -> list[Path]:
    """The folders that an environment variable lists."""
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]
