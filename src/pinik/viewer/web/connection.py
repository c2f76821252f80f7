"""A client's connection, of which the server reads no more than its time allows."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable
from typing import Any

from tornado.iostream import IOStream

from .budget import Budget

__all__ = ["Connection", "reading_budget"]

_SHARE = 0.2
_AT_ONCE = 0.01  # [s]
_LARGEST_READ = 1_000_000  # bytes that wait to be read by the server; no message or request is that long
_PIECE = 50e-6  # [s] that a piece counts as at least, however short; a websocket's frame is read in three


def reading_budget() -> Budget:
    """Return the budget for what all connections read together: a fifth of the time."""
    return Budget(_SHARE, _AT_ONCE)


class Connection(IOStream):
    """A connection that reads within a budget, and tells when it is closed and when it has last sent anything.

    What a client sends costs time before it amounts to a message or a request that could be counted: a head that comes
    byte by byte, or fragments without content. So the reading itself is counted, for all connections together; beyond
    their budget, what clients have sent waits in the system's buffers, and the connections take turns.
    """

    def __init__(self, opened: socket.socket, reading: Budget, closed: Callable[[Connection], None]) -> None:
        """Take over an open connection.

        Args:
            opened: The connection's socket.
            reading: The budget [s] for what all connections read.
            closed: Called once the connection is closed.
        """
        super().__init__(opened, max_buffer_size=_LARGEST_READ)
        self._reading, self._tell_closed = reading, closed
        self.sent_at = self.io_loop.time()

    def read_bytes(self, num_bytes: int, partial: bool = False) -> Awaitable[bytes]:
        """Read so many bytes, once there is time for it."""
        self._reading.spend(_PIECE)
        if self._reading.delay:
            return self._read_later(num_bytes, partial)
        return super().read_bytes(num_bytes, partial)

    async def _read_later(self, num_bytes: int, partial: bool) -> bytes:
        await asyncio.sleep(self._reading.delay)
        return await super().read_bytes(num_bytes, partial)

    def _handle_events(self, fd: Any, events: int) -> None:
        """Read or write what the socket is ready for; tornado calls this."""
        if not events & self.io_loop.READ:
            super()._handle_events(fd, events)
        elif delay := self._reading.delay:
            self._listen(reading=False)
            self.io_loop.call_later(delay, self._listen)
        else:
            began = time.thread_time()
            super()._handle_events(fd, events)
            self._reading.spend(_PIECE + time.thread_time() - began)

    def _listen(self, reading: bool = True) -> None:
        """Be told of what the stream waits for, with or without what there is to be read."""
        if self._state is not None:  # it is None once the stream is closed
            self.io_loop.update_handler(self.fileno(), self._state if reading else self._state & ~self.io_loop.READ)

    def write_to_fd(self, data: memoryview) -> int:
        """Send what the socket takes, and note when."""
        count = super().write_to_fd(data)
        if count:
            self.sent_at = self.io_loop.time()
        return count

    def close_fd(self) -> None:
        """Close the socket, and report it."""
        super().close_fd()
        self._tell_closed(self)
