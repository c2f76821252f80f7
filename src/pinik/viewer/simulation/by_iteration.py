"""The session stopped, and taken on iteration by iteration, from where robots are or from where they begin."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ...errors import InputError
from .session import Session

__all__ = ["line_up", "step_iteration"]


def step_iteration(session: Session, instance: int | None = None) -> None:
    """Stop, and let one visible instance, or all, take one iteration towards the balls, which stay where they are.

    Raises:
        InputError: There is no such visible instance.
    """
    chosen = session.seen if instance is None else [session.instances.visible(instance)]
    session.running = False
    session.stillness.end()
    for one in chosen:
        one.step_iteration(session.balls.targets)


def line_up(session: Session, position: ArrayLike) -> None:
    """Stop, with all robots in the pose in which they begin, and the first ball that is on at a position (3,) [m].

    Raises:
        InputError: The position is not three finite numbers, or no ball is on.
    """
    index = next((k for k, ball in enumerate(session.balls) if ball.mode == "on"), None)
    if index is None:
        raise InputError("no ball is on")
    session.move_ball(index, position)
    session.running = False
    session.stillness.end()
    for one in session.instances:
        one.put(session.home)
    session.scores.begin_anew(session.view)
