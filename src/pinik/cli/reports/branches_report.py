"""All answers to one question as text: tables with one column for each branch."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...solving.branches import Branches
from ..terminal.output import emit, painted
from ..terminal.tables import emit_table
from ..terminal.units import Units, duration

__all__ = ["emit_branches"]

_COLUMNS = 8  # the number of branches beside each other


def emit_branches(branches: Branches, units: Units) -> None:
    """Write the branches to stdout."""
    emit(painted(branches.message, "green" if branches.success else "red"))
    emit("")
    for first in range(0, len(branches), _COLUMNS):
        _emit_table(branches, range(first, min(first + _COLUMNS, len(branches))), units)
        emit("")
    emit(f"time      {duration(branches.time)}")
    emit(f"method    {branches.method}, {branches.engine} engine")


def _emit_table(branches: Branches, shown: range, units: Units) -> None:
    """Some branches: the values of the joints that move, and what is known of each branch."""
    rows = []
    for name in branches.joint_names:
        joint = branches.robot.joint(name)
        values = [units.show_scalar(branches.angles[index][name], joint) for index in shown]
        rows.append([name, units.of(joint), *values])
    ways = (branches.windings[:, :, 1] - branches.windings[:, :, 0] + 1).prod(axis=1, initial=1)
    facts: dict[str, Any] = {
        "distance": [units.show_angle(float(distance)) for distance in branches.distance],
        "found by start": (branches.found_at + 1).astype(str),
        "hits": branches.hits.astype(str),
        "with whole turns": np.asarray(ways).astype(str),
    }
    if not branches.windings.any():
        del facts["with whole turns"]
    rows += [
        [name, units.angle * (name == "distance"), *[values[index] for index in shown]]
        for name, values in facts.items()
    ]
    numbers = [str(index + 1) for index in shown]
    emit_table(["branch", "", *numbers], rows, numeric=numbers)
