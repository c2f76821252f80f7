"""A live view in a notebook: a frame while its own server answers, else a picture; in a real browser too."""

from __future__ import annotations

import base64
import io
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

import pinik
from desk import PATIENCE
from page_fixtures import new_context
from robots import load_quietly

LARGEST = 150_000  # bytes


class Parts(HTMLParser):
    """What is left of a notebook's output where scripts and frames are taken away, as published pages do."""

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


@pytest.fixture
def notebook(browser):
    """Shows outputs as a notebook's page does: with their scripts."""
    context = new_context(browser)
    page = context.new_page()

    def show(text):
        page.set_content(f"<body>{text}</body>")
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


def test_a_view_or_a_size_that_is_none_is_said_in_words(two_link):
    with pinik.live(two_link, port=0, running=False) as view:
        with pytest.raises(pinik.UnknownNameError, match="no view 'back'"):
            view.picture("back")
        for size in (5, (5, 5), "ab", (0, 0)):
            with pytest.raises(pinik.InputError, match="size is a width and a height"):
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
        page.wait_for_function("document.querySelectorAll('iframe').length == 2", timeout=1000 * PATIENCE)
        assert page.locator("img").count() == 0
        assert page.locator("iframe").first.get_attribute("src") == view.url
        page.frame_locator("iframe").first.get_by_test_id("robot").wait_for()


def asked_and_answered(page, text, show):
    """Show an output and wait until the question whether the server is there has been answered."""
    answered = []
    page.on("requestfinished", lambda request: "/api/alive/" in request.url and answered.append(request))
    page.on("requestfailed", lambda request: "/api/alive/" in request.url and answered.append(request))
    show(text)
    for _ in range(int(20 * PATIENCE)):
        if answered:
            break
        page.wait_for_timeout(50)
    page.wait_for_timeout(50)
    return len(answered)


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
        page.wait_for_timeout(300)
        assert [url for url in asked if not url.startswith("data:")] == ["https://notebooks.example/one"]
        assert page.locator("img").evaluate("image => image.naturalWidth") == 720
