"""The last twenty seconds, and the page that plays them without a server."""

from __future__ import annotations

import base64
import html
import json
import math
import re
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..web.scene import Shapes, meshcat_script

__all__ = ["FRAMES_PER_SECOND", "SECONDS", "Recording", "animation_page"]

SECONDS = 20
FRAMES_PER_SECOND = 30

_PERIOD = 1.0 / FRAMES_PER_SECOND - 1e-6  # [s]; less than two steps by a little, whatever rounding makes of them
_STEP = slice(8, 12)  # the bytes of a frame message that differ between frames of one size; see `scene.pack_frame`
_HEADER = 24
_PAGE = Path(__file__).parents[1] / "page"


class Recording:
    """The frame messages of the last 20 s, at most 30 of a second.

    All of them are of one robot, one number of instances and one of balls: a frame that differs starts anew.
    """

    def __init__(self) -> None:
        self._frames: deque[bytes] = deque(maxlen=SECONDS * FRAMES_PER_SECOND)
        self._layout = b""
        self._due = -math.inf

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def frames(self) -> bytes:
        """The frame messages one after another, oldest first, each of `frame_bytes` bytes."""
        return b"".join(self._frames)

    @property
    def frame_bytes(self) -> int:
        """The length of one frame message; 0 while there is none."""
        return len(self._frames[0]) if self._frames else 0

    def add(self, frame: bytes, now: float) -> None:
        """One more frame message, of the time `now` [s]; to be called with each of them."""
        layout = frame[: _STEP.start] + frame[_STEP.stop : _HEADER]
        if layout != self._layout:
            self.clear()
            self._layout = layout
        if now >= self._due:
            # After the time that was due, so that no frame's delay slows the pace; after a pause from now.
            self._due = max(self._due + _PERIOD, now) if self._frames else now + _PERIOD
            self._frames.append(frame)

    def clear(self) -> None:
        """Forget everything; the next frame is kept."""
        self._frames.clear()
        self._due = -math.inf


def animation_page(
    hello: Mapping[str, Any],
    robot: Mapping[str, Any],
    shapes: Shapes,
    state: Mapping[str, Any],
    recording: Recording,
    page: Path = _PAGE,
) -> str:
    """One HTML file that plays a recording without a server.

    Args:
        hello, robot, state: The messages of these names, as they are now.
        shapes: The robot's.
        recording: What to play.
        page: The folder with `player.html`, `style.css` and the modules.

    Raises:
        ValueError: A message holds a number that is not finite.
    """
    document = {
        "hello": hello,
        "robot": robot,
        "shapes": shapes.message(robot["generation"]),
        "state": state,
        "commands": list(map(_base64, shapes.commands)),
        "frames": _base64(recording.frames),
        "frame_bytes": recording.frame_bytes,
        "frames_per_second": FRAMES_PER_SECOND,
    }
    modules = {
        f"pinik/{module.name}": f"data:text/javascript;base64,{_base64(module.read_bytes())}"
        for module in sorted(page.glob("*.js"))
    }
    pieces = {
        "title": html.escape(f"{robot['name']} – pinik"),
        "style": (page / "style.css").read_text("utf-8"),
        "importmap": _json_in_html({"imports": modules}),
        "meshcat": _script_in_html(meshcat_script().read_text("utf-8")),
        "recording": _json_in_html(document),
    }
    # In one go: what one piece holds is never taken for the place of another.
    player = (page / "player.html").read_text("utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda place: pieces[place[1]], player)


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _json_in_html(value: object) -> str:
    """JSON that no HTML parser takes for the end, or for a comment, of the script element that it stands in."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c")


def _script_in_html(text: str) -> str:
    """The same for JavaScript, where these words can stand in strings, patterns and comments only."""
    return re.sub(r"<(?=/script|script|!--)", r"\\x3c", text, flags=re.IGNORECASE)
