"""Attack the live view's server, let it run for long, or leave it alone, and print what that does to a good client.

    python tools/attack_server.py                        every attack, at full size
    python tools/attack_server.py malformed --scale 0.1  one attack, at a tenth of its size
    python tools/attack_server.py --soak 60              four lions at random motion for an hour: a line each minute
    python tools/attack_server.py --idle 30              the processor's time of a server that nobody watches

The server runs in a process of its own. During an attack, a good client watches it as a page does; its steps per second
and the server's memory are what the attacks are judged by. `tests/viewer/web/test_attacks.py` runs small attacks.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import re
import struct
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Awaitable, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from pathlib import Path
from typing import Any

PATIENCE = 60.0  # [s] for anything that the server should do at once
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
REFUSED = (OSError, asyncio.IncompleteReadError)
HELD = 10.0  # [s] for which stalled clients stay
WATCHED_ALONE = 3.0  # [s] before and after an attack


# The server, and what it costs


@contextmanager
def live(*arguments: str) -> Iterator[tuple[int, int]]:
    """`pinik live` in a process of its own: its process id and its port."""
    command = [sys.executable, "-m", "pinik", "live", *arguments, "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        try:
            assert process.stdout
            yield process.pid, int(process.stdout.readline().strip().rstrip("/").rpartition(":")[2])
        finally:
            process.terminate()


def megabytes(pid: int) -> float:
    """The process's resident size [MB], from /proc."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def processor_seconds(pid: int) -> float:
    """The time [s] that the process has spent on processors, from /proc."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


# A client, made by hand so that it can misbehave


def frame(opcode: int, content: bytes, final: bool = True, length: int | None = None) -> bytes:
    """A websocket frame of a client; `length` is what it claims to contain. Its mask is zero."""
    size = len(content) if length is None else length
    head = bytes([0x80 * final | opcode])
    if size < 126:
        head += bytes([0x80 | size])
    elif size < 65_536:
        head += struct.pack("!BH", 0x80 | 126, size)
    else:
        head += struct.pack("!BQ", 0x80 | 127, size)
    return head + bytes(4) + content


def request(port: int, path: str = "/ws", **headers: str) -> bytes:
    """A GET request; one for /ws asks for a websocket."""
    fields = {"Host": f"127.0.0.1:{port}"}
    if path == "/ws":
        fields |= {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                   "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}  # fmt: skip
    fields |= {name.replace("_", "-"): value for name, value in headers.items()}
    lines = [f"GET {path} HTTP/1.1", *(f"{name}: {value}" for name, value in fields.items())]
    return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1")


class Client:
    """One connection to the server.

    Attributes:
        errors: The number of `error` messages that it got.
        closed_with: Code and words with which the server closed the websocket, or None.
    """

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer
        self.errors = 0
        self.closed_with: tuple[int, str] | None = None

    @classmethod
    async def connect(cls, port: int, address: str = "127.0.0.1") -> Client:
        """Connect from an address of this machine."""
        return cls(*await asyncio.open_connection("127.0.0.1", port, local_addr=(address, 0)))

    @classmethod
    async def websocket(cls, port: int, **headers: str) -> Client:
        """Open a websocket.

        Raises:
            ConnectionError: The server refuses it.
        """
        client = await cls.connect(port)
        try:
            status, _, body = await client.ask(request(port, **headers))
            if status != 101:
                raise ConnectionError(body.decode("utf-8", "replace").strip())
        except BaseException:
            await client.close()
            raise
        return client

    async def ask(self, text: bytes) -> tuple[int, str, bytes]:
        """Send a request, and return status, head and body of the answer."""
        self.writer.write(text)
        head = (await asyncio.wait_for(self.reader.readuntil(b"\r\n\r\n"), PATIENCE)).decode("latin-1")
        length = re.search(r"^content-length: *(\d+)", head, re.IGNORECASE | re.MULTILINE)
        body = await asyncio.wait_for(self.reader.readexactly(int(length[1])), PATIENCE) if length else b""
        return int(head.split()[1]), head, body

    async def send(self, data: bytes) -> bool:
        """Send bytes as fast as the server takes them; return False if it has closed the connection."""
        try:
            self.writer.write(data)
            await self.writer.drain()
        except OSError:
            return False
        return not self.writer.is_closing()

    async def read(self) -> tuple[int, bytes] | None:
        """Read the next message: its opcode and content; None at the end."""
        try:
            first, size = await self.reader.readexactly(2)
            if size == 126:
                (size,) = struct.unpack("!H", await self.reader.readexactly(2))
            elif size == 127:
                (size,) = struct.unpack("!Q", await self.reader.readexactly(8))
            content = await self.reader.readexactly(size)
        except (OSError, asyncio.IncompleteReadError):
            return None
        if first & 15 == CLOSE and size >= 2:
            self.closed_with = int.from_bytes(content[:2], "big"), content[2:].decode()
        self.errors += content.startswith(b'{"type": "error"')
        return first & 15, content

    async def read_to_the_end(self) -> None:
        while await self.read():
            pass

    async def close(self) -> None:
        self.writer.close()
        with suppress(OSError):
            await self.writer.wait_closed()


class GoodClient:
    """Watches the server as a page does, and notes when which step arrived."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.seen: list[tuple[float, int]] = []
        self.state: dict[str, Any] = {}
        self._task = asyncio.create_task(self._watch())

    @classmethod
    async def connect(cls, port: int) -> GoodClient:
        return cls(await Client.websocket(port))

    async def _watch(self) -> None:
        while message := await self._client.read():
            opcode, content = message
            if opcode == PING:
                await self._client.send(frame(PONG, content))
            elif content.startswith(b"PNKF"):
                (step,) = struct.unpack_from("<I", content, 8)
                self.seen.append((time.perf_counter(), step))
                await self._client.send(frame(TEXT, b'{"type": "drawn", "step": %d}' % step))
            elif content.startswith(b'{"type": "state"'):
                self.state = json.loads(content)

    async def next_step(self) -> int:
        """Wait for a frame that is not here yet, and return its step."""
        known = len(self.seen)
        began = time.perf_counter()
        while len(self.seen) == known:
            if self._task.done() or time.perf_counter() - began > PATIENCE:
                raise ConnectionError(f"the good client was left alone; {self._client.closed_with}")
            await asyncio.sleep(0.02)
        return self.seen[-1][1]

    async def close(self) -> None:
        await self._client.close()
        await self._task

    def pace(self, since: int = 0) -> float:
        """The steps per second from one frame, given by its number, to the last."""
        (began, first), (ended, last) = self.seen[since], self.seen[-1]
        return (last - first) / (ended - began)


