"""The session's statistics as CSV."""

from __future__ import annotations

import csv
import io

from ..simulation.session import Session

__all__ = ["statistics_csv"]

_FIGURES = ("steps", "mean_time_s", "mean_iterations", "mean_joint_updates", "efficiency", "mean_error_m",
            "largest_jump_rad_or_m")  # fmt: skip


def statistics_csv(session: Session) -> str:
    """Return a header and one row per visible instance."""
    table = io.StringIO()
    writer = csv.writer(table)
    writer.writerow(("instance", "robot", "method", "motion", "limits", *_FIGURES))
    for index, instance in enumerate(session.seen):
        limits = "on" if session.settings.limits else "off"
        setting = (index, session.robot.name, instance.solver.name, session.motion.kind, limits)
        writer.writerow((*setting, *instance.statistics.summary()))
    return table.getvalue()
