"""What waits for a tab that does not take it, or takes it slowly."""

from __future__ import annotations

import asyncio

from pinik.viewer.web.outbox import Outbox
from stand_ins import PATIENCE


class Socket:
    """Takes a message when the test says so."""

    def __init__(self):
        self.got = []
        self.overflowed = 0
        self.outbox = Outbox(self.write, self.overflow)

    def write(self, message):
        self.got.append(message)
        self.written = asyncio.get_running_loop().create_future()
        return self.written

    def overflow(self):
        self.overflowed += 1

    async def take(self, count=1):
        for _ in range(count):
            self.written.set_result(None)
            await asyncio.sleep(0)  # the future's callbacks run


def in_loop(test):
    """Run an async test with a new socket."""

    def run():
        async def held():
            await test(Socket())

        asyncio.run(asyncio.wait_for(held(), PATIENCE))

    run.__name__ = test.__name__
    return run


@in_loop
async def test_only_one_message_at_a_time_is_handed_to_the_socket(socket):
    for k in range(5):
        socket.outbox.add(f"message {k}")
    assert socket.got == ["message 0"]
    await socket.take(4)
    assert socket.got == [f"message {k}" for k in range(5)]


@in_loop
async def test_shapes_of_a_former_robot_are_taken_back_and_all_else_arrives(socket):
    old = (b"shape 1", b"shape 2")
    for message in ("robot", *old, b"PNKF", "state"):
        socket.outbox.add(message)
    socket.outbox.withdraw(old)
    await socket.take(3)
    assert socket.got == ["robot", b"PNKF", "state"]


@in_loop
async def test_there_is_room_until_a_tab_leaves_many_answers_untaken(socket):
    for k in range(31):
        socket.outbox.add(f"answer {k}")
    await socket.outbox.room()
    for k in range(31, 60):
        socket.outbox.add(f"answer {k}")
    waiting = asyncio.ensure_future(socket.outbox.room())
    await asyncio.sleep(0)
    assert not waiting.done()
    await socket.take(30)
    await waiting


@in_loop
async def test_shapes_take_no_room(socket):
    for _ in range(100):
        socket.outbox.add(b"shape")
    await socket.outbox.room()


@in_loop
async def test_a_tab_for_which_too_much_text_waits_is_given_up_and_nothing_is_kept(socket):
    for _ in range(20):
        socket.outbox.add("x" * 1_000_000)
        if socket.overflowed:
            break
    assert socket.overflowed == 1
    assert len(socket.outbox) == 0


@in_loop
async def test_a_closed_socket_keeps_nothing_and_holds_up_nobody(socket):
    for k in range(60):
        socket.outbox.add(f"message {k}")
    socket.written.set_exception(ConnectionError())
    await asyncio.sleep(0)
    assert len(socket.outbox) == 0
    await socket.outbox.room()