@asynccontextmanager
async def watching(port: int) -> Any:
    good = await GoodClient.connect(port)
    try:
        yield good
    finally:
        await good.close()


# The attacks: each returns what the server answered, in words


class Ammunition:
    """How much of an attack is left, and how long it may still take: a server that defends itself makes it slow."""

    def __init__(self, count: int, seconds: float = 60.0) -> None:
        self._count, self._left = count, count
        self._until = time.perf_counter() + seconds

    @property
    def used(self) -> int:
        return self._count - self._left

    def take(self, count: int = 1) -> bool:
        """Return whether the attack goes on, and count what it uses next."""
        if self._left <= 0 or time.perf_counter() > self._until:
            return False
        self._left -= count
        return True


def malformed_messages() -> Iterator[bytes]:
    """Messages that no page would send, without an end."""
    rng = random.Random(0)
    whole = [
        b"", b"{}", b"[]", b"hello", b"[" * 900 + b"]" * 900, b"[" * 30_000, b'{"type": "speed", "value": NaN}',
        b'{"type": "' + b"x" * 60_000 + b'"}', b'{"type": "\\ud800"}', b'{"type": "drawn"}',
        b'{"type": "setup", "setup": "' + b"x" * 30_000 + b'"}', b'{"type": "ball", "index": 1e9, "position": []}',
        b'{"type": "method", "instance": 0, "method": "os:system"}',
        b'{"type": "limits", "on": "' + b"y" * 50_000 + b'"}',
        b'{"type": "robot", "name": "' + b"../" * 60 + b'", "root": "fixed"}',
        b'{"type": "parameter", "instance": 0, "name": "damping", "value": ' + b"[" * 7 + b"0" + b"]" * 7 + b"}",
        b'{"type": "parameter", "instance": 0, "name": "stiffness", "value": '
        + json.dumps({f"joint{k}": k for k in range(999)}).encode() + b"}",
    ]  # fmt: skip
    while True:
        yield frame(TEXT, b'{"type": "nothing"}')
        message = bytearray(rng.choice(whole))
        if message and rng.random() < 0.5:
            message[rng.randrange(len(message))] = rng.randrange(128)
        yield frame(rng.choice((TEXT, BINARY)), bytes(message))


