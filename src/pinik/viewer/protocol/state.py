"""The `hello` and `state` messages: what a page can choose, and the session's settings and results."""

from __future__ import annotations

import dataclasses
from typing import Any

from ...description.catalog import catalog
from ...motion.curves import CURVES
from ...solvers.base import Solver
from ...solvers.distinctions import distinctions
from ..simulation.instances import VIEWS
from ..simulation.looks import LOOKS
from ..simulation.motion import MOTIONS
from ..simulation.session import STEPS_PER_SECOND, Session
from ..simulation.standing import STATUSES
from ..simulation.statistics import WINDOWS, Summary
from ..simulation.swinging import LOOKED_AT, swinging
from .led import placements
from .lessons import LESSONS
from .messages import FARTHEST, RANGES
from .parameters import describe_parameters, tolerance_of
from .robots import ROOTS
from .thesis_walk import published_table

__all__ = ["hello_message", "session_state"]


def hello_message(version: str, methods: dict[str, type[Solver]], own_robots: list[str], server: str) -> dict[str, Any]:
    """Return the `hello` message: everything that a page can choose.

    Args:
        version: pinik's version.
        methods: Short name → class of every method.
        own_robots: Names of robots that are not in the catalogue.
        server: A word by which pages tell this server from one that is started after it.
    """
    return {
        "type": "hello",
        "schema": 1,
        "version": version,
        "server": server,
        "robots": [*own_robots, *catalog()],
        "roots": list(ROOTS),
        "methods": [{"name": name, "title": cls.title, "help": cls.about} for name, cls in methods.items()],
        "motions": [{"name": name, "title": title} for name, title in MOTIONS.items()],
        "curves": [{"name": name, "title": curve.title} for name, curve in CURVES.items()],
        "views": list(VIEWS),
        "windows": [{"name": name, "title": title} for name, title in WINDOWS.items()],
        "looks": [{"name": name, **look._asdict()} for name, look in LOOKS.items()],
        "ranges": {**{name: list(ends) for name, ends in RANGES.items()}, "reach": FARTHEST},
        "lessons": [{"name": name, **lesson._asdict()} for name, lesson in LESSONS.items()],
        "thesis": published_table(),
        "statuses": list(STATUSES),
        "steps_per_second": STEPS_PER_SECOND,
    }


def session_state(session: Session) -> dict[str, Any]:
    """Return the `state` message without what the server adds: generation, pace, loading, watched, command, set-up."""
    settings, motion = session.settings, session.motion
    told_apart = distinctions([instance.solver for instance in session.seen])
    return {
        "type": "state",
        "schema": 1,
        "robot": session.robot.name,
        "root": session.robot.root,
        "view": session.view,
        "looks": list(session.looks),
        "running": session.running,
        "motion": motion.kind,
        "curve": motion.curve,
        "speed": motion.speed,
        "limits": settings.limits,
        "polish": settings.polish,
        "iterations": {"until_reached": settings.until_reached, "at_most": settings.at_most},
        "tolerance": settings.tolerance._asdict(),
        "pause_on_miss": session.misses.pause,
        "missed": session.misses.last,
        "led": sorted(session.leading.among(session.balls.targets)),
        "step": session.steps,
        "window": session.scores.window,
        "balls": [
            {
                "frame": ball.frame,
                "mode": ball.mode,
                "position": ball.position.tolist(),
                "rpy": ball.rpy.tolist(),
                "oriented": ball.oriented,
                "free": ball.free,
                "tolerance": tolerance_of(ball),
                "curve": motion.path(ball).round(4).tolist(),
            }
            for ball in session.balls
        ],
        "collisions": {
            "on": session.contacts.on,
            "avoid": session.contacts.avoids,
            "loading": session.contacts.waits,
            "why_not": session.contacts.why_not,
        },
        "obstacles": [dataclasses.asdict(obstacle) for obstacle in session.obstacles],
        "instances": [
            {**_instance_state(session, index, summary), "distinction": distinction}
            for index, (summary, distinction) in enumerate(zip(session.summaries, told_apart, strict=True))
        ],
        "joint_names": list(session.robot.joint_names),
        "methods": session.offered,
    }


def _instance_state(session: Session, index: int, summary: Summary) -> dict[str, Any]:
    instance = session.seen[index]
    verdict = instance.verdict(session.balls.targets)
    swings = swinging(instance.solver, session.scores.newest(index, LOOKED_AT))
    return {
        "method": instance.solver.name,
        "title": instance.solver.title,
        "parameters": describe_parameters(instance.solver),
        "engine": instance.engine,
        **verdict._asdict(),
        "message": f"{verdict.message}; {swings}" if swings else verdict.message,
        "active_limits": list(verdict.active_limits),
        "touching": [list(pair) for pair in instance.contacts.touching(instance.q)],
        "angles": instance.robot.angles(instance.q),
        "placements": placements(instance.robot, instance.q),
        "statistics": summary._asdict(),
    }
