"""The thesis's four comparisons as set-ups of a session, and its published table for the page."""

from __future__ import annotations

from typing import Any, NamedTuple

from ...errors import InputError, UnknownNameError
from ...studies.comparison import COMPARISONS, CURVE, HOME_PHASE
from ...studies.readings import PRESETS
from ...studies.thesis import ITERATIONS, TABLE, Contest, contest
from ..simulation.session import Session
from .lessons import setup_text
from .parameters import changed_parameters
from .setup import Setup, read_setup

__all__ = ["Walk", "published_table", "walk_to"]

_EVERY_STEP = 100  # the speed at which a random ball jumps in every step, as in the thesis
_TITLES = {"1": "curve, no limits", "2": "random places, no limits", "3": "curve, limits", "4": "random places, limits"}


class Walk(NamedTuple):
    """One comparison as a set-up.

    Attributes:
        setup: The set-up.
        phase: The part of the lap at which the ball begins: where the frame is, so that no step begins with a leap.
        joints_per_bone: How many of the robot's joints one of the thesis's bones has; it counts bones for CCD.
    """

    setup: Setup
    phase: float
    joints_per_bone: float


def published_table() -> dict[str, Any]:
    """Table 4.1 for the page: the comparisons with their titles, and the published figures of each method."""
    return {
        "comparisons": [{"number": number, "title": title} for number, title in _TITLES.items()],
        "methods": [
            {"name": method, "published": [cells[number]._asdict() for number in _TITLES]}
            for method, cells in TABLE.items()
        ],
        "presets": list(PRESETS),
    }


def walk_to(session: Session, number: str, preset: str) -> Walk:
    """The set-up of a comparison for the session's robot and its first ball.

    The preset "thesis" has the thesis's parameters, and "tuned" pinik's own; either has the thesis's tolerance and
    number of iterations, scaled to the robot.

    Raises:
        UnknownNameError: There is no such comparison or preset.
        InputError: The chain of joints that moves the ball's frame has no length.
    """
    found = {comparison.name: comparison for comparison in COMPARISONS if comparison.name in _TITLES}
    if number not in found:
        raise UnknownNameError("comparison", number, found)
    frame = session.balls[0].frame
    asked = contest(session.robot, frame, preset, "thesis-tolerance" if preset == "tuned" else None)
    comparison = found[number]
    curve = {"curve": CURVE} if comparison.motion == "curve" else {"speed": _EVERY_STEP}
    tolerance = asked.rules.tolerance
    text = setup_text(
        robot=session.robot.name,
        root=session.robot.root,
        view=4,
        methods=",".join(TABLE),
        parameters=_parameters(asked),
        motion=comparison.motion,
        **curve,
        limits="on" if comparison.limits else "off",
        iterations=ITERATIONS,
        tolerance=f"{tolerance.farthest!r},{tolerance.orientation!r}",
        balls=[[frame, "on"]],
        run="on",
    )
    if asked.bones == 0:
        raise InputError(f"no joint moves {frame!r}")
    return Walk(read_setup(text), HOME_PHASE, asked.joints / asked.bones)


def _parameters(asked: Contest) -> dict[str, dict[str, Any]]:
    """Instance → its method's parameters that are not the defaults."""
    changed = {str(k): changed_parameters(asked.solvers[method]) for k, method in enumerate(TABLE)}
    return {k: parameters for k, parameters in changed.items() if parameters}
