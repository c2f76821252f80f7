"""What `pinik reach` prints: maps, lists of targets and bases, as JSON and as text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...problem.targets import Target
from ...robot import Robot
from ...workspace.bases import Bases
from ...workspace.listed import ReachedTargets
from ...workspace.reach_map import ReachMap
from ...workspace.voxel_map import WORKSPACES
from ..terminal.output import emit
from ..terminal.tables import emit_table
from ..terminal.units import Units

__all__ = ["bases_fields", "emit_bases", "emit_map", "emit_targets", "map_fields", "targets_fields"]


def map_fields(reach: ReachMap, seconds: float, agreement: Mapping[str, float] | None = None) -> dict[str, Any]:
    """A map as JSON fields."""
    told_apart = WORKSPACES if reach.orientations.directions > 1 else WORKSPACES[:1]
    fields: dict[str, Any] = {
        "schema": 1,
        "robot": reach.robot,
        "frame": reach.frame,
        "relative_to": reach.relative_to,
        "tool": None if reach.tool is None else reach.tool.tolist(),
        "by": "sampling" if reach.samples else "solving",
        "samples": reach.samples,
        "cell_m": reach.grid.size,
        "origin": list(reach.grid.origin),
        "shape": list(reach.grid.shape),
        "directions": reach.orientations.directions,
        "rolls": reach.orientations.rolls,
        "axis": reach.orientations.axis.tolist(),
        "workspaces": {name: _workspace_fields(reach, name) for name in told_apart},
    }
    inside = reach.workspace("any")
    quantities = ["share", "manipulability", "room", *(["branches"] if reach.counts_branches else [])]
    for name in quantities:
        values = getattr(reach, name)[inside]
        fields[name] = {
            "mean": float(values.mean()) if len(values) else None,
            "largest": float(values.max()) if len(values) else None,
        }
    if agreement is not None:
        fields["agreement"] = dict(agreement)
    return fields | {"time_s": seconds}


def _workspace_fields(reach: ReachMap, name: str) -> dict[str, Any]:
    bounds = reach.bounds(name)
    return {
        "cells": int(reach.workspace(name).sum()),
        "volume_m3": reach.volume(name),
        "bounds": None if np.isnan(bounds).any() else bounds.tolist(),
    }


def emit_map(reach: ReachMap, agreement: Mapping[str, float] | None) -> None:
    """Print a map: a sentence, its workspaces, and how far two ways agree."""
    emit(str(reach))
    emit("")
    rows = []
    for name, own in map_fields(reach, 0.0)["workspaces"].items():
        box = ["-"] * 3
        if own["bounds"] is not None:
            box = [f"{low:.2f} .. {high:.2f}" for low, high in zip(*own["bounds"], strict=True)]
        rows.append([name, str(own["cells"]), f"{own['volume_m3']:.4g}", *box])
    emit_table(["workspace", "cells", "m³", "x [m]", "y [m]", "z [m]"], rows, numeric=("cells", "m³"))
    if agreement is not None:
        emit("")
        emit(
            f"both ways reach {agreement['both']:,} cells and orientations, only solving {agreement['only_this']:,}, "
            f"only sampling {agreement['only_other']:,}; of the cells they agree on {100.0 * agreement['cells']:.1f} %"
        )


def targets_fields(robot: Robot, targets: Sequence[Target], answer: ReachedTargets, seconds: float) -> dict[str, Any]:
    """A list of targets as JSON fields."""
    rows = []
    for k, target in enumerate(targets):
        rows.append(
            {
                **target.to_dict(),
                "reached": bool(answer.reached[k]),
                "score": float(answer.score[k]),
                "manipulability": float(answer.manipulability[k]),
                "room": float(answer.room[k]),
                "angles": robot.angles(answer.q[k]),
            }
        )
    return {
        "schema": 1,
        "robot": robot.name,
        "targets": rows,
        "success": answer.success,
        "reached": int(answer.reached.sum()),
        "mean_score": float(answer.score.mean()),
        "best_manipulability": answer.best,
        "time_s": seconds,
    }


def emit_targets(targets: Sequence[Target], answer: ReachedTargets) -> None:
    """Print a list of targets, one a row, and a summary."""
    rows = []
    for k, target in enumerate(targets):
        place = ["-"] * 3
        if target.position is not None:
            place = [f"{x:.4f}" if known else "-" for x, known in zip(target.position, target.along, strict=True)]
        numbers = [f"{answer.score[k]:.3f}", f"{answer.manipulability[k]:.4f}", f"{answer.room[k]:.3f}"]
        reached = bool(answer.reached[k])
        rows.append([str(k), *place, "yes" if reached else "no", *(numbers if reached else ["-"] * 3)])
    titles = ["target", "x [m]", "y [m]", "z [m]", "reached", "score", "manipulability", "room"]
    missed = np.flatnonzero(~answer.reached).tolist()
    emit_table(titles, rows, numeric=[title for title in titles if title != "reached"], marked=missed)
    emit("")
    emit(str(answer))


def bases_fields(reach: ReachMap, bases: Bases, seconds: float) -> dict[str, Any]:
    """Places for the base as JSON fields."""
    rows = []
    for k, place in enumerate(bases.placements):
        rows.append(
            {
                "position": place[:3, 3].tolist(),
                "yaw_rad": math.atan2(place[1, 0], place[0, 0]),
                "reached": int(bases.reached[k]),
                "solved": None if bases.solved is None else int(bases.solved[k]),
                "margin": float(bases.margin[k]),
            }
        )
    return {
        "schema": 1,
        "robot": reach.robot,
        "frame": reach.frame,
        "targets": bases.targets,
        "bases": rows,
        "time_s": seconds,
    }


def emit_bases(bases: Bases, units: Units) -> None:
    """Print places for the base, best first."""
    rows = []
    for k, place in enumerate(bases.placements):
        yaw = math.atan2(place[1, 0], place[0, 0])
        shown = f"{math.degrees(yaw):.1f}" if units.degrees else f"{yaw:.4f}"
        solved = "-" if bases.solved is None else str(bases.solved[k])
        x, y, z = (f"{number:.3f}" for number in place[:3, 3])
        rows.append([x, y, z, shown, solved, str(bases.reached[k]), f"{bases.margin[k]:.3f}"])
    titles = ["x [m]", "y [m]", "z [m]", f"yaw [{'deg' if units.degrees else 'rad'}]", "solved", "by map", "margin"]
    emit_table(titles, rows, numeric=titles)
    emit("")
    emit(str(bases))
