"""Draw the pictures of docs/reach.md: what a Panda and a lion's paw can reach, slices, and the page in a browser.

`python tools/draw_reach.py` writes them; the page needs chromium and playwright.
"""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import pinik
from pinik.cli.reports.reach_plot import draw_slices

IMAGES = Path(__file__).parents[1] / "docs" / "images" / "reach"
CHROMIUM = "/usr/bin/chromium"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def few_colors(png: bytes) -> bytes:
    """The picture with 256 colours."""
    file = io.BytesIO()
    Image.open(io.BytesIO(png)).convert("RGB").quantize(256).save(file, "png", optimize=True)
    return file.getvalue()


def page(reach: pinik.ReachMap) -> bytes:
    """The page, as a browser shows it."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder) / "map.html"
        reach.save_page(file)
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        tab = browser.new_page(viewport={"width": 1200, "height": 760})
        tab.goto(file.as_uri())
        tab.wait_for_function("window.pinik?.reach?.stage.settled")
        tab.get_by_test_id("least").fill("0.3")
        tab.get_by_test_id("at-z").fill("16")
        tab.mouse.move(560, 300)
        tab.wait_for_timeout(500)
        tab.wait_for_function("window.pinik.reach.stage.settled")
        return tab.screenshot()


def main() -> None:
    """Write all pictures."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    panda = pinik.reach(pinik.load("panda"), "panda_hand_tcp", cell=0.05, samples=30_000_000)
    print(panda)
    (IMAGES / "panda.png").write_bytes(panda.draw(size=(1000, 760)).png(colors=256))
    slices = io.BytesIO()
    draw_slices(panda).savefig(slices, format="png", dpi=100)
    (IMAGES / "slices.png").write_bytes(few_colors(slices.getvalue()))
    (IMAGES / "page.png").write_bytes(few_colors(page(panda)))
    paw = pinik.reach(pinik.load("lion"), "left_fore_paw", samples=4_000_000)
    print(paw)
    (IMAGES / "paw.png").write_bytes(paw.draw(size=(1000, 700), view=(-0.9, 0.25)).png())


if __name__ == "__main__":
    main()
