"""A live view, a chromium tab that shows it, and a record of the tab's faults; `page_fixtures` makes them."""

from __future__ import annotations

import io
import os
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import numpy as np
import pinocchio
import pytest

from judge import plain_placement
from pinik.viewer.web.live_view import LiveView
from stand_ins import PATIENCE

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Locator, Page
    from playwright.sync_api import LocatorAssertions as Expected

CHROMIUM = Path("/usr/bin/chromium")
METHODS = ("ccd", "jt", "pinv", "dls")
WIDE = {"width": 1280, "height": 720}
HALF = {"width": 1110, "height": 480}
SMALL = {"width": 1110, "height": 300}  # the same layout with a canvas that is cheap to draw
PHONE = {"width": 390, "height": 844}
DRAWN = "window.pinik?.drawn === 'shapes' && pinik.still"
BARE = "#labels, .views, .toasts, .loading { visibility: hidden }"  # for pictures of the canvas alone

State = dict[str, Any]


def need_browser(chromium: Path = CHROMIUM) -> Any:
    """Return playwright's module. If it or chromium is missing, skip the test, or fail if a browser is required."""
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


class Faults:
    """Records what no tab may do: log errors, fail to load something, or contact another host."""

    def __init__(self, context: BrowserContext) -> None:
        self.begin()
        context.on("console", lambda m: m.type == "error" and self._seen.append(f"console: {m.text}"))
        context.on("weberror", lambda e: self._seen.append(f"error: {e.error}"))
        context.on("request", lambda r: self._check_host(r.url))
        context.on("requestfailed", lambda r: self._seen.append(f"failed: {r.url}: {r.failure}"))
        context.on("response", lambda r: r.status >= 400 and self._seen.append(f"{r.status}: {r.url}"))
        context.on("page", lambda page: page.on("websocket", lambda socket: self._check_host(socket.url)))

    def begin(self) -> None:
        """Forget everything recorded."""
        self._hosts: set[str] = set()
        self._seen: list[str] = []
        self._excused: list[str] = []

    def allow(self, host: str) -> None:
        """Allow requests to a server of this test."""
        self._hosts.add(host)

    def _check_host(self, url: str) -> None:
        parts = urlsplit(url)
        if parts.scheme not in ("data", "blob", "file") and parts.netloc not in self._hosts:
            self._seen.append(f"asks another host: {url}")

    def excuse(self, pattern: str) -> None:
        """Ignore faults that match a pattern, such as those of a connection that the test itself cuts."""
        self._excused.append(pattern)

    @property
    def left(self) -> list[str]:
        return [fault for fault in self._seen if not any(re.search(pattern, fault) for pattern in self._excused)]


class Desk:
    """A live view and a tab that shows it."""

    view: LiveView

    def __init__(self, page: Page, faults: Faults) -> None:
        self.page, self.faults = page, faults

    def visit(self, view: LiveView, setup: str = "", until: str = DRAWN) -> None:
        """Open a view's page; `setup` is what follows the # in its address."""
        self.view = view
        self.faults.allow(f"127.0.0.1:{view.port}")
        self.page.goto(view.url + (f"#{setup}" if setup else ""))
        self.shows(until)

    @property
    def state(self) -> State:
        """The server's state."""
        return self.view.state

    def until(self, holds: Callable[[State], Any]) -> State:
        """Wait until the server's state fulfils a condition, and return it."""
        found: list[State] = []

        def look() -> bool:
            found[:] = [self.view.state]
            return bool(holds(found[0]))

        self.wait(look)
        return found[0]

    def wait(self, holds: Callable[[], Any]) -> None:
        """Keep the tab running until a condition holds."""
        end = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < end, "the condition never held"
            self.page.wait_for_timeout(40)

    def runs(self, script: str) -> Any:
        return self.page.evaluate(f"() => {script}")

    def shows(self, script: str) -> None:
        """Wait until an expression is true in the tab."""
        self.page.wait_for_function(f"() => {script}")

    def agree(self) -> State:
        """Wait until the tab knows all of the server's settings, and return the server's state."""
        self.wait(lambda: settings(self.runs("pinik.state")) == settings(self.state))
        return self.state

    def address(self) -> str:
        """Wait until the address bar contains the server's set-up, and return it without what is the tab's own."""

        def shown() -> str:
            parts = self.page.url.partition("#")[2].split("&")
            return "&".join(part for part in parts if part.split("=")[0] not in ("learn", "rings", "present"))

        self.wait(lambda: shown() == self.state["setup"])
        return self.state["setup"]

    def settle(self) -> None:
        """Wait until the robot is drawn with its shapes and the camera rests."""
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
        """Type into an input and press Enter."""
        self.part(testid).fill(str(value))
        self.part(testid).press("Enter")

    def text(self, testid: str) -> str:
        return self.part(testid).inner_text()

    def value(self, testid: str) -> float:
        return float(self.part(testid).input_value())

    def stop_clock(self) -> None:
        """Freeze the clock by which the page judges how long ago something happened; timers and drawing go on."""
        self.runs("{ const now = performance.now(); performance.now = () => now; }")

    @property
    def toasts(self) -> Locator:
        return self.part("toasts").locator(".toast")

    def ball_on_screen(self, k: int = 0) -> tuple[float, float]:
        point = self.page.evaluate("k => pinik.targetOnScreen(k)", k)
        return point["x"], point["y"]

    def effectors(self, state: State, k: int = 0) -> list[pinocchio.SE3]:
        """The placement of ball k's frame in each instance, by plain Pinocchio at the state's angles."""
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
        """The canvas (height, width, 3) without its overlays."""
        from PIL import Image

        taken = self.page.locator("#canvas").screenshot(style=BARE)
        return np.asarray(Image.open(io.BytesIO(taken)).convert("RGB")).astype(int)


def settings(state: State) -> State:
    """The settings in a state, without what changes by itself."""
    moving = ("step", "steps_per_second", "instances", "balls")
    asked = ("frame", "mode", "oriented", "rpy", "free", "tolerance")
    balls = [[ball[name] for name in asked] for ball in state["balls"]]
    return {name: value for name, value in state.items() if name not in moving} | {"balls": balls}
