"""The live view in a notebook: the page in a frame, or a picture once the server has gone."""

from __future__ import annotations

import base64
import html
import json
import secrets
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.home import home_configuration
from ...picture.arguments import checked_size, view_direction
from ...picture.bodies import bodies_of, read_parts
from ...picture.camera import Camera, facing, look_from
from ...picture.draw import BALL, PINNED, ball_radius, draw
from ...picture.picture import Picture
from ...robot import Robot

__all__ = ["as_html", "draw_beside"]

Array = NDArray[np.float64]

_HEIGHT = 640  # pixels of the frame
_SIZE = (720, 360)  # of the picture
_GAP = 0.06  # between neighbours, of their width
_FILLED = 0.9  # of the picture
_LENS = 0.23  # for one instance; more are seen from farther away, so that all show the same side

# Only a page that may embed the server's page looks for the server. A page from elsewhere, such as a published
# notebook, must not probe its reader's ports. The script requests an image, which no other server would answer.
_SCRIPT = """(() => {
    const place = document.getElementById(%(place)s);
    const local = ["localhost", "127.0.0.1"].includes(location.hostname);
    if (!place || !(local || location.protocol === "vscode-webview:")) return;
    const alive = new Image();
    alive.onload = () => {
        const frame = document.createElement("iframe");
        Object.assign(frame, { src: %(url)s, title: "pinik live view" });
        frame.style.cssText = "width: 100%%; height: %(height)dpx; border: 0";
        place.replaceChildren(frame);
    };
    alive.src = %(url)s + "api/alive/" + %(mark)s + ".svg?" + Date.now();
})();"""


def draw_beside(
    robot: Robot,
    configurations: Sequence[Array],
    balls: Sequence[tuple[Array, bool]],
    *,
    view: str | tuple[float, float] | Camera = "angle",
    size: tuple[int, int] = _SIZE,
) -> Picture:
    """Draw the instances side by side from left to right, each with all the balls.

    Args:
        robot: The robot.
        configurations: q (nq,) of each instance.
        balls: For each ball, its position (3,) [m] and whether it is pinned.
        view: As for `pinik.draw`.
        size: As for `pinik.draw`.
    """
    width, height = checked_size(size)
    right = (view.axes if isinstance(view, Camera) else facing(view_direction(view)))[0]
    points = np.array([position for position, _ in balls]).reshape(-1, 3)
    radius = ball_radius(robot)
    read_parts(robot)  # without warnings, as the page shows what could not be read
    one = [_vertices(robot, q) for q in configurations]
    reach = np.vstack([*one, points - radius, points + radius])
    offsets = np.arange(len(one))[:, None] * ((1.0 + _GAP) * np.ptp(reach @ right)) * right
    if not isinstance(view, Camera):
        everything = np.vstack([reach + offset for offset in offsets])
        direction, lens = view_direction(view), _LENS / len(one)
        view = look_from(direction, everything, aspect=width / height, lens=lens, filled=_FILLED)
    return draw(
        robot,
        list(configurations),
        offset=offsets,
        balls=(offsets[:, None] + points).reshape(-1, 3),
        ball_color=[PINNED if pinned else BALL for _ in configurations for _, pinned in balls],
        view=view,
        size=size,
        ground=float(_vertices(robot, home_configuration(robot))[:, 2].min()),
    )


def _vertices(robot: Robot, q: Array) -> Array:
    return np.vstack([body.solid.vertices for body in bodies_of(robot, q)])


def as_html(url: str, mark: str, picture: Picture, caption: str) -> str:
    """Return a picture that is replaced by a frame if the view's own server answers.

    Viewers that run no scripts show the picture, and so does a notebook opened after the server has gone.

    Args:
        url: The page's address.
        mark: Identifies this view at the server.
        picture: The view at this moment.
        caption: A line below the picture.
    """
    place = f"pinik-live-{secrets.token_hex(8)}"
    words = {"place": place, "url": url, "mark": mark}
    script = _SCRIPT % {**{name: json.dumps(word) for name, word in words.items()}, "height": _HEIGHT}
    png = base64.b64encode(picture.png(colors=256)).decode()
    return (
        f'<div id="{place}"><img src="data:image/png;base64,{png}" alt="{html.escape(caption)}" '
        f'width="{picture.size[0]}" style="max-width: 100%"><br><small>{html.escape(caption)}</small></div>\n'
        f"<script>{script}</script>"
    )
