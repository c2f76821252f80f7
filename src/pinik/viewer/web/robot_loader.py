"""Loads the robot that a page asked for, without holding up the session."""

from __future__ import annotations

from collections.abc import Callable

from ...errors import InputError
from ...robot import Robot
from ..protocol.robots import RobotMenu
from .later import Later

__all__ = ["RobotLoader"]


class RobotLoader:
    """Loads one robot at a time; the newest request wins.

    Attributes:
        loading: The name of the robot being loaded, or None.
    """

    def __init__(self, menu: RobotMenu, later: Later) -> None:
        self._menu = menu
        self._later = later
        self._request = 0  # number of the newest request
        self.loading: str | None = None

    def load(self, name: str, root: str, then: Callable[[Robot | InputError], None]) -> None:
        """Load a robot, then call `then` with it or with the reason why it cannot be loaded.

        `then` is not called if another robot is requested before this one is ready.

        Raises:
            UnknownNameError: There is no such robot or root.
        """
        self._menu.check(name, root)
        self.loading = name
        self._request += 1
        request = self._request

        def work() -> Robot | None:
            return self._menu.load(name, root) if request == self._request else None

        def take(result: Robot | BaseException | None) -> None:
            if request != self._request or result is None:
                return
            self.loading = None
            if isinstance(result, BaseException):
                result = InputError(f"{name} cannot be loaded: {result}")
            then(result)

        self._later(work, take)

    def cancel(self) -> None:
        """Drop the robot that is being loaded, because something newer was asked for."""
        self.loading = None
        self._request += 1
