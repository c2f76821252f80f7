"""A tab's websocket: what it may send, and how fast."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Collection

import tornado.websocket

from .budget import Budget, Turns
from .heartbeat import Heartbeat
from .outbox import Message, Outbox
from .show import Show

__all__ = ["LARGEST_MESSAGE", "WebSocket"]

LARGEST_MESSAGE = 65_536  # bytes; enough for the longest set-up
# A tab may keep the server busy for a tenth of the time; every message counts as half a millisecond at least.
_SHARE = 0.1
_AT_ONCE = 0.1  # [s]
_LEAST = 0.0005  # [s]
_PATIENCE = 5.0  # [s] for a tab that sends more
_FAREWELL = 1.0  # [s] for it to read why it is closed
_PER_SECOND = round(_SHARE / _LEAST)


class WebSocket(tornado.websocket.WebSocketHandler):
    """One tab. Tornado checks that its page comes from this server: Origin and Host must agree.

    A tab that sends more than its budget allows is read more slowly, and closed if it does not stop. Its next message
    is read when its last one has been done.
    """

    show: Show
    heartbeat: Heartbeat
    turns: Turns

    def open(self, *args: str, **kwargs: str) -> None:
        """Let the tab in."""
        self._stream = self.ws_connection and self.ws_connection.stream
        self._budget = Budget(_SHARE, _AT_ONCE)
        self._in_budget = time.monotonic()
        self._outbox = Outbox(self._hand_over, self._hang_up)
        self.set_nodelay(True)
        self.heartbeat.wake()
        self.show.join(self)

    async def on_message(self, message: str | bytes) -> None:
        """Do what the tab asks, in turn and within its budget. Tornado waits for this before it reads on."""
        await self._outbox.room()
        await self._budgeted()
        if self.ws_connection is not None:
            asked = message if isinstance(message, str) else ""
            self.heartbeat.wake()
            spent = await self.turns.take(lambda: self.show.receive(self, asked))
            self._budget.spend(max(_LEAST, spent))

    def on_ping(self, data: bytes) -> None:
        """Count a ping, which tornado has answered."""
        self._count()

    def on_pong(self, data: bytes) -> None:
        """Count an answer to a ping, asked for or not."""
        self._count()

    def on_close(self) -> None:
        """Forget the tab."""
        self._outbox.clear()
        self.show.leave(self)

    def send(self, message: Message) -> None:
        """Send a message without waiting for it; one to a tab that has just closed is lost."""
        self._outbox.add(message)

    def withdraw(self, messages: Collection[bytes]) -> None:
        """Take back those of these messages that have not been sent yet."""
        self._outbox.withdraw(messages)

    async def _budgeted(self) -> None:
        """Wait until the budget allows another message, or close the tab if it has been beyond it for too long."""
        if self._budget.is_full:
            self._in_budget = time.monotonic()
        while delay := self._budget.delay:
            if time.monotonic() - self._in_budget > _PATIENCE:
                self.close(1008, f"more than {_PER_SECOND} messages a second, or messages that take too long")
                await asyncio.sleep(_FAREWELL)  # nothing more is read from it
                self._hang_up()
                return
            await asyncio.sleep(delay)

    def _count(self) -> None:
        """Count a message that does not wait for its turn; too many of them end the connection."""
        self._budget.spend(_LEAST)
        if self._budget.delay > _AT_ONCE / _SHARE:
            self.close(1008, f"more than {_PER_SECOND} pings a second")
            self._hang_up()

    def _hand_over(self, message: Message) -> asyncio.Future[None]:
        try:
            return self.write_message(message, binary=isinstance(message, bytes))
        except tornado.websocket.WebSocketClosedError as error:
            closed: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            closed.set_exception(error)
            return closed

    def _hang_up(self) -> None:
        """End the connection at once."""
        if self._stream is not None:
            self._stream.close()
