"""Pictures that move: saved animations of the live view, which play in a page without a server.

In Markdown each is a still picture, and in the site a link around it, in which docs/assets/plays.js plays it.
`python tools/draw_stills.py` takes the stills.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import pinik
from pinik.export.live_recording import LiveRecording
from pinik.viewer.web.live_view import LiveView

LAP = 240  # steps of a 60th of a second in which the ball goes round its curve
WAY = 60  # steps in which it goes out of reach, and back
AWAY = 180  # steps for which it stays there
FAR = (1.1, 0.5, 0.9)  # [m]


def way_of_the_ball(home: NDArray[np.float64]) -> Iterator[NDArray[np.float64]]:
    """Two laps of a figure eight, then a visit to a place out of reach."""
    for angle in np.linspace(0.0, 4.0 * np.pi, 2 * LAP, endpoint=False):
        yield home + np.array([0.0, -0.3 * np.sin(angle), 0.15 * np.sin(2.0 * angle)])
    shares = np.concatenate([np.arange(WAY) / WAY, np.ones(AWAY), 1.0 - np.arange(WAY + 1) / WAY])
    for share in shares:
        yield home + share**2 * (3.0 - 2.0 * share) * (np.array(FAR) - home)


def play_methods(view: LiveView) -> None:
    """Let four arms chase a ball, with one iteration in each step."""
    view.send("iterations", until_reached=False, at_most=1)
    for place in way_of_the_ball(np.array(view.state["balls"][0]["position"])):
        view.move_ball(place)
        view.send("step")


def filmed(play: Callable[[LiveView], None], path: Path) -> LiveRecording:
    """Save what the live view shows meanwhile as a page, and return it."""
    with pinik.live("arm", ["ccd", "jt", "pinv", "dls"], port=0, running=False, motion="hand") as view:
        play(view)
        view.save_animation(path)
        return view.recording()


PLAYED: dict[str, Callable[[LiveView], None]] = {"methods": play_methods}
"""Name → what happens. The still is docs/images/live/NAME.png, and the animation live/NAME.html in the site."""

STILL = re.compile(r'<img alt="(?P<alt>[^"]*)" src="(?P<up>(?:\.\./)*)images/live/(?P<name>\w+)\.png"\s*/?>')


def with_animations(html: str) -> str:
    """Stills of animations become links to them."""
    return STILL.sub(_link, html)


def _link(still: re.Match[str]) -> str:
    if still["name"] not in PLAYED:
        return still.group()
    return f'<a class="plays" href="{still["up"]}live/{still["name"]}.html">{still.group()}</a>'
