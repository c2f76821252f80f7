"""The balls of a session in a set-up's text."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from ...errors import InputError
from ..simulation.ball import Ball
from ..simulation.session import Session
from .messages import FARTHEST
from .parameters import tolerance_of

__all__ = ["ball_messages", "balls_text"]


def balls_text(session: Session) -> str:
    """Return what a link says about all balls: a JSON list with one list for each."""
    return json.dumps([_ball(session, index) for index in range(len(session.balls))], separators=(",", ":"))


def _ball(session: Session, index: int) -> list[Any]:
    """Return [frame, mode, position, rpy, extra].

    The position is null if the motion or a pose decides it, and rpy is null if it is not asked for. `extra` is an
    object with the free axes and the ball's own tolerance, if there are any. What is null or empty at the end is left
    out.
    """
    ball = session.balls[index]
    led = bool(session.leading.among(session.balls.targets))
    moved = led or ball.mode == "off" or (session.motion.kind != "hand" and ball.mode == "on")
    position = None if moved else _position(ball)
    rpy = [round(float(x), 4) for x in ball.rpy] if ball.oriented else None
    extra: dict[str, Any] = {"free": ball.free} if ball.free else {}
    if ball.tolerance is not None:
        extra["tolerance"] = tolerance_of(ball)
    parts = [ball.frame, ball.mode, position, rpy, extra or None]
    while parts[-1] is None:
        parts.pop()
    return parts


def ball_messages(session: Session, balls: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield the balls' frames first, so that every ball has its number, then what each ball asks for."""
    for ball in balls:
        if not (isinstance(ball, list) and 2 <= len(ball) <= 5 and _is_extra(ball[4:])):
            raise InputError(f"set-up: a ball must be [frame, mode, position, rpy, {{free, tolerance}}]; got {ball!r}")
    wanted = [ball[0] for ball in balls]
    if not wanted:
        raise InputError("set-up: balls must contain at least one ball")
    yield from _removals(session, wanted)
    for frame in wanted:
        if frame not in session.balls.frames:
            yield {"type": "add_effector", "frame": frame}
        yield from _removals(session, wanted)  # a ball that had to stay as the last one can go now
    session.balls.arrange(wanted)
    for frame, mode, position, rpy, extra in ([*ball, None, None, None][:5] for ball in balls):
        index = session.balls.frames.index(frame)
        here = session.balls[index]
        if here.mode != mode:
            yield {"type": "effector", "index": index, "mode": mode}
        if position is not None and position != _position(here):
            yield {"type": "ball", "index": index, "position": position}
        yield from _asked(index, here, rpy, **(extra or {}))


def _position(ball: Ball) -> list[float]:
    """Where a ball is, to a tenth of a millimetre. One that a pose took farther than a link may say is at the edge."""
    return [round(min(max(float(x), -FARTHEST), FARTHEST), 4) for x in ball.position]


def _is_extra(parts: list[Any]) -> bool:
    return all(isinstance(extra, dict) and set(extra) <= {"free", "tolerance"} for extra in parts)


def _asked(index: int, here: Ball, rpy: Any, free: Any = "", tolerance: Any = None) -> Iterator[dict[str, Any]]:
    """Yield the changes to what a ball asks for. The order keeps it asking for something at every moment."""
    release = {"type": "free", "index": index, "axes": free}
    turns = (rpy is not None) != here.oriented or rpy not in (None, [round(float(x), 4) for x in here.rpy])
    if free != here.free and rpy is None:
        yield release
    if turns:
        angles = here.rpy.tolist() if rpy is None else rpy
        yield {"type": "orientation", "index": index, "on": rpy is not None, "rpy": angles}
    if free != here.free:
        yield release
    if tolerance != tolerance_of(here):
        yield {"type": "ball_tolerance", "index": index, "tolerance": tolerance}


def _removals(session: Session, wanted: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield the removal of every ball whose frame is not wanted; one ball always stays."""
    for index in reversed(range(len(session.balls))):
        if session.balls[index].frame not in wanted and len(session.balls) > 1:
            yield {"type": "remove_effector", "index": index}
