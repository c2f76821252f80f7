"""The server over real sockets: good and malformed messages, and who may connect."""

from __future__ import annotations

import asyncio
import base64
import csv
import importlib.metadata
import io
import json
import os
import re
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from base64 import b64encode

import numpy as np
import pytest
import tornado.httpclient
import tornado.websocket

import pinik
from glb_player import Player
from judge import plain_placement
from stand_ins import GOOD, PATIENCE, kind, no_number, read_frame
from urdf_texts import chain

ROUTES = ["/", "/meshcat/main.min.js", "/ws", "/api/state", "/api/statistics.csv"]
ROUTES += ["/api/animation.html"]


@pytest.fixture(scope="module")
def view(arm):
    with pinik.live(arm, ["dls", "ccd"], port=0, motion="random") as opened:
        yield opened


@pytest.fixture(autouse=True)
def _begin(request):
    """Reset the shared view after every test."""
    yield
    if "view" in request.fixturenames:
        view = request.getfixturevalue("view")
        view.send("setup", setup=BEGIN)
        view.send("reset")


CONVERGED = 1  # in the order of the statuses in `hello`
BEGIN = 'robot=arm&root=fixed&view=2&methods=dls,ccd&motion=random&run=on&balls=[["tip","on"]]'


class Page:
    """A websocket client that acknowledges frames as a page does, and keeps all messages."""

    def __init__(self, connection):
        self.connection = connection
        self.told = []
        self.is_open = True

    @classmethod
    async def open(cls, view, **headers):
        request = tornado.httpclient.HTTPRequest(f"ws://127.0.0.1:{view.port}/ws", headers=headers)
        return cls(await tornado.websocket.websocket_connect(request))

    async def read(self):
        message = await self._read()
        if message is not None:
            self.told.append(message)
            if kind(message) == "frame":
                await self.say("drawn", step=read_frame(message).step)
        return message

    async def _read(self):
        message = await asyncio.wait_for(self.connection.read_message(), PATIENCE)
        self.is_open = message is not None
        return message

    async def next(self, wanted, until=lambda message: True):
        """Return the next message of a kind for which `until` holds."""
        while True:
            message = await self.read()
            assert message is not None, "the server has closed the connection"
            if kind(message) == wanted:
                content = (
                    json.loads(message, parse_constant=no_number) if isinstance(message, str) else read_frame(message)
                )
                if until(content):
                    return content

    async def say(self, kind, **fields):
        await self.connection.write_message(json.dumps({"type": kind, **fields}))

    async def close(self):
        self.connection.close()
        await self.end()

    async def end(self):
        """Wait until the connection is closed by either side."""
        while self.is_open:
            await self._read()


def talk(view, conversation, pages=1, **headers):
    """Run `conversation(page, …)` with this many pages open."""

    async def held():
        opened = [await Page.open(view, **headers) for _ in range(pages)]
        try:
            return await asyncio.wait_for(conversation(*opened), PATIENCE)
        finally:
            for page in opened:
                await asyncio.wait_for(page.close(), PATIENCE)

    return asyncio.run(held())


