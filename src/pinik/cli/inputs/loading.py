"""Load the robot that a command is about, and print its warnings to stderr."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from ...description.flaw import summarised
from ...description.xml import MAX_BYTES
from ...errors import RobotLoadError, UnknownNameError
from ...loading import load_in_silence
from ...robot import Robot
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus
from .files import STDIN, read_bytes

__all__ = ["check_folders", "load_robot", "xacro_arguments"]


def load_robot(
    source: str,
    *,
    root: str = "fixed",
    package_dirs: Sequence[Path] | None = None,
    xacro_args: Sequence[str] | None = None,
    allow_outside: bool = False,
) -> Robot:
    """`pinik.load`, with one line on stderr for each sort of warning; "-" is a URDF on stdin.

    Raises:
        CommandError: The robot cannot be loaded (`ExitStatus.NO_ROBOT`), a folder does not exist, or an argument of
            the xacro file is not "NAME:=VALUE".
        InputError: An unknown root.
    """
    check_folders(package_dirs)
    xacro_given = xacro_arguments(xacro_args)
    given = read_bytes(source, MAX_BYTES, "a robot description") if source == "-" else source
    try:
        robot = load_in_silence(
            given, root=root, package_dirs=package_dirs or (), xacro_args=xacro_given, allow_outside=allow_outside
        )
    except RobotLoadError as error:
        if source == "-":
            error = RobotLoadError(error.cause, source=STDIN, element=error.element)
        raise CommandError(str(error), ExitStatus.NO_ROBOT) from None
    except (UnknownNameError, OSError) as error:
        raise CommandError(str(error), ExitStatus.NO_ROBOT) from None
    if source == "-":
        robot.description = replace(robot.description, source=STDIN)
    for words in summarised(robot.warnings):
        output.warn(f"{robot.name}: {words}")
    return robot


def xacro_arguments(texts: Iterable[str] | None) -> dict[str, str]:
    """The arguments of --xacro-arg by name.

    Raises:
        CommandError: One is not "NAME:=VALUE", or a name comes twice.
    """
    arguments: dict[str, str] = {}
    for text in texts or ():
        name, separator, value = text.partition(":=")
        if not separator or not name.strip():
            raise CommandError(f"--xacro-arg must be NAME:=VALUE; got {text!r}")
        if name.strip() in arguments:
            raise CommandError(f"--xacro-arg {name.strip()} is given twice")
        arguments[name.strip()] = value.strip()
    return arguments


def check_folders(package_dirs: Iterable[Path] | None) -> None:
    """Check that the folders of --package-dir exist.

    Raises:
        CommandError: One does not.
    """
    for folder in package_dirs or ():
        if not folder.expanduser().is_dir():
            raise CommandError(f"--package-dir {folder}: no such folder")
