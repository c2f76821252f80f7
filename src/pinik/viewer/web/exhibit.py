"""The robot on show: its messages, its shapes once they are read, and the frames of its session."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

from ...shapes.collisions import RobotShapes
from ..protocol.frames import FrameMaker
from ..protocol.robot_message import robot_message
from ..simulation.contacts import Contacts
from ..simulation.session import Session
from .additions import Additions
from .later import Later
from .scene import Shapes
from .seats import Seats
from .shape_cache import shapes_of

__all__ = ["Exhibit"]


class Exhibit:
    """What tabs are sent of one robot. Another robot, or the same one from its changed file, is another exhibit.

    Attributes:
        generation: How many robots have been shown, this one included.
        robot: The `robot` message.
        shapes: Its shapes; None until they are read.
        maker: Makes its frames.
    """

    def __init__(self, session: Session, generation: int, keeps_view: bool, seats: Seats, later: Later) -> None:
        """Tell all tabs of the robot.

        Args:
            session: The session with the robot.
            generation: How many robots have been shown, this one included.
            keeps_view: Whether tabs keep their view of the robot before.
            seats: The tabs.
            later: Does work in another thread.
        """
        self.generation = generation
        self.robot: dict[str, Any] = robot_message(session.robot, generation) | {"keeps_view": keeps_view}
        self.shapes: Shapes | None = None
        self.maker = FrameMaker(session.robot, generation)
        self._additions = Additions(generation, seats, later)
        self._contacts: Contacts | None = None
        self._seats, self._later = seats, later
        self._is_over = False
        seats.send(json.dumps(self.robot))

    def begin(self, session: Session) -> None:
        """Have the shapes read."""
        self._later(lambda: shapes_of(session.robot), self._take)

    def _take(self, shapes: Shapes | BaseException) -> None:
        if isinstance(shapes, BaseException):
            shapes = Shapes((), (), (f"the shapes cannot be shown: {shapes}",))
        if not self._is_over:
            self.shapes = shapes
            for message in shapes.messages(self.generation):
                self._seats.send(message)

    def end(self) -> None:
        """Send nothing more, because another exhibit follows."""
        self._is_over = True
        self._additions.end()
        if self.shapes is not None:
            self._seats.withdraw(self.shapes.commands)  # else those of robot after robot would wait for a slow tab

    def messages(self) -> Iterator[str | bytes]:
        """What a tab that joins must get after the state."""
        yield from self.shapes.messages(self.generation) if self.shapes else ()
        yield from self._additions.messages

    def supply(self, session: Session, told: Callable[[str], None]) -> None:
        """Load what the session needs now: collision shapes, whose pairs can take seconds to find out, and looks.

        Args:
            session: The session with this robot.
            told: Called once the collision shapes are there, with the reason why there are none, or "".
        """
        self._additions.ask(session)
        contacts = session.contacts
        if contacts.waits and contacts is not self._contacts:
            self._contacts = contacts

            def take(shapes: RobotShapes | BaseException) -> None:
                contacts.take(shapes)
                told("" if self._is_over else contacts.why_not)

            self._later(contacts.load, take)
