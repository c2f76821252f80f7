"""The door: accepts connections, and closes those whose client takes nothing any more."""

from __future__ import annotations

import socket
from collections.abc import Iterable

from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop, PeriodicCallback

from .budget import Budget
from .connection import Connection, reading_budget
from .guests import Guests

__all__ = ["Door"]

_CONNECTIONS_PER_SECOND = 100.0
_CONNECTIONS_AT_ONCE = 200.0
_PATIENCE = 30.0  # [s] without progress in sending
_FAREWELL = 0.5  # [s] for a refused client to read why
_REFUSAL = (
    b"HTTP/1.1 503 Service Unavailable\r\nContent-Type: text/plain; charset=utf-8\r\nRetry-After: 5\r\n"
    b"Connection: close\r\nContent-Length: %d\r\n\r\n"
)


class Door:
    """Accepts connections for a server, on sockets that listen already.

    Tornado would accept all that wait before it does anything else. The door accepts one at a time, so that a storm of
    connections does not hold up the session's steps, and at most a hundred a second; the others wait in the system's
    queue. A client that has too many connections is told so.
    """

    def __init__(self, server: HTTPServer, guests: Guests, sockets: Iterable[socket.socket]) -> None:
        self._server, self._guests = server, guests
        self._loop = IOLoop.current()
        self._listening = list(sockets)
        self._budget = Budget(_CONNECTIONS_PER_SECOND, _CONNECTIONS_AT_ONCE)
        self._reading = reading_budget()
        self._streams: dict[Connection, str] = {}
        self._sweep = PeriodicCallback(self._close_stalled, 1000.0 * _PATIENCE / 3.0)
        self._resuming: object | None = None
        self._resume()
        self._sweep.start()

    def close(self) -> None:
        """Accept no more, and close everything."""
        self._pause()
        self._sweep.stop()
        for listening in self._listening:
            listening.close()
        for stream in list(self._streams):
            stream.close()

    def _resume(self) -> None:
        self._resuming = None
        for listening in self._listening:
            self._loop.add_handler(listening, self._accept, IOLoop.READ)

    def _pause(self) -> None:
        if self._resuming is not None:
            self._loop.remove_timeout(self._resuming)
            return
        for listening in self._listening:
            self._loop.remove_handler(listening)

    def _rest(self, seconds: float) -> None:
        self._pause()
        self._resuming = self._loop.call_later(seconds, self._resume)

    def _accept(self, listening: socket.socket, events: int) -> None:
        try:
            connection, address = listening.accept()
        except (BlockingIOError, ConnectionError):
            return
        except OSError:  # no more files may be open
            self._rest(1.0)
            return
        self._budget.spend(1.0)
        if delay := self._budget.delay:
            self._rest(delay)
        host = str(address[0])
        refusal = self._guests.enter(host)
        if refusal:
            self._refuse(connection, refusal)
            return
        stream = Connection(connection, self._reading, self._closed)
        self._streams[stream] = host
        self._server.handle_stream(stream, address)

    def _closed(self, stream: Connection) -> None:
        self._guests.leave(self._streams.pop(stream))

    def _refuse(self, connection: socket.socket, words: str) -> None:
        """Answer without reading the request, and close once the client can have read the answer."""
        body = f"503 {words}\n".encode()
        connection.setblocking(False)
        try:
            connection.send(_REFUSAL % len(body) + body)
        except OSError:
            connection.close()
            return
        self._loop.call_later(_FAREWELL, connection.close)

    def _close_stalled(self) -> None:
        """Close the connections whose clients have taken nothing for a while, although something waits for them."""
        now = self._loop.time()
        for stream in list(self._streams):
            if stream.writing() and now - stream.sent_at > _PATIENCE:
                stream.close()
