"""Which robots a page may choose: the catalogue's, and the one that the view was opened with."""

from __future__ import annotations

from ...description.catalog import catalog
from ...errors import UnknownNameError
from ...loading import load_in_silence
from ...robot import Robot

__all__ = ["ROOTS", "RobotMenu"]

ROOTS = ("fixed", "free_flyer", "planar")


class RobotMenu:
    """Robots by name; a page can name nothing else, no file and no folder.

    Attributes:
        own_names: Of robots that the catalogue does not have.
    """

    def __init__(self, first: Robot) -> None:
        self._first = first
        self.own_names = [] if first.name in catalog() else [first.name]

    def check(self, name: str, root: str) -> None:
        """See that there is such a robot and such a root.

        Raises:
            UnknownNameError: There is not.
        """
        names = [*self.own_names, *catalog()]
        if name not in names:
            raise UnknownNameError("robot", name, names)
        if root not in ROOTS:
            raise UnknownNameError("root", root, ROOTS)

    def load(self, name: str, root: str) -> Robot:
        """The robot of that name; the first one's name means that one, whatever file it came from.

        Raises:
            RobotLoadError: Its description is faulty.
        """
        if name == self._first.name:
            return self._first.with_root(root)
        return load_in_silence(name, root=root)
