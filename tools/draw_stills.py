"""Take the stills of the animations in the site: `python tools/draw_stills.py` writes docs/images/live/NAME.png."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

from pages.live_pictures import PLAYED, filmed
from PIL import Image
from playwright.sync_api import sync_playwright
from render import CHROMIUM, FLAGS

IMAGES = Path(__file__).parents[1] / "docs" / "images" / "live"
SIZE = {"width": 800, "height": 450}
FRAME = 330  # of 30 a second


def main() -> None:
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = browser.new_page(viewport=SIZE, color_scheme="light", device_scale_factor=1.5)
        for name, play in PLAYED.items():
            file = Path(folder) / f"{name}.html"
            file.write_bytes(filmed(play).animation())
            page.goto(file.as_uri())
            page.wait_for_function("window.pinik?.player && document.querySelector('#time').value > 1", timeout=120_000)
            page.locator("#play").click()
            page.locator("#time").fill(str(FRAME))
            page.evaluate("document.activeElement.blur()")
            page.wait_for_timeout(4000)
            picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
            picture.save(IMAGES / f"{name}.png", optimize=True)
        browser.close()


if __name__ == "__main__":
    main()
