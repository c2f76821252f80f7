"""Pictures that move: saved animations of the live view, which play in a page without a server.

In Markdown each is a still picture, and in the site a link around it, in which docs/assets/plays.js plays it.
`python tools/draw_stills.py` takes the stills.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

import pinik
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.show import Show

LAP = 240  # steps of a 60th of a second in which the ball goes round its curve
WAY = 60  # steps in which it goes out of reach, and back
AWAY = 180  # steps for which it stays there
FAR = (0.6, -0.3, 1.3)  # [m]


def way_of_the_ball(home: NDArray[np.float64]) -> Iterator[NDArray[np.float64]]:
    """Two laps of a figure eight, then a visit to a place out of reach."""
    for angle in np.linspace(0.0, 4.0 * np.pi, 2 * LAP, endpoint=False):
        yield home + np.array([0.0, -0.3 * np.sin(angle), 0.15 * np.sin(2.0 * angle)])
    shares = np.concatenate([np.arange(WAY) / WAY, np.ones(AWAY), 1.0 - np.arange(WAY + 1) / WAY])
    for share in shares:
        yield home + share**2 * (3.0 - 2.0 * share) * (np.array(FAR) - home)


def play_methods(show: Show) -> None:
    """Let four arms chase a ball, with one iteration in each step."""
    show.do({"type": "iterations", "until_reached": False, "at_most": 1})
    for place in way_of_the_ball(show.session.balls[0].position):
        show.do({"type": "ball", "index": 0, "position": place.tolist()})
        show.do({"type": "step"})


def filmed(play: Callable[[Show], None]) -> Show:
    """A live view without a server, in which this has happened."""
    session = Session(pinik.load("arm"), ["ccd", "jt", "pinv", "dls"])
    show = Show(session, lambda work, then: then(work()), pinik.__version__)
    play(show)
    return show


PLAYED: dict[str, Callable[[Show], None]] = {"methods": play_methods}
"""Name → what happens. The still is docs/images/live/NAME.png, and the animation live/NAME.html in the site."""

STILL = re.compile(r'<img alt="(?P<alt>[^"]*)" src="(?P<up>(?:\.\./)*)images/live/(?P<name>\w+)\.png"\s*/?>')


def with_animations(html: str) -> str:
    """Stills of animations become links to them."""
    return STILL.sub(_link, html)


def _link(still: re.Match[str]) -> str:
    if still["name"] not in PLAYED:
        return still.group()
    return f'<a class="plays" href="{still["up"]}live/{still["name"]}.html">{still.group()}</a>'
