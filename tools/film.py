"""Film the live view for the README: `python tools/film.py` writes docs/images/live.webp.

A tab of headless Chromium shows three scenes, one after the other. In each the ball makes a lap along its curve, and
every picture is taken when the page has drawn it in full detail, so the film runs smoothly on any machine.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright
from render import CHROMIUM, FLAGS

import pinik

OUT = Path(__file__).parents[1] / "docs" / "images" / "live.webp"
SIZE = (880, 496)
LAP = 480  # steps in which the ball goes round its curve
RATE = 15  # pictures a second
FADE = 6  # pictures in which one scene becomes the next
LARGEST = 2_900_000  # bytes


@dataclass(frozen=True)
class Scene:
    """One lap of a ball: the set-up as in the page's address, the page's size, and the steps between two pictures."""

    setup: str
    window: tuple[int, int]
    stride: int


SCENES = (
    Scene("robot=panda&view=4&methods=ccd,jt,pinv,dls&motion=curve&curve=eight&present=on", (980, 552), 8),
    Scene("robot=lion&view=2&methods=ccd,dls&motion=curve&curve=circle&present=on", (980, 552), 10),
    Scene("robot=arm&view=4&methods=ccd,jt,pinv,dls&motion=curve&curve=eight", (1240, 699), 8),
)


def filmed(page: Page, scene: Scene) -> Iterator[Image.Image]:
    """The pictures of one lap, after a lap in which the robots come into their stride."""
    with pinik.live(running=False, port=0) as view:
        page.set_viewport_size({"width": scene.window[0], "height": scene.window[1]})
        page.goto(f"{view.url}#{scene.setup}")
        page.wait_for_function("window.pinik?.drawn === 'shapes' && pinik.still")
        for step in range(2 * LAP):
            view.send("step")
            if step >= LAP and step % scene.stride == 0:
                page.wait_for_function(f"pinik.state.step >= {view.state['step']}")
                page.wait_for_function("pinik.settled")
                shot = Image.open(io.BytesIO(page.screenshot()))
                yield shot.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)


def faded(scenes: list[list[Image.Image]]) -> Iterator[Image.Image]:
    """All scenes in a circle, the end of each mixed with the beginning of the next."""
    for number, pictures in enumerate(scenes):
        following = scenes[(number + 1) % len(scenes)]
        yield from pictures[FADE:-FADE]
        for k in range(FADE):
            yield Image.blend(pictures[k - FADE], following[k], (k + 1) / (FADE + 1))


def main() -> None:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = browser.new_page(color_scheme="light", bypass_csp=True)
        page.set_default_timeout(120_000)
        scenes = [list(filmed(page, scene)) for scene in SCENES]
        browser.close()
    first, *others = faded(scenes)
    for quality in range(80, 30, -5):
        first.save(
            OUT, save_all=True, append_images=others, duration=round(1000 / RATE), loop=0, quality=quality, method=4
        )
        if OUT.stat().st_size <= LARGEST:
            break
    print(f"{OUT.name}: {1 + len(others)} pictures of quality {quality}, {OUT.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
