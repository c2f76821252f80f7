"""The saved animation: one HTML file that plays a recording without a server."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..protocol.packed_frames import deflated, packed_frames
from ..protocol.recording import FRAMES_PER_SECOND, Recording
from .scene import Shapes, meshcat_script

__all__ = ["animation_page"]

_PAGE = Path(__file__).parents[1] / "page"


def animation_page(
    hello: Mapping[str, Any],
    robot: Mapping[str, Any],
    shapes: Shapes,
    state: Mapping[str, Any],
    recording: Recording,
    page: Path = _PAGE,
) -> bytes:
    """Build one HTML file (UTF-8) that plays a recording without a server.

    Args:
        hello, robot, state: The current messages of these types.
        shapes: The robot's shapes.
        recording: The frames to play.
        page: The folder with `player.html`, the style sheets and the modules.

    Raises:
        ValueError: A message contains a number that is not finite.
    """
    document = {
        "hello": hello,
        "robot": robot,
        "shapes": shapes.message(robot["generation"]),
        "state": state,
        "frames": _base64(packed_frames(recording.frames, recording.frame_bytes)),
        "frame_bytes": recording.frame_bytes,
        "frames_per_second": FRAMES_PER_SECOND,
    }
    pieces = {
        "title": html.escape(f"{robot['name']} – pinik").encode(),
        "recording": b"%s, %s" % (_json_in_html(document)[:-1], _commands(shapes)),
    }
    player = _player(page, max(file.stat().st_mtime_ns for file in page.iterdir()))
    return b"".join(pieces[part] if isinstance(part, str) else part for part in player)


# What is the same in all animations is kept, because making it would hold up the session's steps.


@lru_cache(maxsize=1)
def _player(page: Path, changed: int) -> list[bytes | str]:
    """Return the player in parts, and the names of the pieces that are still missing; `changed` is the files' date."""
    modules = {
        f"pinik/{module.name}": f"data:text/javascript;base64,{_base64(module.read_bytes())}"
        for module in sorted(page.glob("*.js"))
    }
    pieces = {
        "style": b"".join(sheet.read_bytes() for sheet in sorted(page.glob("*.css"))),
        "importmap": _json_in_html({"imports": modules}),
        "meshcat": _script_in_html(meshcat_script().read_text("utf-8")),
    }
    # Every second part is a name. The pieces are not searched for names, so one that looks like a place stays as it is.
    parts = re.split(r"\{\{(\w+)\}\}", (page / "player.html").read_text("utf-8"))
    return [pieces.get(part, part) if index % 2 else part.encode() for index, part in enumerate(parts)]


@lru_cache(maxsize=1)
def _commands(shapes: Shapes) -> bytes:
    """Return the end of the recording's JSON: the commands of a robot's shapes, deflated, and the length of each."""
    packed = {
        "commands": _base64(deflated(b"".join(shapes.commands))),
        "command_bytes": list(map(len, shapes.commands)),
    }
    return _json_in_html(packed)[1:]


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _json_in_html(value: object) -> bytes:
    """Return JSON that cannot end the script element around it or open a comment in it."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c").encode()


def _script_in_html(text: str) -> bytes:
    """Do the same for JavaScript, where these words can occur only in strings, patterns and comments."""
    return re.sub(r"<(?=/script|script|!--)", r"\\x3c", text, flags=re.IGNORECASE).encode()
