"""The other answers to what the balls ask for, and the self-motion of an instance, for pages that want to see them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, PinikError
from ...problem.targets import Target
from ...robot import Robot
from ...solving.branches import Branches
from ...solving.self_motion import SelfMotion, self_motion
from ...solving.solve_all import solve_all
from ..protocol.messages import checked, whole_number
from ..protocol.packing import JointPlacements
from ..simulation.arrival import why_away, why_near_only
from ..simulation.instance import same_objects
from ..simulation.session import Session
from .later import Later

__all__ = ["Answers"]

_MOST = 16
_POINTS = 61
_PATIENCE = 3.0  # [s]
_DIGITS = 5


class Answers:
    """Finds all answers of a session, or the self-motion of one of its instances, in another thread.

    The balls stop when they are asked for, since the answers hold for this place only. One of the answers, or a place
    along the self-motion, is then taken by its number. One search is under way at a time, and the newest request of
    those that come meanwhile follows it; the others are dropped.
    """

    def __init__(self, later: Later, tell: Callable[[str], None]) -> None:
        """Be ready.

        Args:
            later: Does work in another thread.
            tell: Sends a message to every tab.
        """
        self._later, self._tell = later, tell
        self._is_searching = False
        self.forget()

    KINDS = ("find_answers", "find_self_motion", "take_answer", "move_along")
    """The messages that it receives."""

    def receive(self, message: Mapping[str, Any], session: Session, generation: int) -> None:
        """Do what one of the messages of `KINDS` asks.

        Raises:
            InputError: It is malformed, or asks for something that was not found.
        """
        match message["type"]:
            case "find_answers":
                checked("find_answers", message, {})
                self.find(session, generation)
            case "find_self_motion":
                fields = checked("find_self_motion", message, {"instance": whole_number})
                self.follow(session, generation, fields["instance"])
            case "take_answer":
                self.choose(
                    session, **checked("take_answer", message, {"index": whole_number, "instance": whole_number})
                )
            case _:
                self.move_along(session, **checked("move_along", message, {"index": whole_number}))

    def forget(self) -> None:
        """Forget what was found; work under way is told to nobody."""
        self._found: list[NDArray[np.float64]] = []
        self._along: list[NDArray[np.float64]] = []
        self._instance = 0
        self._request: object = None
        self._next: Callable[[], None] | None = None

    def find(self, session: Session, generation: int) -> None:
        """Find all answers to what the balls ask for, the nearest to the first instance first.

        Raises:
            InputError: No ball asks for anything.
        """
        robot, targets, q = self._asked(session, 0)
        limits, avoid = session.settings.limits, session.contacts.avoided

        def work() -> Branches:
            return solve_all(robot, targets, q0=q, limits=limits, avoid=avoid, time_limit=_PATIENCE)

        def take(found: Branches) -> None:
            self._found = list(found.q[:_MOST])
            more = f"; the nearest {_MOST} are shown" if len(found) > _MOST else ""
            words = {"message": found.message + more, "distance": found.distance[:_MOST].tolist()}
            self._say("answers", generation, session, self._found, words)

        self._begin(session, targets, work, take)

    def follow(self, session: Session, generation: int, instance: int) -> None:
        """Find how an instance can move while the balls' frames stay where they are; if it misses one, say so.

        Raises:
            InputError: There is no such instance, or no ball asks for anything.
        """
        robot, targets, q = self._asked(session, instance)
        limits, tolerance = session.settings.limits, session.settings.tolerance
        away, near_only = why_away(session, instance), why_near_only(session, instance)

        def work() -> SelfMotion | str:
            if away:
                return away
            try:
                return self_motion(robot, targets, q, points=_POINTS, limits=limits, tolerance=tolerance)
            except InputError as error:
                if error.argument != "q":
                    raise
                return near_only

        def take(found: SelfMotion | str) -> None:
            curve = None if isinstance(found, str) or found.dimension != 1 else found
            self._along, self._instance = list(curve.q) if curve else [], instance
            text = str(found)
            if not isinstance(found, str) and found.dimension > 1:
                text += ". A set of more than one dimension has no slider: ask for more, such as an orientation"
            words = {"message": text, "instance": instance, "closed": curve is not None and curve.closed}
            self._say("self_motion", generation, session, self._along, words)

        self._begin(session, targets, work, take)

    def choose(self, session: Session, index: int, instance: int) -> None:
        """Put an instance into one of the answers that were found.

        Raises:
            InputError: There is no such answer or instance.
        """
        _put(session, instance, self._found, index, "answer")

    def move_along(self, session: Session, index: int) -> None:
        """Put the instance whose self-motion was found to one of its places.

        Raises:
            InputError: There is no such place.
        """
        _put(session, self._instance, self._along, index, "place along the self-motion")

    def _asked(self, session: Session, instance: int) -> tuple[Robot, tuple[Target, ...], NDArray[np.float64]]:
        q = session.instances.visible(instance).q
        targets = tuple(session.balls.targets)
        if not targets:
            raise InputError("no ball asks for anything; switch one on first")
        session.set_motion("hand")
        return session.robot, targets, q

    def _begin(
        self, session: Session, targets: Sequence[Target], work: Callable[[], Any], take: Callable[[Any], None]
    ) -> None:
        request = self._request = object()

        def begin() -> None:
            self._is_searching, self._next = True, None
            self._later(work, given)

        def given(result: Any) -> None:
            self._is_searching = False
            if self._next is not None:
                self._next()
            if request is not self._request:
                return
            if isinstance(result, BaseException):
                words = str(result) if isinstance(result, PinikError) else f"{type(result).__name__}: {result}"
                self._tell(json.dumps({"type": "error", "message": words}))
            elif not same_objects(session.balls.targets, targets):
                words = "a ball has changed during the search; search again"
                self._tell(json.dumps({"type": "error", "message": words}))
            else:
                take(result)

        if self._is_searching:
            self._next = begin
        else:
            begin()

    def _say(
        self, kind: str, generation: int, session: Session, found: list[NDArray[np.float64]], words: dict[str, Any]
    ) -> None:
        placements = JointPlacements(session.robot)
        places = [np.round(placements.at(q), _DIGITS).ravel().tolist() for q in found]
        balls = [{"mode": ball.mode, "position": ball.position.tolist()} for ball in session.balls]
        message = {"type": kind, "generation": generation, **words, "balls": balls, "placements": places}
        self._tell(json.dumps(message))


def _put(session: Session, instance: int, known: list[NDArray[np.float64]], index: int, what: str) -> None:
    if not 0 <= index < len(known):
        raise InputError(f"there is no {what} {index}; {len(known)} were found, numbered from 0")
    session.instances.visible(instance).put(known[index])
