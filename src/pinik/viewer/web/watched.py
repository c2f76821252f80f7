"""The watched robot of a view: its file, its place on the menu, and the session that goes on with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...robot import Robot
from ..protocol.robots import RobotMenu
from ..simulation.session import Session
from .later import Later
from .reload import reloaded
from .watch import Watch

__all__ = ["Watched"]


class Watched:
    """The robot that a view was opened with, while its file is watched."""

    def __init__(self, robot: Robot, reload: Callable[[], Robot], later: Later, menu: RobotMenu) -> None:
        """Watch from now on.

        Args:
            robot: The robot as it has been loaded.
            reload: Loads it again.
            later: Does work in another thread.
            menu: The robots that pages may choose.
        """
        self._watch = Watch(robot, reload, later)
        self._name, self._menu = robot.name, menu

    def is_shown(self, session: Session) -> bool:
        """Whether this robot is the session's, and not another one meanwhile."""
        return session.robot.name == self._name

    def state(self, session: Session) -> dict[str, Any]:
        """What the `state` message says of it."""
        return {"file": self._watch.file, "fault": self._watch.fault, "shown": self.is_shown(session)}

    def look(self, then: Callable[[Robot | None], None]) -> None:
        """Look at the files, and if they have changed, call `then` with the robot, or with None if there is a fault."""
        self._watch.look(then)

    def renew(self, session: Session, robot: Robot) -> Session | None:
        """Put the robot as it is now on the menu; return the session that goes on with it, or None if another is shown.

        Raises:
            PinikError: The session cannot go on with the robot.
        """
        is_shown = self.is_shown(session)
        self._menu.renew(robot)
        self._name = robot.name
        return reloaded(session, robot.with_root(session.robot.root)) if is_shown else None
