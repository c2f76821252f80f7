"""HTML documents with the page's own parts in them: one file that plays without a server, or one answer of a server."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from .scene import meshcat_script

__all__ = ["PAGE", "as_base64", "document", "json_in_html"]

PAGE = Path(__file__).parents[1] / "page"


def document(template: str, pieces: Mapping[str, bytes], page: Path = PAGE) -> bytes:
    """Build one HTML document (UTF-8) from a template, in which words in double braces are replaced.

    A style sheet's name stands for its text, `importmap` for all modules, and `meshcat` for meshcat's script. A browser
    that gets the modules in one piece need not ask for them level by level, as one imports the other.

    Args:
        template: The name of the template in the page's folder.
        pieces: What the template's other words are replaced by.
        page: The folder with the template, the style sheets and the modules.
    """
    frame = _frame(template, page, max(file.stat().st_mtime_ns for file in page.iterdir()))
    return b"".join(pieces[part] if isinstance(part, str) else part for part in frame)


# What is the same in all documents is kept, because making it would hold up the session's steps.


@lru_cache(maxsize=3)
def _frame(template: str, page: Path, changed: int) -> list[bytes | str]:
    """Return the document in parts, and the names of the pieces that are missing; `changed` is the files' date."""
    own = {sheet.name: sheet.read_bytes() for sheet in page.glob("*.css")}
    own["importmap"] = json_in_html({"imports": {f"pinik/{file.name}": _module(file) for file in page.glob("*.js")}})
    # Every second part is a name. The pieces are not searched for names, so one that looks like a place stays as it is.
    parts = re.split(r"\{\{([\w.]+)\}\}", (page / template).read_text("utf-8"))
    if "meshcat" in parts[1::2]:
        own["meshcat"] = _script_in_html(meshcat_script().read_text("utf-8"))
    return [own.get(part, part) if index % 2 else part.encode() for index, part in enumerate(parts)]


def _module(file: Path) -> str:
    """Return a module as a URL; the browser's tools and errors show its name."""
    named = file.read_bytes() + f"\n//# sourceURL=pinik/{file.name}\n".encode()
    return f"data:text/javascript;base64,{as_base64(named)}"


def as_base64(data: bytes) -> str:
    """Bytes as base64 text."""
    return base64.b64encode(data).decode("ascii")


def json_in_html(value: object) -> bytes:
    """Return JSON that cannot end the script element around it or open a comment in it."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c").encode()


def _script_in_html(text: str) -> bytes:
    """Do the same for JavaScript, where these words can occur only in strings, patterns and comments."""
    return re.sub(r"<(?=/script|script|!--)", r"\\x3c", text, flags=re.IGNORECASE).encode()
