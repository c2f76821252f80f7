"""Draw the pictures of docs/gallery.md by the page's own lines: `python tools/draw_gallery.py`"""

from __future__ import annotations

import contextlib
import re
import tempfile
from pathlib import Path

from PIL import Image

PAGE = Path(__file__).parents[1] / "docs" / "gallery.md"
FOLDER = PAGE.parent / "images" / "gallery"


def main() -> None:
    blocks = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        exec(compile("\n".join(blocks), PAGE.name, "exec"), {})
        FOLDER.mkdir(exist_ok=True)
        for path in sorted(Path().glob("*.png")):
            Image.open(path).convert("RGB").quantize(256).save(FOLDER / path.name, optimize=True)
            print(path.name, (FOLDER / path.name).stat().st_size // 1000, "kB")


if __name__ == "__main__":
    main()
