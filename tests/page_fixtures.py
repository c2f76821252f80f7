"""The live view's page in Debian's chromium: a server in this process, tabs that show it, a watch on their faults."""

from __future__ import annotations

import io
import os
import re
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import numpy as np
import pinocchio
import pytest

import pinik
from robots import load_quietly
from stand_ins import plain_placement

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Locator, Page
    from playwright.sync_api import LocatorAssertions as Expected

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
]
METHODS = ("ccd", "jt", "pinv", "dls")
PATIENCE = 60.0  # seconds; nothing here takes as many, unless it is broken
WIDE = {"width": 1280, "height": 720}
SMALL = {"width": 1110, "height": 300}  # the same layout with a canvas that costs a processor little
PHONE = {"width": 390, "height": 844}
DRAWN = "window.pinik?.drawn === 'shapes' && pinik.still"
SLOW_SCREEN = """{
    const atOnce = window.requestAnimationFrame;
    window.requestAnimationFrame = (draw) => setTimeout(() => atOnce(draw), 100);
}"""
BARE = "#labels, .views, .toasts, .loading { visibility: hidden }"  # for pictures of the canvas alone

State = dict[str, Any]


def need_browser(chromium: Path = CHROMIUM) -> Any:
    """playwright's module; where it or chromium is missing the test is skipped, or fails if one is required."""
    missing = "" if chromium.exists() else f"{chromium} is missing (apt install chromium)"
    try:
        from playwright import sync_api
    except ImportError:
        sync_api, missing = None, "playwright is missing (make lint installs it)"
    if missing and os.environ.get("PINIK_REQUIRE_BROWSER") == "1":
        pytest.fail(f"PINIK_REQUIRE_BROWSER=1, but {missing}")
    if missing:
        pytest.skip(f"the page's tests need a browser: {missing}")
    return sync_api


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for a module and not for a session: while playwright runs, other tests cannot start an asyncio loop."""
    sync_api = need_browser()
    sync_api.expect.set_options(timeout=1000 * PATIENCE)
    with sync_api.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


class Faults:
    """What no tab may do: complain on its console, fail to load a part, or ask another host for anything."""

    def __init__(self, context: BrowserContext) -> None:
        self.begin("")
        context.on("console", lambda m: m.type == "error" and self._seen.append(f"console: {m.text}"))
        context.on("weberror", lambda e: self._seen.append(f"error: {e.error}"))
        context.on("request", lambda r: self._check_host(r.url))
        context.on("requestfailed", lambda r: self._seen.append(f"failed: {r.url}: {r.failure}"))
        context.on("response", lambda r: r.status >= 400 and self._seen.append(f"{r.status}: {r.url}"))
        context.on("page", lambda page: page.on("websocket", lambda socket: self._check_host(socket.url)))

    def begin(self, host: str) -> None:
        """Forget what was; from now on only `host` may be asked."""
        self._host = host
        self._seen: list[str] = []
        self._excused: list[str] = []

    def _check_host(self, url: str) -> None:
        parts = urlsplit(url)
        if parts.scheme not in ("data", "blob", "file") and parts.netloc != self._host:
            self._seen.append(f"asks another host: {url}")

    def excuse(self, pattern: str) -> None:
        """Where a test cuts the line itself, the browser says so."""
        self._excused.append(pattern)

    @property
    def left(self) -> list[str]:
        return [fault for fault in self._seen if not any(re.search(pattern, fault) for pattern in self._excused)]


class Desk:
    """A live view and a tab that shows it."""

    def __init__(self, view: pinik.viewer.live_view.LiveView, page: Page, faults: Faults) -> None:
        self.view, self.page, self.faults = view, page, faults

    @property
    def state(self) -> State:
        """The server's truth."""
        return self.view.state

    def until(self, holds: Callable[[State], Any]) -> State:
        """The server's state, as soon as it is so."""
        found: list[State] = []

        def look() -> bool:
            found[:] = [self.view.state]
            return bool(holds(found[0]))

        self.wait(look)
        return found[0]

    def wait(self, holds: Callable[[], Any]) -> None:
        """Let the tab live on until something is so."""
        end = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < end, "it never came to be so"
            self.page.wait_for_timeout(40)

    def runs(self, script: str) -> Any:
        return self.page.evaluate(f"() => {script}")

    def shows(self, script: str) -> None:
        """Wait until an expression is true in the tab."""
        self.page.wait_for_function(f"() => {script}")

    def agree(self) -> State:
        """Wait until the tab has been told every setting that the server holds."""
        self.wait(lambda: settings(self.runs("pinik.state")) == settings(self.state))
        return self.state

    def address(self) -> str:
        """The set-up in the address bar, once it is the server's."""
        self.wait(lambda: self.page.url.partition("#")[2] == self.state["setup"])
        return self.state["setup"]

    def settle(self) -> None:
        """Wait until the robot is drawn with its shapes and nothing but the robots moves the picture."""
        self.shows(DRAWN)

    def part(self, testid: str) -> Locator:
        return self.page.get_by_test_id(testid)

    def expect(self, part: str | Locator) -> Expected:
        return need_browser().expect(self.part(part) if isinstance(part, str) else part)

    def click(self, testid: str) -> None:
        self.part(testid).click()

    def choose(self, testid: str, value: str) -> None:
        self.part(testid).select_option(value)

    def type(self, testid: str, value: float | str) -> None:
        """As a person would: into the input, and Enter."""
        self.part(testid).fill(str(value))
        self.part(testid).press("Enter")

    def text(self, testid: str) -> str:
        return self.part(testid).inner_text()

    def value(self, testid: str) -> float:
        return float(self.part(testid).input_value())

    @property
    def toasts(self) -> Locator:
        return self.part("toasts").locator(".toast")

    def ball_on_screen(self, k: int = 0) -> tuple[float, float]:
        point = self.page.evaluate("k => pinik.targetOnScreen(k)", k)
        return point["x"], point["y"]

    def effectors(self, state: State, k: int = 0) -> list[pinocchio.SE3]:
        """The frame of ball k in each instance: plain Pinocchio at the angles that the state tells."""
        robot = self.view.robot
        placements = []
        for instance in state["instances"]:
            angles = {name: angle for name, angle in instance["angles"].items() if name not in robot.mimics}
            placements.append(plain_placement(robot, state["balls"][k]["frame"], robot.configuration(angles)))
        return placements

    def is_followed(self, state: State, k: int = 0) -> bool:
        """Whether every instance has reached ball k."""
        ball, within = np.array(state["balls"][k]["position"]), state["tolerance"]["position"]
        return all(np.linalg.norm(at.translation - ball) < within for at in self.effectors(state, k))

    def picture(self) -> np.ndarray:
        """The canvas (height, width, 3), without what floats above it."""
        from PIL import Image

        taken = self.page.locator("#canvas").screenshot(style=BARE)
        return np.asarray(Image.open(io.BytesIO(taken)).convert("RGB")).astype(int)


