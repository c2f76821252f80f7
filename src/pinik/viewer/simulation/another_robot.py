"""A session that goes on with another robot."""

from __future__ import annotations

from ...motion.effectors import principal_frames
from ...robot import Robot
from .method_menu import fitting
from .session import Session

__all__ = ["with_robot"]


def with_robot(session: Session, robot: Robot) -> Session:
    """A session with another robot and the same settings, as far as they apply to that robot."""
    solvers, notes = fitting(
        [instance.solver for instance in session.instances], session.methods, robot, principal_frames(robot)
    )
    other = Session(robot, solvers, view=session.view, seed=session.seed, clock=session.clock)
    other.instances.methods = session.methods
    other.notes = notes
    other.running, other.misses.pause = session.running, session.misses.pause
    other.apply_settings(session.settings)
    other.motion.kind, other.motion.curve = session.motion.kind, session.motion.curve
    other.motion.speed = session.motion.speed
    other.looks = session.looks
    other.scores.cover(session.scores.window)
    other.set_contacts(session.contacts.on, session.contacts.avoids)
    other.set_obstacles(session.obstacles)
    return other
