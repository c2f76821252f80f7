"""Load the robot that a command is about, with its warnings on stderr."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from ...errors import RobotLoadError, UnknownNameError
from ...loading import load_in_silence
from ...robot import Robot
from ..terminal import output
from ..terminal.exits import CommandError, ExitStatus

__all__ = ["check_folders", "load_robot", "one_line_a_kind"]


def load_robot(source: str, *, root: str = "fixed", package_dirs: Sequence[Path] | None = None) -> Robot:
    """`pinik.load`, with one line on stderr for each kind of warning.

    Raises:
        CommandError: The robot could not be loaded; the exit status says so. Or there is no such folder.
        InputError: An unknown root.
    """
    check_folders(package_dirs)
    try:
        robot = load_in_silence(source, root=root, package_dirs=package_dirs or ())
    except (RobotLoadError, UnknownNameError, OSError) as error:
        raise CommandError(str(error), ExitStatus.NO_ROBOT) from None
    for words in one_line_a_kind(robot.warnings):
        output.warn(f"{robot.name}: {words}")
    return robot


def check_folders(package_dirs: Iterable[Path] | None) -> None:
    """See that the folders of --package-dir exist.

    Raises:
        CommandError: One does not.
    """
    for folder in package_dirs or ():
        if not folder.expanduser().is_dir():
            raise CommandError(f"--package-dir {folder}: there is no such folder")


def one_line_a_kind(warnings: Iterable[str]) -> list[str]:
    """Warnings "joint 'x': cause", those with like causes put together; the others as they are."""
    kinds: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for words in dict.fromkeys(warnings):
        owner = re.match(r"(link|joint) '([^']*)': ", words)
        cause = words[owner.end() :] if owner else words
        kind = (owner[1], re.sub(r"'[^']*'", "…", cause)) if owner else ("", words)
        kinds.setdefault(kind, []).append((owner[2] if owner else "", words))
    return [_together(kind, members) for kind, members in kinds.items()]


def _together(kind: tuple[str, str], members: list[tuple[str, str]]) -> str:
    if len(members) == 1:
        return members[0][1]
    owner, cause = kind
    names = ", ".join([*(name for name, _ in members[:6]), *(["…"] if len(members) > 6 else [])])
    if "comes after it" in cause:
        return f"{len(members)} mimic joints come before their leaders and are left free: {names}"
    return f"{len(members)} {owner}s: {cause}: {names}"