async def malformed(port: int, count: int) -> str:
    """Malformed messages on one connection, as fast as it takes them."""
    client = await Client.websocket(port)
    reading = asyncio.create_task(client.read_to_the_end())
    ammunition, messages = Ammunition(count), malformed_messages()
    while ammunition.take() and await client.send(next(messages)):
        pass
    with suppress(asyncio.TimeoutError):
        await asyncio.wait_for(asyncio.shield(reading), 10.0)
    await client.close()
    await reading
    return f"{ammunition.used} sent, {client.errors} answered, closed with {client.closed_with}"


async def persistent(port: int, count: int) -> str:
    """The same, on 16 connections at a time, and on a new one whenever one is closed."""
    ammunition, ends = Ammunition(count, 120.0), Counter[str]()

    async def attacker() -> None:
        messages = malformed_messages()
        while ammunition.take(0):
            try:
                client = await Client.websocket(port)
            except REFUSED as refusal:
                ends[str(refusal)] += 1
                await asyncio.sleep(0.1)
                continue
            reading = asyncio.create_task(client.read_to_the_end())
            while ammunition.take() and await client.send(next(messages)):
                pass
            await client.close()
            await reading
            ends[str(client.closed_with)] += 1

    await asyncio.gather(*(attacker() for _ in range(16)))
    return f"{ammunition.used} sent; ends: {dict(ends)}"


async def unread(port: int, count: int) -> str:
    """Messages whose answers are never read."""
    client = await Client.websocket(port)
    ammunition = Ammunition(count, 15.0)
    message = frame(TEXT, b'{"type": "' + b"x" * 500 + b'"}')
    with suppress(asyncio.TimeoutError):
        while ammunition.take() and await asyncio.wait_for(client.send(message), 5.0):
            pass
    await client.close()
    return f"{ammunition.used} sent, none of the answers read"


async def storm(port: int, count: int) -> str:
    """Websockets that are opened and closed at once, 32 at a time."""
    ammunition, answers = Ammunition(count), Counter[str]()

    async def attacker() -> None:
        while ammunition.take():
            try:
                client = await Client.websocket(port)
                answers["opened"] += 1
                await client.close()
            except REFUSED as refusal:
                answers[str(refusal)] += 1

    await asyncio.gather(*(attacker() for _ in range(32)))
    return str(dict(answers))


async def knocks(port: int, count: int) -> str:
    """Connections that are closed before they say anything, 32 at a time."""
    ammunition, answers = Ammunition(count), Counter[str]()

    async def attacker() -> None:
        while ammunition.take():
            try:
                client = await asyncio.wait_for(Client.connect(port), PATIENCE)
                answers["opened"] += 1
                await client.close()
            except REFUSED as refusal:
                answers[type(refusal).__name__] += 1

    await asyncio.gather(*(attacker() for _ in range(32)))
    return str(dict(answers))


def requests(path: str) -> Callable[[int, int], Awaitable[str]]:
    """Return the attack that asks for one path in a loop, on eight connections."""

    async def attack(port: int, count: int) -> str:
        ammunition, answers = Ammunition(count), Counter[str]()

        async def attacker() -> None:
            client = None
            while ammunition.take():
                try:
                    client = client or await Client.connect(port)
                    status, head, body = await client.ask(request(port, path))
                    answers[str(status) if status == 200 else body.decode().strip()] += 1
                    if "connection: close" not in head.lower():
                        continue
                except REFUSED as end:
                    answers[type(end).__name__] += 1
                if client:
                    await client.close()
                client = None
            if client:
                await client.close()

        await asyncio.gather(*(attacker() for _ in range(8)))
        return str(dict(answers))

    attack.__doc__ = f"Requests for {path} in a loop, on eight connections."
    return attack


async def stalled(port: int, count: int) -> str:
    """Clients that stop in the middle: half of a request, or a websocket whose messages they never read."""
    clients, answers = [], Counter[str]()
    for index in range(count):
        try:
            client = await (Client.websocket(port) if index % 2 else Client.connect(port))
            if not index % 2:
                client.writer.write(request(port)[:40])
            clients.append(client)
            answers["connected"] += 1
        except REFUSED as refusal:
            answers[str(refusal)] += 1
    await asyncio.sleep(HELD)
    for client in clients:
        await client.close()
    return str(dict(answers))


