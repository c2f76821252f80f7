"""All answers to one question as text: the joints, what is known of each branch, and the families."""

from __future__ import annotations

import numpy as np

from ...solving.branches import Branches
from ..terminal.output import emit, painted
from ..terminal.tables import emit_table
from ..terminal.units import Units, duration, length

__all__ = ["emit_branches"]

_COLUMNS = 8  # the number of branches beside each other


def emit_branches(branches: Branches, units: Units, families: bool = False) -> None:
    """Write the branches to stdout.

    Args:
        branches: The branches.
        units: The unit of angles.
        families: Whether to write the families on which they lie as well.
    """
    emit(painted(branches.message, "green" if branches.success else "red"))
    emit("")
    for first in range(0, len(branches), _COLUMNS):
        _emit_angles(branches, range(first, min(first + _COLUMNS, len(branches))), units)
        emit("")
    if branches:
        _emit_facts(branches, units)
        emit("")
    if families and branches:
        _emit_families(branches)
        emit("")
    emit(f"time      {duration(branches.time)}")
    emit(f"method    {branches.method}, {branches.engine} engine")


def _emit_angles(branches: Branches, shown: range, units: Units) -> None:
    """The values of the joints that move, with one column for each of some branches."""
    rows = []
    for name in branches.joint_names:
        joint = branches.robot.joint(name)
        rows.append([name, units.of(joint), *(units.show_scalar(branches.angles[k][name], joint) for k in shown)])
    numbers = [str(k + 1) for k in shown]
    emit_table(["branch", "", *numbers], rows, numeric=numbers)


def _emit_facts(branches: Branches, units: Units) -> None:
    """What else is known of each branch, with one row for each."""
    columns = {
        "branch": [str(k + 1) for k in range(len(branches))],
        "moves most": [name or "" for name in branches.farthest_joint],
        "by": [
            f"{length(distance)} m" if unit == "m" else f"{units.show_angle(distance)} {units.angle}"
            for distance, unit in zip(branches.distance.tolist(), branches.distance_unit, strict=True)
        ],
        "found by start": (branches.found_at + 1).astype(str),
        "hits": branches.hits.astype(str),
    }
    if branches.windings.any():
        ways = (branches.windings[:, :, 1] - branches.windings[:, :, 0] + 1).prod(axis=1, initial=1)
        columns["with whole turns"] = np.asarray(ways).astype(str)
    rows = list(zip(*columns.values(), strict=True))
    emit_table(list(columns), rows, numeric=[title for title in columns if title not in ("branch", "moves most")])


def _emit_families(branches: Branches) -> None:
    """Each family on a line, or why there is none."""
    for k, family in enumerate(branches.families):
        emit(f"family {k + 1}  {family}")
    if branches.families:
        return
    why = {
        None: "whether the answers lie on curves is not known",
        0: "the answers are isolated",
        1: "the curves cannot be traced",
    }.get(branches.redundancy, "the answers have more than one dimension")
    emit(f"no families: {why}")
