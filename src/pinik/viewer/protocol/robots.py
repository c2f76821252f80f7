"""The robots that a page may choose: those of the catalogue, and the one that the view was opened with."""

from __future__ import annotations

from ...description.catalog import catalog
from ...errors import UnknownNameError
from ...loading import load_in_silence
from ...robot import Robot

__all__ = ["ROOTS", "RobotMenu"]

ROOTS = ("fixed", "free_flyer", "planar")


class RobotMenu:
    """Robots by name. A page can name nothing else, no file and no folder.

    Attributes:
        own_names: Names of robots that are not in the catalogue.
    """

    def __init__(self, first: Robot) -> None:
        self._first = first
        self.own_names = [] if first.name in catalog() else [first.name]

    def renew(self, first: Robot) -> None:
        """Put another robot in place of the first one, whose file has changed."""
        self.__init__(first)  # type: ignore[misc]

    def check(self, name: str, root: str) -> None:
        """Check that a robot and a root exist.

        Raises:
            UnknownNameError: One of them does not.
        """
        names = [*self.own_names, *catalog()]
        if name not in names:
            raise UnknownNameError("robot", name, names)
        if root not in ROOTS:
            raise UnknownNameError("root", root, ROOTS)

    def load(self, name: str, root: str) -> Robot:
        """Load a robot by name; the name of the first robot means that robot, whichever file it came from.

        Raises:
            RobotLoadError: Its description is faulty.
        """
        if name == self._first.name:
            return self._first.with_root(root)
        return load_in_silence(name, root=root)
