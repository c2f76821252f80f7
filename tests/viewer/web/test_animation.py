"""The saved animation: everything is in one file, and a browser plays it."""

from __future__ import annotations

import base64
import json
import math
import re
import zlib
from html.parser import HTMLParser

import numpy as np
import pytest

from desk import need_browser
from page_fixtures import new_context
from pinik.viewer.protocol.recording import Recording
from pinik.viewer.protocol.robot_message import robot_message
from pinik.viewer.simulation.session import Session
from pinik.viewer.web import document
from pinik.viewer.web.animation import animation_page
from pinik.viewer.web.scene import Shapes, make_shapes
from pinik.viewer.web.show import Show
from stand_ins import Clock, recorded, small_frame

# A stand-in for the page: like the real one, with a module that writes what it found into the title.
PLAYER_HTML = """<!DOCTYPE html>
<html><head><meta charset="utf-8"><title>{{title}}</title><style>{{stage.css}}{{style.css}}</style>
<script type="importmap">{{importmap}}</script>
<script>{{meshcat}}</script>
<script type="application/json" id="recording">{{recording}}</script>
</head><body><script type="module">import "pinik/player.js";</script></body></html>
"""
PLAYER_JS = """
import { told } from "pinik/words.js";
const recording = JSON.parse(document.getElementById("recording").textContent);
const viewer = new MeshCat.Viewer(document.body);
const packed = Uint8Array.from(atob(recording.commands), (c) => c.charCodeAt(0));
const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
const all = new Uint8Array(await new Response(stream).arrayBuffer());
let end = 0;
for (const length of recording.command_bytes) viewer.handle_command_bytearray(all.slice(end, (end += length)));
const found = recording.shapes.parts.map(({ link, path }) => {
    let mesh = null;
    viewer.scene_tree.find(path.split("/").filter(Boolean)).object.traverse((o) => { if (o.isMesh) mesh = o; });
    mesh.geometry.computeBoundingBox();
    const { position, normal } = mesh.geometry.attributes;
    return {
        link, triangles: mesh.geometry.index.count / 3, vertices: position.count, normals: normal.count,
        box: [mesh.geometry.boundingBox.min.toArray(), mesh.geometry.boundingBox.max.toArray()],
        material: mesh.material.type, color: mesh.material.color.getHex(), opacity: mesh.material.opacity,
        transparent: mesh.material.transparent, vertexColors: mesh.material.vertexColors,
    };
});
document.title = told({ name: recording.robot.name, bytes: recording.frame_bytes, found });
"""
WORDS_JS = """
// {{title}} and {{recording}} stand in other files' places only; so does </script><!-- <script>.
export const told = JSON.stringify;
"""
AWKWARD = "</script><!-- <script>{{style.css}} & \u2028 ü"


@pytest.fixture
def page(tmp_path):
    folder = tmp_path / "page"
    folder.mkdir()
    for name, text in {
        "player.html": PLAYER_HTML,
        "player.js": PLAYER_JS,
        "words.js": WORDS_JS,
        "stage.css": ".stage { color: red }",
        "style.css": "body > p::after { content: '{{meshcat}}'; }",
        "index.html": "<p>another page</p>",
    }.items():
        (folder / name).write_text(text, "utf-8")
    return folder


class Scripts(HTMLParser):
    """The scripts, the style and the title of a page, found by an HTML parser."""

    def __init__(self, text):
        super().__init__()
        self.found, self._inside = [], None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        if tag in ("script", "style", "title"):
            self._inside = [tag, dict(attrs), ""]
            self.found.append(self._inside)

    def handle_endtag(self, tag):
        self._inside = None

    def handle_data(self, data):
        if self._inside:
            self._inside[2] += data


def content(html, tag, **attributes):
    ((_, _, text),) = [each for each in Scripts(html).found if each[0] == tag and attributes.items() <= each[1].items()]
    return text


def inflated(text):
    return zlib.decompress(base64.b64decode(text), -zlib.MAX_WBITS)


