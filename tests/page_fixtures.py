"""Fixtures of the page's tests: Debian's chromium, and live views in this process, each with a tab."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import pinik
from desk import CHROMIUM, DRAWN, METHODS, SMALL, WIDE, Desk, Faults, need_browser
from pinik.viewer.web.live_view import LiveView
from robots import load_quietly
from stand_ins import PATIENCE

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

FLAGS = [
    "--no-sandbox",
    "--disable-gpu-compositing",  # the processor draws everything, so frames need not go through the graphics process
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
]
# Triangles are not drawn, and frames are rare; everything else happens.
UNDRAWN = """{
    for (const name of ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"])
        WebGL2RenderingContext.prototype[name] = () => {};
    const atOnce = window.requestAnimationFrame;
    window.requestAnimationFrame = (draw) => setTimeout(() => atOnce(draw), 100);
}"""

# Notices stay until a test closes them, however slow it is. `longTimers` has the functions that would close them.
NOTICES_STAY = """{
    const after = window.setTimeout;
    window.longTimers = [];
    window.setTimeout = (act, delay, ...rest) =>
        delay >= 8000 ? window.longTimers.push(act) : after(act, delay, ...rest);
}"""

Tabs = Callable[[bool], tuple["Page", Faults]]
OpenDesk = Callable[..., Desk]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One per module rather than per session: while playwright runs, other tests cannot start an asyncio loop."""
    sync_api = need_browser()
    sync_api.expect.set_options(timeout=1000 * PATIENCE)
    with sync_api.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def tabs(browser: Browser) -> Iterator[Tabs]:
    """Tabs that a module's tests share, because opening one takes a second; every test has a server of its own.

    A tab that is not drawn leaves processor time for other things.
    """
    opened: dict[bool, tuple[Page, Faults]] = {}

    def tab(drawn: bool) -> tuple[Page, Faults]:
        if drawn not in opened:
            context = new_context(browser, drawn=drawn)
            faults = Faults(context)
            opened[drawn] = context.new_page(), faults
        return opened[drawn]

    yield tab
    for page, _ in opened.values():
        page.context.close()


def new_context(browser: Browser, *, drawn: bool = True, bypass_csp: bool = True, **options: Any) -> BrowserContext:
    """Open a browser context. It bypasses the page's policy, which forbids the scripts that playwright evaluates."""
    context = browser.new_context(bypass_csp=bypass_csp, **options)
    context.set_default_timeout(1000 * PATIENCE)
    context.add_init_script(NOTICES_STAY)
    if not drawn:
        context.add_init_script(UNDRAWN)
    return context


@pytest.fixture
def open_desk(browser: Browser, tabs: Tabs) -> Iterator[OpenDesk]:
    """Opens live views, each with a tab. The test fails if a tab has recorded a fault."""
    desks: list[tuple[Desk, bool]] = []
    views: list[LiveView] = []

    def open_one(
        robot: str | Path = "arm",
        methods: tuple[str, ...] = METHODS,
        *,
        running: bool = False,
        motion: str = "hand",
        view: int | None = None,
        root: str = "fixed",
        setup: str = "",
        until: str = DRAWN,
        viewport: dict[str, int] = WIDE,
        drawn: bool = True,
        watch: bool = False,
        **context: Any,
    ) -> Desk:
        """Open a view, by default stopped and by hand. With options for a browser context, its tab is not shared."""
        machine = robot if isinstance(robot, Path) else load_quietly(robot, root=root)
        live = pinik.live(machine, methods, running=running, motion=motion, view=view, port=0, watch=watch)
        views.append(live)
        if context:
            opened = new_context(browser, drawn=drawn, viewport=viewport, **context)
            faults, page = Faults(opened), opened.new_page()
        else:
            page, faults = tabs(drawn)
            page.set_viewport_size(viewport)
        faults.begin()
        desk = Desk(page, faults)
        desks.append((desk, not context))
        desk.visit(live, setup, until)
        return desk

    yield open_one
    seen = [fault for desk, _ in desks for fault in desk.faults.left]
    for desk, is_shared in desks:
        if is_shared:
            leave(desk.page)
        else:
            desk.page.context.close()
        desk.view.close()
    for view in views:
        view.close()
    assert not seen, f"a tab saw {seen}"


def leave(page: Page) -> None:
    """Undo what a test did to a shared tab."""
    for other in page.context.pages:
        if other is not page:
            other.close()
    page.unroute_all()
    page.emulate_media()
    page.mouse.move(0, 0)
    page.goto("about:blank")


@pytest.fixture
def open_panel(open_desk: OpenDesk) -> OpenDesk:
    """Like `open_desk`, for tests of the panel: the canvas is small, nothing is drawn, and shapes may still load."""
    return partial(open_desk, viewport=SMALL, drawn=False, until="window.pinik?.ready")


@pytest.fixture
def open_stage(open_desk: OpenDesk) -> OpenDesk:
    """Like `open_desk`, for tests of where things stand: no triangle is drawn."""
    return partial(open_desk, drawn=False)
