"""The tabs that watch a live view, and how much may be under way to each."""

from __future__ import annotations

from collections.abc import Collection
from typing import Protocol

from .outbox import Message

__all__ = ["Seats", "Tab"]

_FRAMES_UNDER_WAY = 2  # unanswered frames per tab; more would only queue up in a slow one


class Tab(Protocol):
    """One browser tab."""

    def send(self, message: Message) -> None:
        """Send a message without waiting for it; messages arrive in order."""

    def withdraw(self, messages: Collection[bytes]) -> None:
        """Take back those of these messages that have not been sent yet."""


class _Seat:
    """How many frames a tab has not answered yet, and what is withheld until it does."""

    def __init__(self) -> None:
        self.under_way = 0
        self.frame_waits = False
        self.state_waits = False

    @property
    def is_late(self) -> bool:
        return self.under_way >= _FRAMES_UNDER_WAY


class Seats:
    """All tabs. A tab that is late gets no frame and no state until it answers, and then only the newest."""

    def __init__(self) -> None:
        self._seats: dict[Tab, _Seat] = {}

    def __len__(self) -> int:
        return len(self._seats)

    def add(self, tab: Tab, frame: Message) -> None:
        """Seat a new tab and send it its first frame."""
        seat = self._seats[tab] = _Seat()
        _offer_frame(tab, seat, frame)

    def remove(self, tab: Tab) -> None:
        """Forget a tab; nothing happens if it is not there."""
        self._seats.pop(tab, None)

    def is_late(self, tab: Tab) -> bool:
        """Whether a tab has frames to answer before it is sent more."""
        seat = self._seats.get(tab)
        return seat is not None and seat.is_late

    def send(self, message: Message) -> None:
        """Send a message to every tab, late or not."""
        for tab in self._seats:
            tab.send(message)

    def withdraw(self, messages: Collection[bytes]) -> None:
        """Take back from every tab those of these messages that have not been sent yet."""
        for tab in self._seats:
            tab.withdraw(messages)

    def offer_frame(self, frame: Message) -> None:
        """Send a frame to every tab that is not late."""
        for tab, seat in self._seats.items():
            _offer_frame(tab, seat, frame)

    def offer_state(self, state: Message) -> None:
        """Send a state to every tab that is not late."""
        for tab, seat in self._seats.items():
            _offer_state(tab, seat, state)

    def drawn(self, tab: Tab, frame: Message, state: Message) -> None:
        """Note that a tab has drawn a frame, and send it the newest state and frame if it was kept waiting for them."""
        seat = self._seats.get(tab)
        if seat is None or seat.under_way == 0:
            return
        seat.under_way -= 1
        if seat.state_waits:
            _offer_state(tab, seat, state)
        if seat.frame_waits:
            _offer_frame(tab, seat, frame)


def _offer_frame(tab: Tab, seat: _Seat, frame: Message) -> None:
    seat.frame_waits = seat.is_late
    if not seat.is_late:
        seat.under_way += 1
        tab.send(frame)


def _offer_state(tab: Tab, seat: _Seat, state: Message) -> None:
    seat.state_waits = seat.is_late
    if not seat.is_late:
        tab.send(state)
