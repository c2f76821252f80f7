"""Obstacles and collisions in a session's set-up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...echoes import QUOTED, shortened
from ...errors import InputError
from ..simulation.session import Session

__all__ = ["collisions_messages", "obstacle_messages", "written_collisions", "written_obstacles"]

_MODES = {"off": (False, False), "on": (True, False), "avoid": (True, True)}


def written_collisions(session: Session) -> str:
    """Whether touches are looked for and avoided: "off", "on" or "avoid"."""
    now = (session.contacts.on, session.contacts.avoids)
    return next(mode for mode, switches in _MODES.items() if switches == now)


def collisions_messages(session: Session, mode: str) -> Iterator[dict[str, Any]]:
    """Yield the message that switches to a mode."""
    if mode not in _MODES:
        raise InputError(f"set-up: collisions must be off, on or avoid; got {shortened(mode, QUOTED)!r}")
    if mode != written_collisions(session):
        on, avoid = _MODES[mode]
        yield {"type": "collisions", "on": on, "avoid": avoid}


def written_obstacles(session: Session) -> list[list[Any]]:
    """The obstacles: [kind, size, position] of each, rounded to a tenth of a millimetre."""
    return [[o.kind, _rounded(o.size), _rounded(o.position)] for o in session.obstacles]


def obstacle_messages(session: Session, wanted: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield the messages that put down these obstacles instead of the present ones."""
    for entry in wanted:
        if not isinstance(entry, list) or len(entry) != 3:
            raise InputError(
                f"set-up: an obstacle must be [kind, size, position]; got {shortened(str(entry), QUOTED)!r}"
            )
    if wanted == written_obstacles(session):
        return
    for index in reversed(range(len(session.obstacles))):
        yield {"type": "remove_obstacle", "index": index}
    for kind, size, position in wanted:
        yield {"type": "add_obstacle", "kind": kind, "size": size, "position": position}


def _rounded(numbers: tuple[float, ...]) -> list[float]:
    return [round(number, 4) for number in numbers]
