"""The frames and states that all tabs are sent: what is due, and the recording of the frames."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from ..protocol.recording import Recording
from ..simulation.session import Session
from .outbox import Message
from .seats import Seats

__all__ = ["Broadcast"]

_STATES_PER_SECOND = 4


class Broadcast:
    """Sends frames and states to the tabs that are not late, and records the frames.

    Attributes:
        recording: The frames of the last seconds.
        frame: The newest frame.
        state: The state that was sent last, just after a step while the session runs.
        frame_due: Whether something has changed that only another frame shows.
        state_due: Whether the next state is sent as soon as possible.
    """

    def __init__(self, seats: Seats, clock: Callable[[], float]) -> None:
        self.recording = Recording()
        self.frame: Message = b""
        self.state: Message = ""
        self.frame_due = self.state_due = True
        self._seats, self._clock = seats, clock
        self._recorded_step, self._state_sent = -1, clock()

    @property
    def is_due(self) -> bool:
        """Whether anything is to be sent."""
        return self.frame_due or self.state_due

    def start_anew(self, frame: bytes, session: Session) -> None:
        """Begin another recording with this frame of a session, whose instances or balls are others now."""
        self.recording.clear()
        self._recorded_step = -1
        self.record(frame, session)
        self.frame_due = self.state_due = True
        self._state_sent = self._clock()

    def send_frame(self, frame: bytes, session: Session) -> None:
        """Send a session's frame, and record it."""
        self.frame_due = False
        self.record(frame, session)
        self._seats.offer_frame(frame)

    def record(self, frame: bytes, session: Session) -> None:
        """Record a session's frame, unless one of the same step is recorded: a ball was moved between two steps."""
        self.frame = frame
        if self.lacks(session):
            self._recorded_step = session.steps
            self.recording.add(frame, [instance.q for instance in session.seen])

    def lacks(self, session: Session) -> bool:
        """Whether no frame of the session's last step is recorded."""
        return session.steps != self._recorded_step

    def wants_state(self, session: Session) -> bool:
        """Whether a state is to be sent now: one is due, or the session has moved for a quarter of a second."""
        often_enough = self._clock() - self._state_sent >= 1.0 / _STATES_PER_SECOND
        return self.state_due or (session.running and often_enough and not session.rests)

    def send_state(self, state: Callable[[], dict[str, Any]]) -> None:
        """Send what `state` returns, which is asked only if there is a tab."""
        self.state_due = False
        self._state_sent = self._clock()
        if self._seats:
            self.state = json.dumps(state())
            self._seats.offer_state(self.state)
