"""The saved animation: one HTML file that plays a recording without a server."""

from __future__ import annotations

import html
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..protocol.packed_frames import deflated, packed_frames
from ..protocol.recording import FRAMES_PER_SECOND, Recording
from .document import PAGE, as_base64, document, json_in_html
from .scene import Shapes

__all__ = ["animation_page"]


def animation_page(
    hello: Mapping[str, Any],
    robot: Mapping[str, Any],
    shapes: Shapes,
    state: Mapping[str, Any],
    recording: Recording,
    page: Path = PAGE,
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
    played = {
        "hello": hello,
        "robot": robot,
        "shapes": shapes.message(robot["generation"]),
        "state": state,
        "frames": as_base64(packed_frames(recording.frames, recording.frame_bytes)),
        "frame_bytes": recording.frame_bytes,
        "frames_per_second": FRAMES_PER_SECOND,
    }
    pieces = {
        "title": html.escape(f"{robot['name']} – pinik").encode(),
        "recording": b"%s, %s" % (json_in_html(played)[:-1], _commands(shapes)),
    }
    return document("player.html", pieces, page)


@lru_cache(maxsize=1)
def _commands(shapes: Shapes) -> bytes:
    """Return the end of the recording's JSON: the commands of a robot's shapes, deflated, and the length of each."""
    packed = {
        "commands": as_base64(deflated(b"".join(shapes.commands))),
        "command_bytes": list(map(len, shapes.commands)),
    }
    return json_in_html(packed)[1:]
