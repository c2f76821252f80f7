"""The robots of a view: the one on show, those that may follow it, and the session that goes on with another one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...description.catalog import catalog
from ...errors import InputError, PinikError
from ...robot import Robot
from ..protocol.robot_words import live_command
from ..protocol.robots import RobotMenu
from ..protocol.setup import Setup, apply_setup
from ..simulation.another_robot import with_robot
from ..simulation.session import Session
from .later import Later
from .robot_loader import RobotLoader
from .watched import Watched

__all__ = ["RobotsOnShow"]

Take = Callable[[Session | None, list[str]], None]
"""Takes the session that goes on with another robot, or None if there is none, and what everybody should be told."""


class RobotsOnShow:
    """Loads robots that pages ask for, and the watched one when its file changes."""

    def __init__(self, now: Callable[[], Session], later: Later, reload: Callable[[], Robot] | None) -> None:
        """Begin with the robot of the present session.

        Args:
            now: Returns the session on show.
            later: Does work in another thread.
            reload: Loads the first robot again when its file has changed; None if it is not watched.
        """
        first = now().robot
        self._now = now
        self._menu = RobotMenu(first)
        self._loader = RobotLoader(self._menu, later)
        self._watched = None if reload is None else Watched(first, reload, later, self._menu)

    @property
    def own_names(self) -> list[str]:
        """Names of robots on the menu that are not in the catalogue."""
        return self._menu.own_names

    @property
    def names(self) -> list[str]:
        """Names of all robots on the menu."""
        return [*self.own_names, *catalog()]

    @property
    def loads(self) -> bool:
        """Whether a robot is being loaded."""
        return self._loader.loading is not None

    def load(self, name: str, root: str, setup: Setup, then: Take) -> None:
        """Load a robot, and call `then` with the session that goes on with it, as its set-up says.

        Raises:
            UnknownNameError: There is no such robot or root.
        """

        def take(robot: Robot | InputError) -> None:
            try:
                if isinstance(robot, InputError):
                    raise robot
                session = with_robot(self._now(), robot)
            except PinikError as error:
                then(None, [str(error)])
                return
            then(session, _set_up(session, setup))

        self._loader.load(name, root, take)

    def stay(self) -> None:
        """Keep the robot on show, whatever is being loaded."""
        self._loader.cancel()

    def look_at_files(self, then: Take, fault: Callable[[], None]) -> None:
        """Look at the watched files; if they have changed, call `then` as `load` does, or `fault` if one is faulty."""

        def take(robot: Robot | None) -> None:
            if robot is None or self._watched is None:
                fault()
                return
            try:
                session = self._watched.renew(self._now(), robot)
            except PinikError as error:
                then(None, [str(error)])
                return
            then(session, [] if session is None else session.notes)

        if self._watched is not None:
            self._watched.look(take)

    def state(self) -> dict[str, Any]:
        """What the `state` message says of them."""
        session, watched = self._now(), self._watched
        return {
            "loading": self._loader.loading,
            "watched": None if watched is None else watched.state(session),
            "command": live_command(session.robot, watched is not None and watched.is_shown(session)),
        }


def _set_up(session: Session, setup: Setup) -> list[str]:
    """Apply a set-up to a session that has just begun; return what everybody should be told."""
    try:
        if setup:
            apply_setup(session, setup)
    except PinikError as error:
        return [str(error)]
    return [] if "methods" in setup else session.notes