def get(view, path, **headers):
    """(status, headers, body)"""
    request = urllib.request.Request(f"http://127.0.0.1:{view.port}{path}", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers, error.read()


def raw(view, text):
    """The first line of the answer to a request written by hand."""
    with socket.create_connection(("127.0.0.1", view.port), timeout=PATIENCE) as connection:
        connection.sendall(text.replace("\n", "\r\n").encode("latin-1"))
        with connection.makefile("rb") as answer:
            return answer.readline().decode("latin-1").strip()


# The websocket


def test_a_page_is_told_everything_in_order(view):
    async def conversation(page):
        await page.next("shapes")
        await page.next("frame")
        kinds = [kind(message) for message in page.told]
        assert kinds[:3] == ["hello", "robot", "state"]
        await page.next("state")

    talk(view, conversation)


def test_frames_follow_the_configurations(view):
    async def conversation(page):
        await page.say("run", on=False)
        stopped = (await page.next("state", lambda state: not state["running"]))["step"]
        await page.say("ball", index=0, position=[0.3, 0.1, 0.8])
        while True:
            await page.say("step")
            frame = await page.next("frame", lambda frame, last=stopped: frame.step > last)  # chases the new ball
            stopped = frame.step
            if all(block.status == CONVERGED for block in frame.blocks):
                return frame

    frame = talk(view, conversation)
    for block, q in zip(frame.blocks, view.configurations, strict=True):
        assert np.allclose(block.points[0], plain_placement(view.robot, "tip", q).translation, atol=1e-5)
        assert np.allclose(block.points[0], [0.3, 0.1, 0.8], atol=2e-4)


# What the state says of each message, once it is done; the fields are those of `GOOD`.
DONE = {
    "view": lambda s: s["view"] == len(s["instances"]) == 2,
    "method": lambda s: s["instances"][0]["method"] == "dls",
    "limits": lambda s: s["limits"] is False,
    "polish": lambda s: s["polish"] is True,
    "motion": lambda s: s["motion"] == "random",
    "curve": lambda s: s["curve"] == "knot",
    "speed": lambda s: s["speed"] == 2.5,
    "iterations": lambda s: s["iterations"] == {"until_reached": False, "at_most": 3},
    "tolerance": lambda s: s["tolerance"] == {"position": 0.01, "orientation": 0.1},
    "run": lambda s: s["running"] is True,
    "step": lambda s: s["step"] == 1,
    "reset": lambda s: s["step"] == 0,
    "ball": lambda s: s["balls"][0]["position"] == [0.1, 0.2, 0.3] and s["motion"] == "hand",
    "free": lambda s: s["balls"][0]["free"] == "xy",
    "ball_tolerance": lambda s: s["balls"][0]["tolerance"] == [[0.01, 0.01, 0.1], 0.3],
    "orientation": lambda s: s["balls"][0]["oriented"] and s["balls"][0]["rpy"] == [0.1, 0.2, 0.3],
    "effector": lambda s: s["balls"][0]["mode"] == "pinned",
    "add_effector": lambda s: [b["frame"] for b in s["balls"]] == ["tip", "bone3"],
    "remove_effector": lambda s: [b["frame"] for b in s["balls"]] == ["tip"],
    "parameter": lambda s: {p["name"]: p["value"] for p in s["instances"][0]["parameters"]}["damping"] == 0.3,
    "setup": lambda s: (s["view"], s["motion"], s["curve"]) == (1, "curve", "wave"),
    "robot": lambda s: (
        (s["robot"], s["root"], s["loading"], s["generation"]) == ("two_link", "planar", None, s["generation"])
    ),
}
# What makes none of this true beforehand.
BEFORE = {
    "view": [("view", {"count": 1})],
    "method": [("method", {"instance": 0, "method": "jt"})],
    "motion": [("motion", {"motion": "hand"})],
    "run": [("run", {"on": False})],
    "step": [("run", {"on": False}), ("reset", {})],
    "reset": [("step", {})],
    "remove_effector": [("add_effector", {"frame": "bone3"})],
}
MORE = {
    "setup": {"setup": "#view=1&motion=curve&curve=wave"},
    "robot": {"name": "two_link", "root": "planar"},
    "parameter": {"instance": 0, "name": "damping", "value": 0.3},
}


@pytest.mark.parametrize("message", list(DONE))
def test_every_message_works_over_the_websocket(view, message):
    """Two pages receive the new state."""

    async def conversation(page, other):
        await page.say(message, **MORE.get(message, GOOD.get(message, ({},))[0]))
        for one in (page, other):
            state = await one.next("state", DONE[message])
            assert state["setup"].startswith(f"robot={state['robot']}&")
        assert not any(kind(told) == "error" for told in page.told)

    for name, fields in BEFORE.get(message, []):
        view.send(name, **fields)
    assert not DONE[message](view.state)
    talk(view, conversation, pages=2)


def test_bad_messages_are_answered_and_nothing_ends(view):
    bad = [
        "",
        "hello",
        "{}",
        "[]",
        "[" * 900 + "]" * 900,
        "[" * 30_000,
        '{"type": "speed", "value": NaN}',
        '{"type": "speed", "value": 1e999}',
        '{"type": "ball", "index": 0, "position": [1e300, 0, 0]}',
        '{"type": "method", "instance": 0, "method": "os:system"}',
        '{"type": "robot", "name": "/etc/passwd", "root": "fixed"}',
        '{"type": "' + "x" * 60_000 + '"}',
        '{"type": "\\ud800"}',
        '{"type": "drawn"}',
        '{"type": "setup", "setup": "' + "x" * 30_000 + '"}',
        b"",
        b"\x00\xff\xfe",
        b"PNKF" + b"\x00" * 100,
        json.dumps({"type": "view", "count": 1}).encode(),  # JSON, but not as text
    ]

    async def conversation(page, other):
        for message in bad:
            await page.connection.write_message(message, binary=isinstance(message, bytes))
            assert len((await page.next("error"))["message"]) > 10
        await page.say("view", count=1)
        await page.next("state", lambda state: state["view"] == 1)
        await other.next("state", lambda state: state["view"] == 1)
        assert not any(kind(told) == "error" for told in other.told)

    talk(view, conversation, pages=2)


def test_text_that_is_no_unicode_and_frames_that_are_none_end_that_page_alone(view):
    async def conversation(other):
        for garbage in (b"\x81\x82\x00\x00\x00\x00\xff\xfe", b"\xff" * 200, b"GET / HTTP/1.1\r\n\r\n"):
            reader, writer = await asyncio.open_connection("127.0.0.1", view.port)
            writer.write(handshake(view))
            await reader.readuntil(b"\r\n\r\n")
            writer.write(garbage)
            writer.write_eof()
            await asyncio.wait_for(reader.read(), PATIENCE)
            writer.close()
            await writer.wait_closed()
        await other.say("view", count=4)
        await other.next("state", lambda state: state["view"] == 4)

    talk(view, conversation)


def test_a_message_that_is_too_long_closes_that_page_alone(view):
    async def conversation(page, other):
        await page.connection.write_message('{"type": "setup", "setup": "' + "x" * 70_000 + '"}')
        await page.end()
        await other.say("view", count=4)
        await other.next("state", lambda state: state["view"] == 4)

    talk(view, conversation, pages=2)


def test_a_page_comes_back(view):
    for count in (1, 4):

        async def conversation(page, count=count):
            await page.say("view", count=count)
            await page.next("state", lambda state: state["view"] == count)

        talk(view, conversation)

    async def returned(page):
        assert (await page.next("state"))["view"] == 4

    talk(view, returned)


def test_many_pages_agree(view):
    async def conversation(*pages):
        await pages[0].say("ball", index=0, position=[0.2, 0.3, 0.7])
        await pages[1].say("run", on=False)
        steps = set()
        for page in pages:
            state = await page.next("state", lambda state: not state["running"])
            assert state["balls"][0]["position"] == [0.2, 0.3, 0.7]
            steps.add(json.dumps(state["instances"]))
        assert len(steps) == 1

    talk(view, conversation, pages=5)


def handshake(view, path="/ws", **headers):
    fields = {
        "Host": f"127.0.0.1:{view.port}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Key": b64encode(bytes(16)).decode(),
        "Sec-WebSocket-Version": "13",
        **{name.replace("_", "-"): value for name, value in headers.items()},
    }
    lines = [f"GET {path} HTTP/1.1", *(f"{name}: {value}" for name, value in fields.items())]
    return ("\r\n".join(lines) + "\r\n\r\n").encode()


def test_a_page_that_never_reads_stops_nobody_and_queues_nothing(arm):
    with pinik.live(arm, port=0) as view, socket.socket() as mute:
        mute.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        mute.connect(("127.0.0.1", view.port))
        mute.sendall(handshake(view))

        def queued():
            """The number of bytes that wait in the server for the page that never reads."""
            return max(len(tab.ws_connection.stream._write_buffer) for tab in view._show._seats._seats)

        async def conversation(page):
            await page.next("shapes")
            begun = (await page.next("frame")).step
            early = view._do(queued)
            await page.next("frame", lambda frame: frame.step > begun + 90)
            assert view._do(lambda: len(view._show._seats)) == 2
            assert view._do(queued) <= early + 2 * 2000  # two frames
            assert view._do(lambda: max(seat.under_way for seat in view._show._seats._seats.values())) <= 2

        talk(view, conversation)


# Who may not


def test_a_page_from_elsewhere_is_turned_away(view):
    for origin in ("http://evil.example", "https://127.0.0.1.evil.example", "http://127.0.0.1:1", "null", "file://"):
        assert raw(view, handshake(view, Origin=origin).decode().replace("\r\n", "\n")).startswith("HTTP/1.1 403")
    own = f"http://127.0.0.1:{view.port}"
    assert raw(view, handshake(view, Origin=own).decode().replace("\r\n", "\n")).startswith("HTTP/1.1 101")

    async def conversation(page):
        await page.next("frame")

    talk(view, conversation, Origin=own)


@pytest.mark.parametrize("route", ROUTES)
def test_a_foreign_name_of_this_server_is_turned_away_on_every_route(view, route):
    """A page of evil.example whose name suddenly resolves to 127.0.0.1."""
    for host in (
        "evil.example",
        f"evil.example:{view.port}",
        "127.0.0.1.evil.example",
        "0.0.0.0",
        "[::]",
        "8.8.8.8",
        "a b",
        "[",
    ):
        request = handshake(view, route, Host=host, Origin=f"http://{host}")
        if route != "/ws":
            request = f"GET {route} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode("latin-1")
        answer = raw(view, request.decode("latin-1").replace("\r\n", "\n"))
        assert re.match(r"HTTP/1.1 40[03] ", answer), (host, answer)
    assert get(view, "/api/state", Host="evil.example")[0] == 403


def test_the_loopbacks_own_names_are_welcome(view):
    for host in ("localhost", f"localhost:{view.port}", "127.0.0.1", f"[::1]:{view.port}", "LOCALHOST"):
        assert get(view, "/api/state", Host=host)[0] == 200


@pytest.mark.parametrize(
    "path",
    [
        "/page/main.js",
        "/index.html",
        "/main.js",
        "/../server.py",
        "/..%2fserver.py",
        "/meshcat/../index.html",
        "/meshcat/..%2f..%2fsetup.py",
        "/meshcat/%2e%2e%2f__init__.py",
        "/meshcat//etc/passwd",
        "/meshcat/../../../../../../etc/passwd",
        "/meshcat/main.min.js/",
        "/meshcat/main.min.js%00.js",
        "/meshcat/index.html",
        "/meshcat/%2e%2e/index.html",
        "/meshcat/main.min.js/../../index.html",
        "/meshcat/",
        "/etc/passwd",
        "//etc/passwd",
        "/api/",
        "/api/state/",
        "/favicon.ico",
    ],
)
def test_there_is_nothing_beside_the_pages_own_files(view, path):
    answer = raw(view, f"GET {path} HTTP/1.1\nHost: 127.0.0.1\nConnection: close\n\n")
    assert answer.startswith("HTTP/1.1 404"), answer


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH"])
def test_nothing_is_written_over_http(view, method):
    for route in ROUTES:
        answer = raw(view, f"{method} {route} HTTP/1.1\nHost: 127.0.0.1\nContent-Length: 0\nConnection: close\n\n")
        assert answer.startswith("HTTP/1.1 405"), (route, answer)


def test_another_address_of_this_machine_is_not_listened_on(view):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends nothing; the kernel chooses the address that it would send from
            address = probe.getsockname()[0]
        except OSError:
            address = "127.0.0.2"
    if address.startswith("127.0.0.1"):
        address = "127.0.0.2"
    with socket.socket() as outside:
        outside.settimeout(PATIENCE)
        with pytest.raises(ConnectionRefusedError):
            outside.connect((address, view.port))


# What is there


def test_the_state_over_http_is_that_of_the_websocket(view):
    async def conversation(page):
        await page.say("run", on=False)
        return await page.next("state", lambda state: not state["running"])

    told = talk(view, conversation)
    status, headers, body = get(view, "/api/state")
    assert (status, headers["Content-Type"]) == (200, "application/json")
    assert json.loads(body, parse_constant=no_number) == told == view.state


def test_the_table_is_csv(view):
    def rows():
        status, headers, body = get(view, "/api/statistics.csv")
        assert (status, headers["Content-Type"]) == (200, "text/csv; charset=utf-8")
        assert headers["Content-Disposition"] == 'attachment; filename="pinik-statistics.csv"'
        return list(csv.DictReader(io.StringIO(body.decode())))

    view.send("run", on=False)
    view.send("step")
    found = rows()
    assert [row["method"] for row in found] == ["dls", "ccd"]
    for row, one in zip(found, view.state["instances"], strict=True):
        assert int(row["steps"]) == one["statistics"]["steps"] > 0
        assert float(row["mean_error_m"]) == one["statistics"]["mean_error"]


def test_headers_keep_strangers_out(view):
    for route in ("/api/state", "/meshcat/main.min.js", "/api/statistics.csv"):
        status, headers, _ = get(view, route)
        assert (status, headers["X-Content-Type-Options"], headers["Referrer-Policy"]) == (
            200,
            "nosniff",
            "no-referrer",
        )
        assert "Access-Control-Allow-Origin" not in headers
        assert "Server" not in headers


def test_meshcats_viewer_comes_from_the_installed_package(view):
    script = next(file for file in importlib.metadata.files("meshcat") if file.match("viewer/dist/main.min.js"))
    _, headers, body = get(view, "/meshcat/main.min.js")
    assert body == script.read_binary()
    assert "javascript" in headers["Content-Type"]


def test_only_one_port_is_opened_and_no_zeromq():
    script = """
import json, os, pathlib, sys, urllib.request, pinik
with pinik.live("arm", port=0) as view:
    urllib.request.urlopen(view.url + "api/state", timeout=150).read()
    numbers = os.listdir("/proc/self/fd") if os.path.isdir("/proc/self/fd") else []
    links = [f"/proc/self/fd/{number}" for number in numbers]
    own = {os.readlink(link) for link in links if os.path.islink(link)}
    listening = []
    for table in ("tcp", "tcp6", "udp", "udp6") if own else ():
        for line in pathlib.Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            fields = line.split()
            if f"socket:[{fields[9]}]" in own and fields[3] in ("0A", "07"):
                listening.append((table, fields[1]))
    print(json.dumps([view.port, listening, sorted({"zmq", "meshcat", "IPython"} & set(sys.modules))]))
"""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
    )
    port, listening, heavy = json.loads(done.stdout)
    if os.path.exists("/proc/net/tcp"):
        assert listening == [["tcp", f"0100007F:{port:04X}"]]
    assert heavy == []
    assert done.stderr == ""


