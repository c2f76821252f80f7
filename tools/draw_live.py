"""Take the pictures of the live view in docs/images, in Debian's chromium: `python tools/draw_live.py [NAME ...]`

The names are those of `SCENES`; without any, all are taken. It needs the dev extra and `apt install chromium`.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright
from render import CHROMIUM, FLAGS

import pinik
from pinik.viewer.web.live_view import LiveView

IMAGES = Path(__file__).parents[1] / "docs" / "images"
SETTLED = "window.pinik?.drawn === 'shapes' && pinik.still && pinik.settled && !pinik.state.loading"


@dataclass(frozen=True)
class Scene:
    """One picture.

    Attributes:
        file: Where it goes, below docs/images.
        setup: What follows the # in the page's address, with `run=on`.
        size: Width and height of the page [px].
        seconds: How long the robots move before they are stopped for the picture.
        prepare: What is done on the page then.
    """

    file: str
    setup: str
    size: tuple[int, int] = (1360, 800)
    seconds: float = 6.0
    prepare: Callable[[Page], None] = lambda page: None


def explain(page: Page) -> None:
    """Explain the first robot's next iteration, after one that has not reached the ball yet."""
    page.get_by_test_id("target-z").fill("0.7")
    page.get_by_test_id("target-z").press("Enter")
    page.evaluate("document.activeElement.blur()")
    page.wait_for_timeout(600)
    page.keyboard.press(".")


def other_answers(page: Page) -> None:
    """Show all answers as ghosts."""
    page.locator("#answers-block > summary").click()
    page.get_by_test_id("find-answers").click()
    page.get_by_test_id("answer-0").wait_for(timeout=60_000)
    page.locator("#answers-block").scroll_into_view_if_needed()


FOUR = "root=fixed&view=4&methods=ccd,jt,pinv,dls&motion=curve&curve=eight&run=on"
SCENES = {
    "live": Scene("live.png", f"robot=arm&{FOUR}"),
    "overlay": Scene("live/overlay.png", f"robot=panda&{FOUR}&looks=overlay"),
    "explain": Scene(
        "live/explain.png",
        "robot=panda&root=fixed&view=2&methods=ccd,dls&motion=hand&iterations=1&run=on&learn=explain",
        prepare=explain,
    ),
    "lion": Scene(
        "live/lion.png",
        "robot=lion&root=free_flyer&view=2&methods=ccd,dls&motion=curve&curve=eight&run=on",
    ),
    "answers": Scene(
        "live/answers.png",
        "robot=kinova&root=fixed&view=1&methods=dls&motion=hand&run=on"
        '&balls=[["j2s6s200_end_effector","on",[0.4,0.2,0.4],[1.57,0,1.57]]]',
        prepare=other_answers,
    ),
}


def take(page: Page, view: LiveView, scene: Scene) -> None:
    page.set_viewport_size({"width": scene.size[0], "height": scene.size[1]})
    page.goto(view.url + "#" + scene.setup)
    robot = scene.setup.split("robot=")[1].split("&")[0]
    page.wait_for_function(f"window.pinik?.state?.robot === '{robot}' && pinik.drawn === 'shapes'", timeout=120_000)
    page.wait_for_timeout(1000 * scene.seconds)
    view.send("begin_anew")
    page.wait_for_timeout(1000 * scene.seconds)
    view.send("run", on=False)
    scene.prepare(page)
    page.mouse.move(2, scene.size[1] - 2)
    page.evaluate("document.activeElement.blur()")
    page.wait_for_timeout(1500)
    page.wait_for_function(SETTLED, timeout=120_000)
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    out = IMAGES / scene.file
    out.parent.mkdir(exist_ok=True)
    picture.save(out, optimize=True)
    print(f"{out}: {out.stat().st_size // 1000} kB", file=sys.stderr)


def main() -> None:
    names = sys.argv[1:] or list(SCENES)
    with pinik.live("arm", port=0) as view, sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for name in names:
            context = chromium.new_context(bypass_csp=True, color_scheme="light")
            take(context.new_page(), view, SCENES[name])
            context.close()
        chromium.close()


if __name__ == "__main__":
    main()