async def downloads(port: int, count: int) -> str:
    """Clients that ask for the animation and never read it."""
    clients = []
    for _ in range(count):
        with suppress(OSError):
            client = await Client.connect(port)
            client.writer.transport.pause_reading()
            client.writer.write(request(port, "/api/animation.html"))
            clients.append(client)
            await asyncio.sleep(0.05)
    await asyncio.sleep(HELD)
    for client in clients:
        client.writer.transport.abort()
    return f"{len(clients)} asked"


async def large(port: int, count: int) -> str:
    """Messages, fragments, bodies and heads of 100 MB."""
    block = b"x" * 1_000_000
    taken = Counter[str]()

    async def pour(name: str, begin: bytes, block: bytes, websocket: bool) -> None:
        client = await (Client.websocket if websocket else Client.connect)(port)
        taken[name] += 0
        reading = asyncio.create_task(client.reader.read(-1) if not websocket else client.read_to_the_end())
        with suppress(OSError, asyncio.TimeoutError):
            await client.send(begin)
            for _ in range(100):
                if not await asyncio.wait_for(client.send(block), 5.0):
                    break
                taken[name] += len(block)
        await client.close()
        with suppress(OSError):
            await reading

    for _ in range(count):
        host = f"Host: 127.0.0.1:{port}\r\n".encode()
        await pour("message", frame(TEXT, b"", length=100_000_000), block, True)
        await pour("fragments", frame(TEXT, b"", final=False), frame(0, b"x" * 60_000, final=False) * 16, True)
        await pour("body", b"POST / HTTP/1.1\r\n" + host + b"Content-Length: 100000000\r\n\r\n", block, False)
        await pour("chunks", b"POST / HTTP/1.1\r\n" + host + b"Transfer-Encoding: chunked\r\n\r\n",
                   b"f4240\r\n" + block + b"\r\n", False)  # fmt: skip
        await pour("head", b"GET / HTTP/1.1\r\n" + host + b"Cookie: ", block, False)
    return ", ".join(f"{name}: {size / 1e6 / count:.1f} MB sent" for name, size in taken.items())


async def empty(port: int, count: int) -> str:
    """Pings, pongs and fragments without content, on eight connections."""

    kinds = [
        (b"", frame(PING, b"")),
        (b"", frame(PONG, b"")),
        (frame(TEXT, b"", final=False), frame(0, b"", final=False)),
        (b"", frame(TEXT, b"")),
    ]

    async def attacker(begin: bytes, block: bytes) -> str:
        client = await Client.websocket(port)
        reading = asyncio.create_task(client.read_to_the_end())
        sent = await client.send(begin) - 1
        while sent < count // 8 and await client.send(block * 1000):
            sent += 1000
        await client.send(frame(0, b"") + frame(CLOSE, b""))  # the server answers when it has read all
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(asyncio.shield(reading), 20.0)
        await client.close()
        await reading
        return f"{sent} sent, closed with {client.closed_with}"

    return "; ".join(await asyncio.gather(*(attacker(*kinds[k % 4]) for k in range(8))))


async def fragments(port: int, count: int) -> str:
    """Fragments without content, on 48 connections: a message that never ends and never grows."""
    ammunition, ends = Ammunition(count, 20.0), Counter[str]()

    async def attacker() -> None:
        client = await Client.websocket(port)
        reading = asyncio.create_task(client.read_to_the_end())
        block = frame(0, b"", final=False) * 1000
        with suppress(asyncio.TimeoutError):
            going = await client.send(frame(TEXT, b"", final=False))
            while going and ammunition.take(1000):
                going = await asyncio.wait_for(client.send(block), 5.0)
        client.writer.transport.abort()
        await reading
        ends[str(client.closed_with)] += 1

    await asyncio.gather(*(attacker() for _ in range(48)))
    return f"{ammunition.used} sent; ends: {dict(ends)}"