def test_the_page_has_a_policy_that_runs_its_own_scripts_alone(view):
    nonces = []
    for _ in range(2):
        status, headers, body = get(view, "/")
        assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
        policy = dict(part.split(" ", 1) for part in headers["Content-Security-Policy"].split("; "))
        nonces.append(re.search(r"'nonce-([\w-]{16,})'", policy["script-src"])[1])
        assert policy["script-src"] == f"'nonce-{nonces[-1]}'"
        assert policy["default-src"] == "'self'"
        assert f"ws://127.0.0.1:{view.port}" in policy["connect-src"].split()
        page = body.decode()
        assert "{{" not in page
        for script in re.findall(r"<script\b[^>]*>", page):
            assert nonces[-1] in script, script
    assert nonces[0] != nonces[1]


@pytest.mark.parametrize(
    ("host", "own"),
    [
        ("localhost", []),
        ("127.0.0.1", []),
        ("[::1]", []),  # policies know no such addresses, and chromium complains of one
        ("192.168.1.20", ["http://192.168.1.20:*", "https://192.168.1.20:*"]),
        ("desk.local", ["http://desk.local:*", "https://desk.local:*"]),
    ],
)
def test_only_pages_of_its_own_machine_may_frame_the_page(two_link, host, own, monkeypatch):
    monkeypatch.setattr(socket, "gethostname", lambda: "Desk.local")
    with pinik.live(two_link, port=0, host="0.0.0.0", running=False) as view:
        status, headers, _ = get(view, "/", Host=f"{host}:{view.port}")
    policy = dict(part.split(" ", 1) for part in headers["Content-Security-Policy"].split("; "))
    local = [f"{scheme}://{name}:*" for name in ("localhost", "127.0.0.1") for scheme in ("http", "https")]
    assert status == 200
    assert policy["frame-ancestors"].split() == ["'self'", *local, *own, "vscode-webview:", "vscode-file:"]


