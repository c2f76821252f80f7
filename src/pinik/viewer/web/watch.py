"""Watch the files of a robot, and load it again when they change; the last good robot stays until then."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path

from ...echoes import shortened
from ...robot import Robot
from ...shapes.referred import referred_by
from .later import Later

__all__ = ["SECONDS", "Watch", "files_of"]

SECONDS = 0.5
"""How often the files are looked at while somebody watches [s]."""
_MOST = 300  # files; each costs some microseconds a look
_LONGEST = 400  # characters of a fault
_INCLUDED = (".xacro", ".urdf", ".srdf", ".yaml", ".yml")


def files_of(robot: Robot) -> list[Path]:
    """The files that a robot depends on, at most 300: its description, its SRDF, its meshes, the files that these may
    refer to, and if it is xacro, files of the kinds that it may include, from its folder and the folders in that.
    """
    path = robot.description.path
    if path is None:
        return []
    files = [path, path.with_suffix(".srdf"), *([robot.srdf] if robot.srdf else [])]
    if path.suffix == ".xacro":
        files += sorted(found for found in _near(path.parent) if found.suffix in _INCLUDED)
    around = robot.surroundings
    meshes = [found.path for address in robot.description.meshes if (found := around.find(address)).path]
    files += meshes
    with contextlib.suppress(OSError):
        files += referred_by(meshes)
    return list(dict.fromkeys(files))[:_MOST]


def _near(folder: Path) -> Iterator[Path]:
    for place, folders, names in os.walk(folder):
        yield from (Path(place) / name for name in names[:_MOST])
        folders[:] = [] if Path(place) != folder else sorted(folders)[:_MOST]


class Watch:
    """Looks at the files of the robot that a view was opened with, and loads it again in another thread.

    Attributes:
        fault: Why the file cannot be loaded as it is now, in words; None while it is good.
    """

    def __init__(self, robot: Robot, load: Callable[[], Robot], later: Later) -> None:
        """Watch from now on.

        Args:
            robot: The robot as it has been loaded.
            load: Loads it again.
            later: Does work in another thread.
        """
        self._load, self._later = load, later
        self._files = files_of(robot)
        self._seen = self._stamps()
        self._busy = False
        self.fault: str | None = None

    @property
    def file(self) -> str:
        """The name of the watched file."""
        return self._files[0].name if self._files else ""

    def _stamps(self) -> list[tuple[int, int, int] | None]:
        return [_stamp(file) for file in self._files]

    def look(self, then: Callable[[Robot | None], None]) -> None:
        """Look at the files; if they have changed, load the robot, and call `then` with it, or with None and a `fault`.

        A file that changes while it is being loaded is loaded once more.
        """
        stamps = self._stamps()
        if self._busy or stamps == self._seen:
            return
        self._seen, self._busy = stamps, True

        def take(result: Robot | BaseException) -> None:
            self._busy = False
            if isinstance(result, BaseException):
                self.fault = shortened(str(result), _LONGEST)
                then(None)
                return
            self.fault = None
            files = files_of(result)
            if files != self._files:
                known = dict(zip(self._files, self._seen, strict=True))
                self._files = files
                self._seen = [known.get(file, _stamp(file)) for file in files]
            then(result)

        self._later(self._load, take)


def _stamp(file: Path) -> tuple[int, int, int] | None:
    """What changes when a file does: its time, its size and its place on the disk; None if it is not there."""
    try:
        found = os.stat(file)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
