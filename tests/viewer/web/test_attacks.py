"""Small attacks by the attackers of tools/attack_server.py, beside a good client that must be left in peace."""

from __future__ import annotations

import asyncio
import socket
import time
from contextlib import suppress

import attack_server
import pytest
from attack_server import HOSTS, Client, frame, request, watching

import pinik
from pinik.viewer.web import door, guests, tab
from stand_ins import PATIENCE


@pytest.fixture(autouse=True)
def _less_patience(monkeypatch):
    """The server gives up on attackers sooner, so that the tests are quick."""
    monkeypatch.setattr(tab, "_PATIENCE", 0.3)
    monkeypatch.setattr(attack_server, "HELD", 0.5)


@pytest.fixture
def view(two_link):
    with pinik.live(two_link, ["dls", "ccd"], port=0, motion="curve") as opened:
        yield opened


def attack(view, attacker, count=1):
    """What the attacker was answered, while and after which a good client sees step after step."""

    async def held():
        async with watching(view.port) as good:
            before = await good.next_step()
            answer = await attacker(view.port, count)
            assert await good.next_step() > before
            await good.next_step()
        return answer

    return asyncio.run(asyncio.wait_for(held(), PATIENCE))


async def its_end(view, client):
    """The server's end of a client's websocket."""
    name = client.writer.get_extra_info("sockname")
    while True:
        for seated in list(view._show._seats._seats):
            if seated.request.connection.context.address == name:
                return seated.ws_connection
        await asyncio.sleep(0.02)


def talk(view, conversation):
    return asyncio.run(asyncio.wait_for(conversation(view.port), PATIENCE))


def test_a_flood_of_malformed_messages_is_read_slowly_and_closed_in_words(view):
    answered = []

    async def flood(port, count):
        client = await Client.websocket(port)
        reading = asyncio.create_task(client.read_to_the_end())
        messages = attack_server.malformed_messages()
        while answered.append(1) or await client.send(next(messages)):
            if len(answered) == count:
                break
        await reading
        await client.close()
        return client

    client = attack(view, flood, 20_000)
    code, words = client.closed_with
    assert code == 1008
    assert "more than 200 messages a second" in words
    assert client.errors < 2_000


def test_a_page_that_drags_with_both_hands_is_never_slowed_down(view):
    async def conversation(port):
        client = await Client.websocket(port)
        reading = asyncio.create_task(client.read_to_the_end())
        for _ in range(60):
            for _ in range(3):  # 180 messages a second
                await client.send(frame(1, b'{"type": "drawn", "step": 1}'))
            await asyncio.sleep(1 / 60)
        assert client.closed_with is None
        await client.close()
        await reading

    talk(view, conversation)