def test_the_page_comes_with_all_that_it_needs_but_meshcats_viewer(view):
    page = get(view, "/")[2].decode()
    named = set(re.findall(r'(?:src|href)="([^"#][^"]*)"', page))
    fetched = {name for name in named if not name.startswith(("data:", "/api/"))}  # downloads are for later
    assert fetched == {"/meshcat/main.min.js"}
    assert get(view, "/meshcat/main.min.js")[0] == 200
    modules = json.loads(re.search(r'<script[^>]* type="importmap">(.*?)</script>', page)[1])["imports"]
    imported = {"pinik/main.js"}
    kind = "data:text/javascript;base64,"
    for url in modules.values():
        text = base64.b64decode(url.removeprefix(kind)).decode()
        imported |= set(re.findall(r'^(?:import|export) .* from "([^"]+)";$', text, re.MULTILINE))
    assert imported <= set(modules)
    assert ".stage" in page[page.index("<style>") : page.index("</style>")]


def test_the_animation_is_a_page_to_keep(view):
    while len(view._show.recording) < 3:
        view.send("step")
    status, headers, body = get(view, "/api/animation.html")
    assert (status, headers["Content-Disposition"]) == (200, 'attachment; filename="pinik-animation.html"')
    document = re.search(
        r'<script type="application/json" id="recording"[^>]*>(.*?)</script>', body.decode(), re.DOTALL
    )
    content = json.loads(document[1])
    assert content["frame_bytes"] > 0
    assert content["state"]["robot"] == "arm"


def test_the_animation_is_a_glb_file_too(view, tmp_path):
    for _ in range(20):
        view.send("step")
    status, headers, body = get(view, "/api/animation.glb")
    assert (status, headers["Content-Type"]) == (200, "model/gltf-binary")
    assert headers["Content-Disposition"] == 'attachment; filename="pinik-animation.glb"'
    (tmp_path / "view.glb").write_bytes(body)
    played = Player(tmp_path / "view.glb")
    assert played.duration > 0.3
    for name in (instance["method"] for instance in view.state["instances"][: view.state["view"]]):
        assert {f"{name} tip", f"{name} ball tip", f"{name} name"} <= set(played.names)


def test_a_robot_without_shapes_has_no_glb_file():
    with pinik.live(pinik.load(chain(3, "revolute")), port=0, running=False) as bare:
        status, _, body = get(bare, "/api/animation.glb")
    assert (status, body) == (404, b"404 The robot has no shapes that can be read\n")
