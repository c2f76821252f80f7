"""A live view in a notebook: a frame while its own server answers, otherwise a picture."""

from __future__ import annotations

import base64
import contextlib
import http.server
import io
import re
import threading
import time
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

import pinik
from page_fixtures import new_context
from robots import load_quietly
from stand_ins import PATIENCE

LARGEST = 150_000  # bytes
# Counts the images of scripts that have come or failed, once the script's own handlers have run.
COUNT_IMAGES = """
window.settledImages = 0;
const Plain = window.Image;
window.Image = function () {
    const image = new Plain();
    const settled = () => setTimeout(() => { window.settledImages += 1; });
    for (const kind of ["load", "error"]) image.addEventListener(kind, settled);
    return image;
};
"""


class Parts(HTMLParser):
    """A notebook's output without scripts and frames, as published pages show it."""

    def __init__(self, text):
        super().__init__()
        self.images, self.words, self._inside = [], "", ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self._inside = tag
        if tag == "img":
            self.images.append(dict(attributes))

    def handle_data(self, data):
        if self._inside != "script":
            self.words += data


def image_of(text):
    (image,) = Parts(text).images
    kind, data = image["src"].split(",", 1)
    assert kind == "data:image/png;base64"
    return Image.open(io.BytesIO(base64.b64decode(data)))


@contextlib.contextmanager
def served(texts):
    """Serve a page with the last of these texts on this machine; yields the port."""

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            body = f"<!doctype html><meta charset=utf-8><body>{texts[-1]}</body>".encode()
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format, *arguments):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join()


def wait_until(page, holds):
    """Keep the page running until a condition holds."""
    deadline = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < deadline, "the condition never held"
        page.wait_for_timeout(20)


@pytest.fixture
def notebook(browser):
    """Shows outputs with their scripts, as a notebook does, from a server on the same machine."""
    context = new_context(browser)
    context.add_init_script(COUNT_IMAGES)
    page = context.new_page()
    texts = [""]
    with served(texts) as port:

        def show(text, host="127.0.0.1"):
            texts.append(text)
            page.goto(f"http://{host}:{port}/")
            return page

        yield show
        context.close()


def balls_in(picture):
    r, g, b = (picture.pixels[..., k].astype(int) for k in range(3))
    columns = ((r > 90) & (g < 0.4 * r) & (b < 0.5 * r)).any(axis=0)
    return int((np.diff(columns.astype(int)) == 1).sum())


def test_without_scripts_it_is_a_picture_with_a_caption(two_link):
    with pinik.live(two_link, ["dls", "ccd"], port=0) as view:
        text = view._repr_html_()
    image = image_of(text)
    assert image.size == (720, 360)
    assert len(text) < LARGEST
    assert Parts(text).words.strip() == "two_link, seen by pinik.live; from left to right: dls, ccd"
    assert "<iframe" not in text


@pytest.mark.parametrize("name", ["lion", "panda"])
def test_the_picture_of_four_large_robots_is_small(name):
    with pinik.live(load_quietly(name), port=0, running=False) as view:
        assert len(view._repr_html_()) < LARGEST


@pytest.mark.parametrize("count", [1, 2, 4])
def test_the_picture_shows_every_instance_that_is_seen_with_its_ball(two_link, count):
    with pinik.live(two_link, ["dls", "ccd", "jt", "pinv"][:count], port=0, running=False, motion="hand") as view:
        view.move_ball([0.2, 0.1, 0.5])
        picture = view.picture()
        assert balls_in(picture) == count
        view.send("view", count=1)
        assert balls_in(view.picture()) == 1
        view.send("effector", index=0, mode="off")
        assert balls_in(view.picture()) == 0


def test_the_picture_shows_where_the_robots_are_now(two_link):
    with pinik.live(two_link, ["dls"], port=0, running=False, motion="hand") as view:
        before = view.picture()
        assert (view.picture().pixels == before.pixels).all()
        q = view.configurations[0]
        tip = two_link.placement("tip", q).translation
        view.move_ball(two_link.placement("tip", q + 0.5).translation)
        view.send("step")
        assert not np.allclose(two_link.placement("tip", view.configurations[0]).translation, tip)
        assert (view.picture().pixels != before.pixels).any()


def test_the_picture_is_seen_from_another_one_s_camera_as_well(two_link):
    with pinik.live(two_link, ["dls", "ccd"], port=0, running=False, motion="hand") as view:
        first = view.picture((0.5, 0.3))
        again = view.picture(first.camera)
    assert again.camera is first.camera
    assert (again.pixels == first.pixels).all()