def unpacked(text, frame_bytes):
    """The frames, read byte by byte as the documentation says."""
    data = inflated(text)
    count, columns = len(data) // 4, frame_bytes // 4
    frames = len(data) // frame_bytes
    found = [[0] * columns for _ in range(frames)]
    for column in range(columns):
        number = 0
        for frame in range(frames):
            change = bytes(data[plane * count + column * frames + frame] for plane in range(4))
            number = (number + int.from_bytes(change, "little")) % 2**32
            found[frame][column] = number
    return b"".join(number.to_bytes(4, "little") for frame in found for number in frame)


def messages(robot):
    return {"type": "hello", "words": AWKWARD}, robot_message(robot, 5), {"type": "state", "message": AWKWARD}


def test_the_page_holds_all_that_is_played(two_link, page):
    hello, robot, state = messages(two_link)
    robot["name"] = AWKWARD
    shapes = Shapes(((0, "/pinik/shapes/0/0"),), (b"\x83\xff\x00",), ("a </script> is left out",))
    recording = recorded(small_frame(k) for k in range(4))
    html = animation_page(hello, robot, shapes, state, recording, page).decode()
    document = json.loads(content(html, "script", id="recording"))
    assert {key: document.pop(key) for key in ("hello", "robot", "state")} == {
        "hello": hello,
        "robot": robot,
        "state": state,
    }
    assert unpacked(document.pop("frames"), len(small_frame(0))) == small_frame(0) + small_frame(2)
    assert inflated(document.pop("commands")) == b"\x83\xff\x00"
    assert document == {
        "shapes": {
            "type": "shapes",
            "generation": 5,
            "warnings": ["a </script> is left out"],
            "parts": [{"link": 0, "path": "/pinik/shapes/0/0"}],
        },
        "command_bytes": [3],
        "frame_bytes": len(small_frame(0)),
        "frames_per_second": 30,
    }
    assert content(html, "title") == f"{AWKWARD} – pinik"
    assert content(html, "style") == "".join((page / name).read_text() for name in ("stage.css", "style.css"))
    modules = json.loads(content(html, "script", type="importmap"))["imports"]
    kind = "data:text/javascript;base64,"
    assert {name: base64.b64decode(url.removeprefix(kind)).decode() for name, url in modules.items()} == {
        "pinik/player.js": f"{PLAYER_JS}\n//# sourceURL=pinik/player.js\n",
        "pinik/words.js": f"{WORDS_JS}\n//# sourceURL=pinik/words.js\n",
    }


def test_nothing_is_left_to_be_fetched(two_link, page):
    hello, robot, state = messages(two_link)
    html = animation_page(hello, robot, Shapes((), (), ()), state, Recording(), page).decode()
    assert [attributes for _, attributes, _ in Scripts(html).found if {"src", "href"} & set(attributes)] == []


def test_meshcats_script_cannot_end_its_element(two_link, page, tmp_path, monkeypatch):
    script = tmp_path / "main.min.js"
    script.write_text('const a = "</SCRIPT><p>", b = "<!--<script>", c = a < b, d = "</div>";', "utf-8")
    monkeypatch.setattr(document, "meshcat_script", lambda: script)
    hello, robot, state = messages(two_link)
    html = animation_page(hello, robot, Shapes((), (), ()), state, Recording(), page).decode()
    (text,) = [each[2] for each in Scripts(html).found if each[0] == "script" and not each[1]]
    assert text == r'const a = "\x3c/SCRIPT><p>", b = "\x3c!--\x3cscript>", c = a < b, d = "</div>";'


def test_numbers_that_are_no_json_are_refused(two_link, page):
    hello, robot, state = messages(two_link)
    state["position_error"] = math.nan
    with pytest.raises(ValueError, match="JSON"):
        animation_page(hello, robot, Shapes((), (), ()), state, Recording(), page)


@pytest.fixture
def tab(browser):
    """A browser page whose `faults` are errors and requests to a server."""
    context = new_context(browser)
    opened = context.new_page()
    opened.faults = []
    opened.on("pageerror", lambda error: opened.faults.append(str(error)))
    opened.on("console", lambda line: opened.faults.append(line.text) if line.type == "error" else None)
    opened.on("request", lambda request: opened.faults.append(request.url) if is_fetched(request.url) else None)
    yield opened
    context.close()


def is_fetched(url):
    return not url.startswith(("file:", "data:", "blob:"))