async def trickle(port: int, count: int) -> str:
    """Requests whose long heads come byte by byte, on 48 connections."""
    ammunition, ends = Ammunition(count, 20.0), Counter[str]()

    async def attacker() -> None:
        while ammunition.take(0):
            client = await Client.connect(port)
            client.writer.write(request(port, X="x" * 60_000)[:60_000])
            with suppress(*REFUSED):
                while ammunition.take() and await client.send(b"x"):
                    await asyncio.sleep(0)
            ends["closed" if ammunition.take(0) else "open"] += 1
            client.writer.transport.abort()

    await asyncio.gather(*(attacker() for _ in range(48)))
    return f"{ammunition.used} sent; ends: {dict(ends)}"


async def crowd(port: int, count: int) -> str:
    """Requests for the state in a loop, on a connection from each of a hundred addresses."""
    ammunition, answers = Ammunition(count, 20.0), Counter[str]()

    async def attacker(address: str) -> None:
        client = await Client.connect(port, address)
        with suppress(*REFUSED):
            while ammunition.take():
                status, _, body = await client.ask(request(port, "/api/state"))
                answers[str(status) if status == 200 else body.decode().strip()] += 1
        await client.close()

    await asyncio.gather(*(attacker(f"127.0.1.{k + 1}") for k in range(100)))
    return str(dict(answers))


async def bystander(port: int, count: int) -> str:
    """No attack: a loop that keeps this process as busy as the attacks do, to tell what the machine itself costs."""
    until = time.perf_counter() + count
    while time.perf_counter() < until:
        sum(range(20_000))
        await asyncio.sleep(0)
    return "the server was left alone"


HOSTS = (
    *("evil.example", "127.0.0.1.evil.example", "127.0.0.1:7007;script-src *", "127.0.0.1:1 ws://evil.example", "a b"),
    *(
        "[",
        "[::1",
        "[::1]]",
        "[::1]x",
        "[::]",
        "localhost/../evil",
        "localhost?evil",
        "localhost#evil",
        "evil@localhost",
    ),
    *("localhost:", "localhost:99999999", "localhost:-1", "localhost:1:2", "localhost,evil.example", "localhost'", "."),
    *("", " ", "x" * 50_000, "localhost:" + "1" * 5000, "0.0.0.0", "127.1", "2130706433", "0x7f.1", "127.0.0.1%00"),
    *("localhost\tx", "l\u00f6calhost"),
)
"""Names by which nobody may address a server that listens on the loopback."""
ORIGINS = ("http://evil.example", "null", "file://", "http://127.0.0.1:1", "https://127.0.0.1.evil.example", "x" * 5000)


async def strangers(port: int, count: int) -> str:
    """Hostile Hosts, Origins and paths; whatever is answered with more than a refusal is counted as let in."""
    rng, answers = random.Random(0), Counter[str]()
    words = (
        "..",
        "%2e%2e",
        "%2f",
        "/",
        "\\",
        "%00",
        "etc",
        "passwd",
        "page",
        "main.js",
        "server.py",
        "meshcat",
        ";",
        "?x",
    )
    for index in range(count):
        ask = (
            request(port, rng.choice(("/", "/ws", "/api/state")), Host=rng.choice(HOSTS)),
            request(port, Origin=rng.choice(ORIGINS)),
            request(port, "/" + "/".join(rng.choices(words, k=rng.randrange(1, 8)))),
        )[index % 3]
        client = await Client.connect(port)
        try:
            status, _, _ = await client.ask(ask)
            answers[f"{index % 3}: {status}"] += 1
        except REFUSED as end:
            answers[f"{index % 3}: {type(end).__name__}"] += 1
        await client.close()
    return f"Hosts (0), Origins (1) and paths (2): {dict(sorted(answers.items()))}"


Attack = Callable[[int, int], Awaitable[str]]
ATTACKS: dict[str, tuple[Attack, int]] = {
    "malformed": (malformed, 50_000),
    "persistent": (persistent, 100_000),
    "unread": (unread, 200_000),
    "storm": (storm, 3_000),
    "knocks": (knocks, 30_000),
    "animation": (requests("/api/animation.html"), 200),
    "glb": (requests("/api/animation.glb"), 200),
    "state": (requests("/api/state"), 5_000),
    "files": (requests("/meshcat/main.min.js"), 1_000),
    "stalled": (stalled, 200),
    "downloads": (downloads, 60),
    "large": (large, 5),
    "empty": (empty, 2_000_000),
    "strangers": (strangers, 3_000),
    "fragments": (fragments, 20_000_000),
    "trickle": (trickle, 200_000),
    "crowd": (crowd, 10_000),
    "bystander": (bystander, 10),
}
"""Name → attack, and its full size."""


