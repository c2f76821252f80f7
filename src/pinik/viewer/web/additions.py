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

__all__ = ["Additions"]


class Additions:
    """The messages that looks need, for one robot.

    Attributes:
        messages: Those that are made already; a new tab needs all of them.
    """

    def __init__(self, generation: int, later: Later, send: Callable[[Message], None]) -> None:
        """Begin without any.

        Args:
            generation: The robot's number in messages.
            later: Makes them in another thread.
            send: Sends one to every tab.
        """
        self._generation = generation
        self._later, self._send = later, send
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

    def _make(self, key: str, work: Callable[[], list[Message]]) -> None:
        if key not in self._asked:
            self._asked.add(key)
            self._later(work, self._take)

    def _take(self, made: Any) -> None:
        if isinstance(made, BaseException):
            made = [json.dumps({"type": "error", "message": f"this look cannot be shown: {made}"})]
        else:
            self.messages += made
        for message in made:
            self._send(message)


def _reach(robot: Robot, generation: int, frame: str) -> list[Message]:
    return [json.dumps(reach_message(robot, generation, frame))]


def _collisions(robot: Robot, generation: int) -> list[Message]:
    shapes = collision_shapes(robot)
    return [*shapes.commands, json.dumps({**shapes.message(generation), "type": "collisions"})]
