"""The session's statistics as CSV, with the settings that they hold for."""

from __future__ import annotations

import csv
import io
import json
from typing import Any

from ..protocol.parameters import describe_parameters
from ..protocol.setup_balls import balls_text
from ..simulation.session import Session

__all__ = ["statistics_csv"]

_FIGURES = ("steps", "mean_time_s", "mean_iterations", "mean_joint_updates", "efficiency", "mean_error_m",
            "largest_jump_rad_or_m", "busy_steps", "cut_off_steps")  # fmt: skip


def statistics_csv(session: Session) -> str:
    """Return a header and one row per visible instance: its settings, and the figures that the table shows."""
    table = io.StringIO()
    writer = csv.writer(table)
    shared = _shared(session)
    writer.writerow(("instance", "robot", "method", "engine", "parameters", *shared, "statistics_over", *_FIGURES))
    for index, (instance, summary) in enumerate(zip(session.seen, session.summaries, strict=True)):
        own = {p["name"]: p["value"] for p in describe_parameters(instance.solver)}
        whose = (index, session.robot.name, instance.solver.name, instance.engine, json.dumps(own))
        writer.writerow((*whose, *shared.values(), session.scores.window, *summary))
    return table.getvalue()


def _shared(session: Session) -> dict[str, Any]:
    """Return the settings that hold for all instances: name → value, ready to be written."""
    settings, motion = session.settings, session.motion
    return {
        "root": session.robot.root,
        "motion": motion.kind,
        "curve": motion.curve if motion.kind == "curve" else "",
        "speed": "" if motion.kind == "hand" else motion.speed,
        "limits": "on" if settings.limits else "off",
        "polish": "on" if settings.polish else "off",
        "iterations_at_most": "" if settings.until_reached else settings.at_most,
        "tolerance_m": json.dumps(settings.tolerance.position),
        "tolerance_rad": settings.tolerance.orientation,
        "balls": balls_text(session),
    }
