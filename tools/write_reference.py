"""Write docs/command-line.md and docs/errors.md, which are made from the code: `python tools/write_reference.py`"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pages.command_page import command_page
from pages.error_page import error_page

DOCS = Path(__file__).parents[1] / "docs"
PAGES: dict[str, Callable[[], str]] = {"command-line.md": command_page, "errors.md": error_page}


def main() -> None:
    for name, page in PAGES.items():
        (DOCS / name).write_text(page(), "utf-8")


if __name__ == "__main__":
    main()
