"""What the picture needs only while a look is on, made when it is first asked for: collision shapes and reach."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from typing import Any

from ...robot import Robot
from ..protocol.reach import reach_message
from ..simulation.session import Session
from .later import Later
from .outbox import Message
from .scene import collision_shapes
from .seats import Seats

__all__ = ["Additions"]


class Additions:
    """The messages that looks need, for one robot.

    Attributes:
        messages: Those that are made already; a new tab needs all of them.
    """

    def __init__(self, generation: int, seats: Seats, later: Later) -> None:
        """Begin without any.

        Args:
            generation: The robot's number in messages.
            seats: The tabs that are sent them.
            later: Makes them in another thread.
        """
        self._generation = generation
        self._seats, self._later = seats, later
        self._is_over = False
        self._asked: set[str] = set()
        self.messages: list[Message] = []

    def ask(self, session: Session) -> None:
        """Have everything made that the session's looks need and that has not been asked for yet."""
        robot, generation = session.robot, self._generation
        if "collisions" in session.looks:
            self._make("collisions", partial(_collisions, robot, generation))
        if "reach" in session.looks:
            for frame in session.balls.frames:
                self._make(f"reach {frame}", partial(_reach, robot, generation, frame))

    def end(self) -> None:
        """Make and send nothing more, because another robot follows."""
        self._is_over = True
        self._seats.withdraw([message for message in self.messages if isinstance(message, bytes)])

    def _make(self, key: str, work: Callable[[], list[Message]]) -> None:
        if key not in self._asked:
            self._asked.add(key)
            self._later(lambda: [] if self._is_over else work(), self._take)

    def _take(self, made: Any) -> None:
        if self._is_over:
            return
        if isinstance(made, BaseException):
            made = [json.dumps({"type": "error", "message": f"this look cannot be shown: {made}"})]
        else:
            self.messages += made
        for message in made:
            self._seats.send(message)


def _reach(robot: Robot, generation: int, frame: str) -> list[Message]:
    return [json.dumps(reach_message(robot, generation, frame))]


def _collisions(robot: Robot, generation: int) -> list[Message]:
    shapes = collision_shapes(robot)
    return [*shapes.commands, json.dumps({**shapes.message(generation), "type": "collisions"})]
