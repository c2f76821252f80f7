"""Connections: what they read in a second is bounded, nothing of it is lost, and they take turns."""

from __future__ import annotations

import asyncio
import socket
import time

import pytest
from tornado.iostream import StreamClosedError

from pinik.viewer.web.budget import Budget
from pinik.viewer.web.connection import Connection
from stand_ins import PATIENCE

FRAME = bytes(range(7))


class Counting(Connection):
    """A connection that counts how often it reads from its socket."""

    reads = 0

    def read_from_fd(self, buf):
        self.reads += 1
        return super().read_from_fd(buf)


@pytest.fixture
def ends():
    """The two ends of a connection, of which the second is the client's."""
    server, client = socket.socketpair()
    server.setblocking(False)
    client.setblocking(False)
    yield server, client
    client.close()


def talk(conversation):
    return asyncio.run(asyncio.wait_for(conversation, PATIENCE))


def ignore(connection):
    pass


def test_many_small_pieces_take_their_time_and_arrive_in_order(ends):
    """Each counts as 50 µs at least: a hundredth of the time is enough for 200 of them in a second."""
    server, client = ends
    client.sendall(FRAME * 50)

    async def conversation():
        connection = Connection(server, Budget(0.01, 0.0), ignore)
        began = time.monotonic()
        found = [await connection.read_bytes(size) for _ in range(50) for size in (2, 4, 1)]
        connection.close()
        return b"".join(found), time.monotonic() - began

    content, seconds = talk(conversation())
    assert content == FRAME * 50
    assert seconds > 0.6  # 150 pieces


def test_a_head_that_comes_byte_by_byte_is_read_in_fewer_pieces(ends):
    server, client = ends
    head = b"GET / HTTP/1.1\r\nX: " + b"x" * 500 + b"\r\n\r\n"

    async def conversation():
        connection = Counting(server, Budget(0.01, 0.0), ignore)
        reading = asyncio.ensure_future(connection.read_until(b"\r\n\r\n"))
        began = time.monotonic()
        for k in range(len(head)):
            await asyncio.get_running_loop().sock_sendall(client, head[k : k + 1])
            await asyncio.sleep(0.0)
        answer = await reading
        reads, seconds = connection.reads, time.monotonic() - began
        connection.close()
        return answer, reads, seconds

    answer, reads, seconds = talk(conversation())
    assert answer == head
    assert reads < 20 + 400 * seconds  # two attempts for each of 200 pieces a second; there were 523 bytes


def test_a_client_that_sends_without_end_leaves_the_others_their_turns():
    async def conversation():
        reading = Budget(0.2, 0.01)
        pairs = [socket.socketpair() for _ in range(21)]
        connections = []
        for server, client in pairs:
            server.setblocking(False)
            connections.append(Connection(server, reading, ignore))
            client.setblocking(False)
            client.send(FRAME * 8000)
        greedy = [asyncio.ensure_future(read_on(connection)) for connection in connections[1:]]
        await asyncio.sleep(0.1)
        pieces.clear()
        frames = 0
        began = time.monotonic()
        while time.monotonic() < began + 1.0:
            assert await connections[0].read_bytes(7) == FRAME
            frames += 1
        for task in greedy:
            task.cancel()
        await asyncio.gather(*greedy, return_exceptions=True)
        for connection, (_, client) in zip(connections, pairs, strict=True):
            connection.close()
            client.close()
        return frames, len(pieces)

    pieces = []

    async def read_on(connection):
        while True:
            await connection.read_bytes(1)
            pieces.append(1)

    frames, others = talk(conversation())
    assert frames > others / 20 / 4  # its own turn would be as many as each of the 20 others has


def test_a_connection_that_is_closed_while_it_waits_tells_so_once(ends):
    server, client = ends
    closed = []

    async def conversation():
        reading = Budget(1.0, 0.0)
        connection = Connection(server, reading, closed.append)
        answer = asyncio.ensure_future(connection.read_until(b"\r\n"))
        reading.spend(0.1)
        client.send(b"hello")
        await asyncio.sleep(0.05)
        connection.close()
        await asyncio.sleep(0.1)
        assert closed == [connection]
        with pytest.raises(StreamClosedError):
            await answer

    talk(conversation())
