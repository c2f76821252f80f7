"""Prepared scenes that show one thing each, as set-ups with two sentences."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple
from urllib.parse import quote, urlencode

__all__ = ["LESSONS", "setup_text"]


class Lesson(NamedTuple):
    """One lesson.

    Attributes:
        title: What it is about.
        text: Two sentences: what to look at, and why it is so.
        setup: The scene as a set-up, as in a link.
    """

    title: str
    text: str
    setup: str


def setup_text(**parts: Any) -> str:
    """A set-up as text; lists and objects become compact JSON."""
    written = {
        name: json.dumps(part, separators=(",", ":")) if isinstance(part, (list, dict)) else str(part)
        for name, part in parts.items()
    }
    return urlencode(written, quote_via=quote, safe=",:[]{}")


def _scene(robot: str, methods: str, **parts: Any) -> str:
    count = methods.count(",") + 1
    begin = {"robot": robot, "root": "fixed", "view": {1: 1, 2: 2}.get(count, 4), "methods": methods}
    return setup_text(**{**begin, "motion": "hand", **parts, "run": "on"})


def _damped(*dampings: float) -> dict[str, dict[str, Any]]:
    return {str(k): {"rule": "constant", "damping": damping} for k, damping in enumerate(dampings)}


LESSONS: Mapping[str, Lesson] = {
    "straight": Lesson(
        "Straight and stuck",
        "The arm is straight and the ball lies on its line, so no joint can bring the tip nearer by a small turn:"
        " Jᵀe is zero, and three methods stay where they are. CCD asks each joint for its best angle however far "
        "away it is, and the elbow turns by 180°, to the point nearest to the ball that this arm can reach.",
        _scene("double_pendulum_simple", "ccd,jt,pinv,dls", limits="off", balls=[["link3", "on", [0.0375, 0, 0.05]]]),
    ),
    "out-of-reach": Lesson(
        "Out of reach",
        "The ball is 24 cm too far away, so the arms stretch, with one iteration in every step, and one singular "
        "value goes to zero. The pseudo-inverse divides by it and swings for ever; damped least squares comes to "
        "rest at the nearest point.",
        _scene("arm", "pinv,dls", balls=[["tip", "on", [1.1, 0.5, 0.9]]], iterations=1),
    ),
    "damping": Lesson(
        "λ from 0 to large",
        "The four robots have λ = 0.001, 0.05, 0.3 and 2 m, and one iteration in every step. With almost no "
        "damping an arm that passes a singular pose swings by whole turns; the larger λ is, the smaller are the "
        "jumps, and the more iterations it takes.",
        _scene(
            "arm",
            "dls,dls,dls,dls",
            parameters=_damped(0.001, 0.05, 0.3, 2.0),
            motion="random",
            iterations=1,
            limits="off",
        ),
    ),
    "curl": Lesson(
        "Why CCD curls",
        "CCD begins at the tip, and the last joints use up the error before the first ones have their turn, so "
        "the arm curls at its end. Damped least squares shares the motion among all joints, because it minimises "
        "the sum of the squared changes.",
        _scene("arm", "ccd,dls", balls=[["tip", "on", [0.35, 0.35, 0.55]]]),
    ),
    "limits": Lesson(
        "Joint limits",
        "The ball is near the base, and every hinge of this arm turns by 45° at most: the amber rings mark those "
        "at a limit, and both arms miss it by 13 cm. Switch the joint limits off, and both reach it.",
        _scene("arm", "ccd,dls", balls=[["tip", "on", [0, 0, 0.2]]]),
    ),
    "paws": Lesson(
        "Three planted paws",
        "The lion's body is free, and pins hold three paws while the fourth reaches for its ball: four targets at "
        "once, in one Jacobian of twelve rows. Drag the ball, or switch a pin off, and see what else moves.",
        _scene(
            "lion",
            "dls",
            root="free_flyer",
            balls=[
                ["left_fore_paw", "on", [1.0, 0.16, -0.55]],
                *([paw, "pinned"] for paw in ("right_fore_paw", "left_hind_paw", "right_hind_paw")),
            ],
        ),
    ),
    "two-bones": Lesson(
        "Two bones in closed form",
        "For two bones the law of cosines gives the elbow's angle, so one step suffices wherever the ball is. The"
        " iteration beside it needs several after every jump of the ball, and now and then stalls at a limit.",
        _scene("two_link", "two_bone,dls", motion="random"),
    ),
}
"""Name → lesson, in the order of the menu."""
