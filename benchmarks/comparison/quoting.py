"""What stands above the tables: how they may be read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .peer import Peer
from .verdicts import NEAR

__all__ = ["read_before_quoting"]


def read_before_quoting(about: dict[str, Any], peers: Sequence[Peer], noise: tuple[float, float] | None) -> list[str]:
    """The points to read before a figure is quoted, one string each.

    Args:
        about: What `peers.py` knows about the run: date, machine, core, python, seed, budget_seconds.
        peers: The rows of the tables.
        noise: By how much the machine changed in the whole run [%]; None before it is known.
    """
    careless = sorted({peer.label for peer in peers if peer.lacks.startswith("no limits")})
    if noise is None:
        changed = "How much the machine changed meanwhile stands above each table and at the end."
    else:
        changed = (
            f"The same piece of work, timed before every turn of every library, took {noise[0]:+.0f} % to "
            f"{noise[1]:+.0f} % of its median time (10th and 90th percentile)."
        )
    pinned = "No process was kept on one core."
    if about["core"] is not None:
        free = "; ".join(peer.label for peer in peers if peer.threads > 1)
        pinned = f"Rows of one thread ran on core {about['core']} alone"
        pinned += f", and on all cores: {free}." if free else "."
    points = [
        f"Measured on {about['date']}: {about['machine']}, Python {about['python']}, seed {about['seed']}. {changed} "
        "Differences smaller than that mean nothing. Times differ between machines: compare rows of one table.",
        f"{pinned} One library works at a time, and they take turns. One that used up its "
        f"{about['budget_seconds']:g} s answered only the first targets.",
        "All rows of a table get the same poses and the same starts; on a path each library starts from its own last "
        f"answer. They are asked for {1e-4:g} m and {1e-3:g} rad where a row names no other tolerance.",
        "Times are those of one call, in microseconds, from a 4×4 numpy array and a numpy array of joint values to "
        "joint values. Loading, preparing and the first calls are not timed. Failed calls count like all others, so a "
        "time belongs to the share of targets beside it. A row that answers all targets in one call has its time "
        "divided by their number as median and mean.",
        "Plain Pinocchio judges every answer, whatever the library says. *placed*: the tip is within "
        f"{1e3 * NEAR[0]:g} mm and {NEAR[1]:g} rad of its target. *solved*: placed, with every joint inside its "
        "limits. *strict*: solved, and within the tolerance that was asked for. Each library is timed only after the "
        "judge has seen that it means the same frames and joints.",
        "A closed form exists for some arms only, and other libraries read some robots only: the last column says what "
        "a row does not do, and a skipped row says why.",
    ]
    if careless:
        points.append(
            f"These rows know no joint limits: {'; '.join(careless)}. Where *placed* is larger than *solved*, the "
            "difference is answers that no robot can take."
        )
    return points