def settings(state: State) -> State:
    """What a person sets, without what moves by itself."""
    moving = ("step", "steps_per_second", "instances", "balls")
    balls = [[ball["frame"], ball["mode"], ball["oriented"], ball["rpy"]] for ball in state["balls"]]
    return {name: value for name, value in state.items() if name not in moving} | {"balls": balls}


OpenDesk = Callable[..., Desk]


@pytest.fixture(scope="module")
def tabs(browser: Browser) -> Iterator[dict[str, tuple[Page, Faults]]]:
    """Tabs that a module's tests use one after the other, each test with a server of its own.

    A new tab costs a second. "slow" is one with a slow screen, which leaves a processor that has to draw everything
    time for the other things.
    """
    opened = {name: new_context(browser) for name in ("quick", "slow")}
    opened["slow"].add_init_script(SLOW_SCREEN)
    watched = {name: Faults(context) for name, context in opened.items()}
    yield {name: (context.new_page(), watched[name]) for name, context in opened.items()}
    for context in opened.values():
        context.close()


def new_context(browser: Browser, **options: Any) -> BrowserContext:
    context = browser.new_context(**options)
    context.set_default_timeout(1000 * PATIENCE)
    return context


@pytest.fixture
def open_desk(browser: Browser, tabs: dict[str, tuple[Page, Faults]]) -> Iterator[OpenDesk]:
    """Opens live views, each with a tab; at the end none of the tabs may have seen a fault."""
    desks: list[Desk] = []

    def open_one(
        robot: str | Path = "arm",
        methods: tuple[str, ...] = METHODS,
        *,
        running: bool = False,
        motion: str = "hand",
        view: int | None = None,
        root: str = "fixed",
        port: int = 0,
        setup: str = "",
        until: str = DRAWN,
        viewport: dict[str, int] = WIDE,
        tab: str = "quick",
        **context: Any,
    ) -> Desk:
        """Stopped and by hand unless told otherwise.

        `setup` is what the address asks for, `until` what to wait for in the tab; options of a context of its own.
        """
        machine = robot if isinstance(robot, Path) else load_quietly(robot, root=root)
        live = pinik.live(machine, methods, running=running, motion=motion, view=view, port=port)
        if context or desks:
            opened = new_context(browser, viewport=viewport, **context)
            faults, page = Faults(opened), opened.new_page()
        else:
            page, faults = tabs[tab]
            page.set_viewport_size(viewport)
        faults.begin(f"127.0.0.1:{live.port}")
        desk = Desk(live, page, faults)
        desks.append(desk)
        page.goto(live.url + (f"#{setup}" if setup else ""))
        desk.shows(until)
        return desk

    yield open_one
    faults = [fault for desk in desks for fault in desk.faults.left]
    for desk in desks:
        if any(desk.page is page for page, _ in tabs.values()):
            leave(desk.page)
        else:
            desk.page.context.close()
        desk.view.close()
    assert not faults, f"a tab saw {faults}"


def leave(page: Page) -> None:
    """Nothing of what a test did to a tab is left to the next."""
    for other in page.context.pages:
        if other is not page:
            other.close()
    page.unroute_all()
    page.emulate_media()
    page.mouse.move(0, 0)
    page.goto("about:blank")


@pytest.fixture
def open_panel(open_desk: OpenDesk) -> OpenDesk:
    """As `open_desk`, for tests that look at no picture: one that is small and drawn slowly will do."""
    return partial(open_desk, viewport=SMALL, tab="slow", until="window.pinik?.ready")
