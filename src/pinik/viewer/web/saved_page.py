"""Saved pages: one HTML file from the page's own parts, which needs no server."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from .scene import meshcat_script

__all__ = ["PAGE", "as_base64", "json_in_html", "saved_page"]

PAGE = Path(__file__).parents[1] / "page"


def saved_page(template: str, pieces: Mapping[str, bytes], page: Path = PAGE) -> bytes:
    """Build one HTML file (UTF-8) from a template with the style sheets, the modules and meshcat in it.

    Args:
        template: The name of the template in the page's folder.
        pieces: What the template's other places are replaced by, by name.
        page: The folder with the template, the style sheets and the modules.
    """
    frame = _frame(template, page, max(file.stat().st_mtime_ns for file in page.iterdir()))
    return b"".join(pieces[part] if isinstance(part, str) else part for part in frame)


# What is the same in all pages is kept, because making it would hold up the session's steps.


@lru_cache(maxsize=2)
def _frame(template: str, page: Path, changed: int) -> list[bytes | str]:
    """Return the page in parts, and the names of the pieces that are still missing; `changed` is the files' date."""
    modules = {
        f"pinik/{module.name}": f"data:text/javascript;base64,{as_base64(module.read_bytes())}"
        for module in sorted(page.glob("*.js"))
    }
    pieces = {
        "style": b"".join(sheet.read_bytes() for sheet in sorted(page.glob("*.css"))),
        "importmap": json_in_html({"imports": modules}),
        "meshcat": _script_in_html(meshcat_script().read_text("utf-8")),
    }
    # Every second part is a name. The pieces are not searched for names, so one that looks like a place stays as it is.
    parts = re.split(r"\{\{(\w+)\}\}", (page / template).read_text("utf-8"))
    return [pieces.get(part, part) if index % 2 else part.encode() for index, part in enumerate(parts)]


def as_base64(data: bytes) -> str:
    """Bytes as base64 text."""
    return base64.b64encode(data).decode("ascii")


def json_in_html(value: object) -> bytes:
    """Return JSON that cannot end the script element around it or open a comment in it."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c").encode()


def _script_in_html(text: str) -> bytes:
    """Do the same for JavaScript, where these words can occur only in strings, patterns and comments."""
    return re.sub(r"<(?=/script|script|!--)", r"\\x3c", text, flags=re.IGNORECASE).encode()