async def judge(name: str, scale: float, pid: int, port: int) -> None:
    """Run one attack beside a good client, and print a line."""
    attack, size = ATTACKS[name]
    async with watching(port) as good:
        await good.next_step()
        await asyncio.sleep(WATCHED_ALONE)
        alone, since, before, peak = good.pace(), len(good.seen) - 1, megabytes(pid), 0.0
        began, spent = time.perf_counter(), processor_seconds(pid)
        running = asyncio.create_task(attack(port, max(1, round(scale * size))))  # type: ignore[arg-type]
        slowest, last = float("inf"), good.seen[-1]
        while not running.done():
            await asyncio.wait([running], timeout=1.0)
            peak = max(peak, megabytes(pid))
            if (now := good.seen[-1])[0] - last[0] > 0.8:
                slowest, last = min(slowest, (now[1] - last[1]) / (now[0] - last[0])), now
        answer = await running
        await good.next_step()
        seconds = time.perf_counter() - began
        share = (processor_seconds(pid) - spent) / seconds
        print(f"{name:10} {seconds:6.1f} s   steps/s: {alone:5.1f} alone, {good.pace(since):5.1f} attacked, "
              f"{slowest:5.1f} at worst   MB: {before:6.1f} before, {peak:6.1f} at most, {megabytes(pid):6.1f} after   "
              f"processor {100 * share:3.0f} %\n{'':10} {answer}", flush=True)  # fmt: skip


async def soak(minutes: float, pid: int, port: int, every: float = 60.0) -> None:
    """Watch for long, and print memory and times each minute."""
    async with watching(port) as good:
        await good.next_step()
        began = time.perf_counter()
        while time.perf_counter() - began < 60.0 * minutes:
            since, spent = len(good.seen) - 1, processor_seconds(pid)
            await asyncio.sleep(every)
            steps = good.seen[-1][1] - good.seen[since][1]
            solvers = sum(one["statistics"]["mean_time"] or 0.0 for one in good.state["instances"])
            each = (processor_seconds(pid) - spent) / steps
            print(f"minute {(time.perf_counter() - began) / 60:5.1f}   {megabytes(pid):7.2f} MB   "
                  f"{good.pace(since):5.2f} steps/s   a step: {1e3 * solvers:6.3f} ms of solving, "
                  f"{1e3 * each:6.3f} ms of the processor", flush=True)  # fmt: skip
            good.seen[:-1] = []


async def leave_alone(seconds: float, pid: int, port: int) -> None:
    """Measure a server that nobody watches, watches, and watches no longer."""

    async def share(words: str) -> None:
        spent, began = processor_seconds(pid), time.perf_counter()
        await asyncio.sleep(seconds)
        used = (processor_seconds(pid) - spent) / (time.perf_counter() - began)
        print(f"{words:28} {100 * used:5.1f} % of a core", flush=True)

    await asyncio.sleep(15.0)
    await share("nobody has watched yet")
    async with watching(port) as good:
        await good.next_step()
        await share("one client watches")
    await asyncio.sleep(15.0)
    await share("nobody watches any longer")


def main() -> None:
    """Do what was asked for, and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("attacks", nargs="*", metavar="ATTACK", help=f"some of {', '.join(ATTACKS)}; all by default")
    parser.add_argument("--scale", type=float, default=1.0, help="factor for the sizes of the attacks")
    parser.add_argument("--robot", default="arm")
    parser.add_argument("--soak", type=float, metavar="MINUTES", help="watch four lions at random motion instead")
    parser.add_argument("--idle", type=float, metavar="SECONDS", help="measure an idle server instead")
    arguments = parser.parse_args()
    unknown = set(arguments.attacks) - set(ATTACKS)
    if unknown:
        parser.error(f"there is no attack {', '.join(sorted(unknown))}; there are {', '.join(ATTACKS)}")
    if arguments.soak:
        with live("lion", "--motion", "random") as (pid, port):
            asyncio.run(soak(arguments.soak, pid, port))
    elif arguments.idle:
        with live(arguments.robot) as (pid, port):
            asyncio.run(leave_alone(arguments.idle, pid, port))
    else:
        for name in arguments.attacks or ATTACKS:
            with live(arguments.robot) as (pid, port):
                asyncio.run(judge(name, arguments.scale, pid, port))


if __name__ == "__main__":
    main()
