"""The messages that wait for one tab: only one of them is handed to the socket at a time."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Collection

__all__ = ["Message", "Outbox"]

Message = str | bytes

_MOST_TEXT = 16_000_000  # characters; the `robot` message of a robot with a hundred joints has 50,000
_ROOM = 32  # texts that may wait while the server still reads what the tab sends


class Outbox:
    """Messages that a tab has not taken yet, in order.

    A tab that takes nothing costs little: shapes wait here without being copied, and the server reads no more from a
    tab that does not take its answers.
    """

    def __init__(self, write: Callable[[Message], asyncio.Future[None]], overflow: Callable[[], None]) -> None:
        """Start empty.

        Args:
            write: Hands a message to the socket; the future that it returns is done when the socket has taken it.
            overflow: Called when more text waits than any tab needs.
        """
        self._write, self._overflow = write, overflow
        self._waiting: deque[Message] = deque()
        self._texts = 0  # how many of them wait, and how long they are together
        self._characters = 0
        self._busy = False
        self._room = asyncio.Event()
        self._room.set()

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, message: Message) -> None:
        """Send a message after all others."""
        self._waiting.append(message)
        self._count(message, 1)
        if self._characters > _MOST_TEXT:
            self.clear()
            self._overflow()
        elif not self._busy:
            self._next()

    def withdraw(self, messages: Collection[bytes]) -> None:
        """Take back those of these messages that still wait."""
        gone = set(messages)
        self._waiting = deque(message for message in self._waiting if message not in gone)

    def clear(self) -> None:
        """Take back everything that still waits."""
        self._waiting.clear()
        self._texts = self._characters = 0
        self._room.set()

    async def room(self) -> None:
        """Wait until the tab has taken most of the texts that wait for it, such as the answers to its messages."""
        await self._room.wait()

    def _next(self) -> None:
        if self._waiting:
            message = self._waiting.popleft()
            self._count(message, -1)
            self._busy = True
            self._write(message).add_done_callback(self._written)

    def _written(self, written: asyncio.Future[None]) -> None:
        self._busy = False
        if written.cancelled() or written.exception() is not None:  # the tab has closed
            self.clear()
        self._next()

    def _count(self, message: Message, sign: int) -> None:
        if isinstance(message, str):
            self._texts += sign
            self._characters += sign * len(message)
            (self._room.set if self._texts < _ROOM else self._room.clear)()