def test_a_view_or_a_size_that_is_none_is_said_in_words(two_link):
    with pinik.live(two_link, port=0, running=False) as view:
        with pytest.raises(pinik.UnknownNameError, match="no view 'back'"):
            view.picture("back")
        for size in (5, (5, 5), "ab", (0, 0)):
            with pytest.raises(pinik.InputError, match=r"size .*a width and a height"):
                view.picture(size=size)
    with pytest.raises(pinik.InputError, match="this live view is closed"):
        view.picture()


def test_shown_twice_it_has_two_places(two_link):
    with pinik.live(two_link, ["dls"], port=0, running=False) as view:
        places = [re.search(r'id="([\w-]+)"', view._repr_html_()).group(1) for _ in range(2)]
    assert len(set(places)) == 2


# In a browser


def test_while_its_server_answers_it_is_the_page_in_a_frame(two_link, notebook):
    with pinik.live(two_link, ["dls"], port=0) as view:
        page = notebook(view._repr_html_() + view._repr_html_())
        page.wait_for_function("document.querySelectorAll('iframe').length == 2")
        assert page.locator("img").count() == 0
        assert page.locator("iframe").first.get_attribute("src") == view.url
        page.frame_locator("iframe").first.get_by_test_id("robot").wait_for()


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1"])
def test_a_notebook_of_this_machine_may_frame_it(two_link, notebook, host):
    with pinik.live(two_link, ["dls"], port=0) as view:
        page = notebook(view._repr_html_(), host)
        page.frame_locator("iframe").get_by_test_id("robot").wait_for()


def test_a_foreign_page_cannot_put_its_set_up_in_a_frame(two_link, notebook, tmp_path):
    """Foreign pages are those under another host name, and those from files."""
    with pinik.live(two_link, ["dls"], port=0, running=False, motion="hand") as view:
        before = view.state["setup"]
        frame = f'<iframe src="{view.url}#{before.replace("methods=dls", "methods=ccd")}"></iframe>'
        (tmp_path / "foreign.html").write_text(frame, "utf-8")
        page = notebook("")
        refused = []
        page.on("requestfailed", lambda request: refused.append((request.url.split("#")[0], request.failure)))
        notebook(frame, "foreign.localhost")
        wait_until(page, lambda: refused)
        page.goto((tmp_path / "foreign.html").as_uri())
        wait_until(page, lambda: len(refused) == 2)
        assert refused == [(view.url, "net::ERR_BLOCKED_BY_RESPONSE")] * 2
        assert view.state["setup"] == before
        notebook(frame)  # the same from this machine
        page.frame_locator("iframe").get_by_test_id("robot").wait_for()
        wait_until(page, lambda: "methods=ccd" in view.state["setup"])


@pytest.mark.parametrize("where", ["another name", "a file"])
def test_where_it_may_not_frame_it_a_notebook_keeps_the_picture(two_link, notebook, where, tmp_path):
    with pinik.live(two_link, ["dls"], port=0) as view:
        text = view._repr_html_()
        page = notebook("")
        asked = []
        page.on("request", lambda request: asked.append(request.url))
        if where == "a file":
            (tmp_path / "kept.html").write_text(text, "utf-8")
            page.goto((tmp_path / "kept.html").as_uri())
        else:
            notebook(text, "foreign.localhost")
        # A page counts as loaded only when the images that its scripts asked for have come or failed.
        assert not [url for url in asked if url.startswith(view.url)]
        assert page.locator("iframe").count() == 0
        assert page.locator("img").evaluate("image => image.naturalWidth") == 720


def asked_and_answered(page, text, show):
    """Show an output, wait until its script knows whether the server is there, and return how often it asked."""
    asked = []
    page.on("request", lambda request: "/api/alive/" in request.url and asked.append(request))
    show(text)
    page.wait_for_function("window.settledImages > 0")
    return len(asked)


@pytest.mark.parametrize("after", ["nothing", "another view"])
def test_when_its_server_has_gone_it_stays_a_picture(two_link, notebook, after):
    with pinik.live(two_link, ["dls"], port=0) as view:
        text = view._repr_html_()
    page = notebook("")
    if after == "nothing":
        assert asked_and_answered(page, text, notebook) == 1
    else:
        with pinik.live(two_link, ["dls"], port=view.port):
            assert asked_and_answered(page, text, notebook) == 1
    assert page.locator("iframe").count() == 0
    assert page.locator("img").evaluate("image => image.naturalWidth") == 720


def test_a_published_notebook_asks_nothing_of_its_readers_machine(two_link, notebook):
    with pinik.live(two_link, ["dls"], port=0) as view:
        page = notebook("")
        asked = []
        page.on("request", lambda request: asked.append(request.url))
        text = view._repr_html_()
        page.route("https://notebooks.example/**", lambda route: route.fulfill(body=text, content_type="text/html"))
        page.goto("https://notebooks.example/one")
        assert [url for url in asked if not url.startswith("data:")] == ["https://notebooks.example/one"]
        assert page.locator("img").evaluate("image => image.naturalWidth") == 720