def test_answers_that_nobody_reads_do_not_pile_up(view):
    """The server reads no more from a client that does not take its answers."""

    def waiting():
        tabs = list(view._show._seats._seats)
        return max(len(one._outbox) + len(one._stream._write_buffer) // 1000 for one in tabs)

    async def mute(port, count):
        with socket.socket() as connection:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.setblocking(False)
            loop = asyncio.get_running_loop()
            await loop.sock_connect(connection, ("127.0.0.1", port))
            await loop.sock_sendall(connection, request(port))
            await asyncio.sleep(0.2)
            text = frame(1, b'{"type": "' + b"x" * 190 + b'"}')
            most = 0
            for _ in range(count):
                try:
                    connection.send(text * 10)
                except (BlockingIOError, ConnectionError):
                    await asyncio.sleep(0.01)
                most = max(most, await asyncio.to_thread(view._do, waiting))
            return most

    assert attack(view, mute, 300) < 300


def test_stalled_clients_have_64_connections_and_the_others_are_refused_in_words(view):
    answer = attack(view, attack_server.stalled, 80)
    assert "at most 64 connections may be open from one address" in answer


def test_a_client_that_takes_nothing_is_closed(view, monkeypatch):
    closed = []
    close_stalled = door.Door._close_stalled

    def noted(self):
        before = set(self._streams)
        close_stalled(self)
        closed.extend(before - set(self._streams))

    monkeypatch.setattr(door.Door, "_close_stalled", noted)
    monkeypatch.setattr(door, "_PATIENCE", 0.3)
    with pinik.live(view.robot, ["dls"], port=0) as other, socket.socket() as mute:
        mute.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        mute.connect(("127.0.0.1", other.port))
        mute.sendall(20 * request(other.port, "/meshcat/main.min.js"))

        async def until_it_is_closed(port, count):
            while not closed:
                await asyncio.sleep(0.05)

        attack(other, until_it_is_closed)


def test_what_is_too_large_is_not_read(view):
    answer = attack(view, attack_server.large)
    sizes = [float(part.split(": ")[1].split()[0]) for part in answer.split(", ")]
    assert len(sizes) == 5
    assert max(sizes) < 50.0  # of 100 MB


@pytest.mark.parametrize("opcode", [attack_server.PING, attack_server.PONG])
def test_a_flood_of_pings_or_pongs_is_ended_in_words(view, opcode):
    async def flood(port, count):
        client = await Client.websocket(port)
        reading = asyncio.create_task(client.read_to_the_end())
        await client.send(frame(opcode, b"") * count)
        await reading
        await client.close()
        return client

    assert attack(view, flood, 5_000).closed_with == (1008, "more than 200 pings a second")


def test_floods_of_empty_frames_on_eight_connections_leave_the_good_client_in_peace(view):
    assert attack(view, attack_server.empty, 8_000).count("1000 sent") == 8


def test_too_many_requests_are_refused_in_words(view, monkeypatch):
    monkeypatch.setattr(guests, "_REQUESTS_AT_ONCE", 20.0)
    with pinik.live(view.robot, ["dls"], port=0) as other:
        answer = attack(other, attack_server.requests("/api/animation.html"), 20)
    assert "'200'" in answer
    assert "Too many requests from this address" in answer


def test_many_who_want_gltf_leave_the_good_client_in_peace(view):
    for _ in range(1300):
        view.send("step")
    view.send("run", on=True)
    answer = attack(view, attack_server.requests("/api/animation.glb"), 40)
    assert "'200'" in answer


def test_a_crowd_of_addresses_shares_one_budget(view, monkeypatch):
    monkeypatch.setattr(guests, "_ALL_REQUESTS_AT_ONCE", 20.0)
    monkeypatch.setattr(guests, "_ALL_REQUESTS_PER_SECOND", 20.0)
    with pinik.live(view.robot, ["dls"], port=0) as other:
        answer = attack(other, attack_server.crowd, 100)
    assert "'200'" in answer
    assert "Too many requests from all addresses together" in answer


def test_fragments_without_content_are_read_slowly(view):
    """They are neither messages nor pings, and cost as much."""
    read = []

    async def flood(port, count):
        client = await Client.websocket(port)
        await client.send(frame(1, b"", final=False) + frame(0, b"", final=False) * count)
        server = await its_end(view, client)
        before, began = server._wire_bytes_in, time.monotonic()
        await asyncio.sleep(1.0)
        read.append((server._wire_bytes_in - before) / 6 / (time.monotonic() - began))
        await client.close()

    attack(view, flood, 50_000)
    assert 0 < read[0] < 2_000  # frames; of their pieces, 4000 are read in a second


def test_a_head_that_never_ends_is_not_read_to_the_end(view):
    answer = attack(view, attack_server.trickle, 2_000)
    assert "closed" in answer


def test_a_storm_of_connections_is_let_in_slowly(view):
    answer = attack(view, attack_server.knocks, 400)
    assert answer == "{'opened': 400}"


def test_no_hostile_name_of_the_server_is_let_in_or_repeated(view):
    async def conversation(port):
        for host in HOSTS:
            for path in ("/", "/ws", "/api/state", "/nothing"):
                client = await Client.connect(port)
                with suppress(asyncio.IncompleteReadError):  # closed without an answer, for a header that is none
                    status, head, body = await client.ask(request(port, path, Host=host))
                    assert status in (400, 403), (host, path)
                    assert len(host) < 4 or host not in head + body.decode("latin-1"), (host, path)
                await client.close()

    talk(view, conversation)


def test_strangers_get_nothing(view):
    answer = attack(view, attack_server.strangers, 90)
    assert "'0: 200'" not in answer
    assert "101" not in answer


@pytest.mark.parametrize(
    ("path", "status"),
    [("/", 200), ("/api/state", 403), ("/api/animation.html", 403), ("/meshcat/main.min.js", 403), ("/ws", 403)],
)
def test_pages_of_other_sites_load_nothing_but_the_page(view, path, status):
    """A browser says which site a request comes from; the page's own policy says which pages may show it in a frame."""

    async def conversation(port):
        client = await Client.connect(port)
        answer = await client.ask(request(port, path, Sec_Fetch_Site="cross-site", Origin="http://evil.example"))
        await client.close()
        return answer[0]

    assert talk(view, conversation) == status