def test_a_browser_plays_the_file_with_meshcats_own_viewer(panda, page, tmp_path, tab):
    hello, robot, state = messages(panda)
    shapes = make_shapes(panda)
    recording = recorded(small_frame(k, generation=5, joints=10) for k in range(4))
    file = tmp_path / "animation.html"
    file.write_bytes(animation_page(hello, robot, shapes, state, recording, page))
    tab.goto(file.as_uri())
    tab.wait_for_function("document.title.startsWith('{')")
    told = json.loads(tab.title())
    assert tab.faults == []
    assert (told["name"], told["bytes"]) == ("panda", len(small_frame(0, joints=10)))
    assert [each["link"] for each in told["found"]] == [link for link, _ in shapes.parts]
    assert sum(each["triangles"] for each in told["found"]) > 100_000
    base = [each["box"] for each in told["found"] if each["link"] == 0]
    assert np.min([low for low, _ in base], axis=0)[2] == pytest.approx(0, abs=0.01)
    for each in told["found"]:
        assert each["vertices"] == each["normals"] > 0
        assert each["material"] == "MeshStandardMaterial"
        assert (each["opacity"], each["transparent"], each["vertexColors"]) == (1, False, False)
    assert len({each["color"] for each in told["found"]}) >= 4


@pytest.fixture
def saved(two_link, tmp_path):
    """A file with one second of a session: 30 frames."""
    session = Session(two_link, view=2)
    session.set_motion("curve")
    session.running = True
    clock = Clock()
    show = Show(session, later=lambda work, then: then(work()), clock=clock)
    for step in range(60):
        clock.now = step / 60
        show.tick()
    file = tmp_path / "animation.html"
    file.write_bytes(show.animation())
    return file.as_uri()


def test_a_saved_session_plays_without_a_server(saved, tab):
    tab.goto(saved)
    expect = need_browser().expect
    expect(tab.locator("#clock")).to_have_text(re.compile(r"0\.[1-9] s of 1\.0 s"))
    assert tab.title().startswith("two_link")
    assert tab.faults == []
    assert len(tab.locator("#canvas canvas").screenshot()) > 10_000  # a PNG of one colour would be smaller


def test_the_camera_sees_from_the_beginning_where_everything_will_be(two_link, tmp_path, tab):
    session = Session(two_link, view=2)
    show = Show(session, later=lambda work, then: then(work()), clock=Clock())
    for step in range(120):
        session.move_ball(0, [0.2, 0.01 * step, 0.4])  # out of reach in the end
        show.do({"type": "step"})
    file = tmp_path / "away.html"
    file.write_bytes(show.animation())
    tab.goto(file.as_uri())
    tab.locator("#play").click()
    seen = "() => pinik.player._show.ballsOnScreen().map(({ at }) => [at.x, at.y])"
    camera = "() => pinik.player._show.stage.viewer.camera.position.toArray()"
    where = []
    for at in ("0", "59"):
        tab.locator("#time").fill(at)
        tab.wait_for_timeout(1500)  # so that the camera could follow
        where.append(tab.evaluate(camera))
    box = tab.locator("#canvas").bounding_box()
    for x, y in tab.evaluate(seen):
        assert 0 < x < box["width"]
        assert 0 < y < box["height"]
    assert where[0] == pytest.approx(where[1])
    assert tab.faults == []


# The test decides when the browser draws and which time it gives to the page.
CLOCK = """
let waiting = [];
performance.now = () => 1000;
window.requestAnimationFrame = (draw) => waiting.push(draw);
window.drawAt = (time) => waiting.splice(0).forEach((draw) => draw(time));
"""


def test_a_first_picture_dated_before_the_script_shows_the_first_frame(saved, tab):
    tab.add_init_script(CLOCK)
    tab.goto(saved)
    tab.wait_for_function("() => window.pinik?.player", polling=50)  # once it has unpacked its frames
    clock = tab.locator("#clock")
    for time, shown in [(990, "0.0"), (995, "0.0"), (1495, "0.5"), (1490, "0.5"), (1690, "0.7")]:
        tab.evaluate("(time) => window.drawAt(time)", time)
        assert clock.inner_text() == f"{shown} s of 1.0 s"
    assert tab.faults == []
