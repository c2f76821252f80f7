"""What `pinik compare` prints: its JSON object, and its table."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ...robot import Robot
from ...studies.comparison import CURVE, Row
from ...studies.thesis import PRESETS, Contest, Mismatch, mismatch, published
from ..terminal import output
from ..terminal.tables import emit_table

__all__ = ["comparison_fields", "emit_comparison"]


def comparison_fields(robot: Robot, chosen: Contest, rows: Sequence[Row], steps: int, seed: int) -> dict[str, Any]:
    """The JSON object; docs/json.md explains its fields."""
    return {
        "schema": 1,
        "robot": robot.name,
        "frame": chosen.frame,
        "preset": chosen.preset,
        "reading": chosen.reading,
        "about": PRESETS[chosen.preset][chosen.reading],
        "steps": steps,
        "seed": seed,
        "pieces": chosen.rules.pieces,
        "rest_steps": chosen.rules.rest,
        "curve": CURVE,
        "steps_a_lap": chosen.rules.lap,
        "bones": chosen.bones,
        "joints": chosen.joints,
        "chain_length_m": chosen.chain_length,
        "unit_m": chosen.unit,
        "tolerance_m": chosen.rules.tolerance.position,
        "max_iterations": chosen.rules.max_iterations,
        "restarts": chosen.rules.restarts,
        "parameters": {name: dict(solver.parameters) for name, solver in chosen.solvers.items()},
        "rows": [_row_fields(row) for row in rows],
        "mismatch": _mismatch_fields(mismatch(rows)),
        "mismatch_in_box": _mismatch_fields(mismatch(rows, box=True)),
    }


def _mismatch_fields(off: Mismatch | None) -> dict[str, float] | None:
    return None if off is None else {"efficiency_points": off.efficiency, "iterations_factor": off.iterations}


def _row_fields(row: Row) -> dict[str, Any]:
    cell = published(row)
    theirs = None
    if cell is not None:
        theirs = {"time_s": cell.time, "iterations": cell.iterations, "efficiency": cell.efficiency}
    return {
        "comparison": row.comparison.name,
        "motion": row.comparison.motion,
        "limits": row.comparison.limits,
        "method": row.method,
        "engine": row.engine,
        "time_s": row.time,
        "iterations": row.iterations,
        "joint_updates": row.joint_updates,
        "counted_iterations": row.counted,
        "efficiency": row.efficiency,
        "error_m": row.error,
        "largest_error_m": row.largest_error,
        "jump": row.jump,
        "largest_jump": row.largest_jump,
        "thesis": theirs,
        "time_of_thesis": None if cell is None else row.time / cell.time,
    }


_NOTES = (
    "All values are means over the steps. N: iterations as the thesis counts them, at least 1 (turned bones for ccd, "
    "iterations for the others). iterations: sweeps for ccd; joints: single joints that a sweeping method updated. "
    "jump: the largest change of one joint in a step (rad, or m if it slides). time %: time relative to the thesis, "
    "which ran on another machine. b: places from a box, some out of reach; the thesis does not say whether its places "
    "were reachable."
)
_TITLES = (
    "", "ball", "limits", "method", "ms", "N", "iterations", "joints", "η %", "error mm", "jump", "largest",
    "thesis ms", "thesis N", "thesis η %", "time %",
)  # fmt: skip


def emit_comparison(answer: Mapping[str, Any]) -> None:
    """Write the table to stdout.

    Args:
        answer: What `comparison_fields` returned.
    """
    output.emit(
        f"{answer['robot']}, {answer['frame']}: preset {answer['preset']}, reading {answer['reading']}: "
        f"{answer['about']}"
    )
    output.emit(
        f"{answer['steps']} steps a row; tolerance {1000 * answer['tolerance_m']:.3g} mm; "
        f"{answer['bones']} bones, {answer['joints']} joints, {answer['chain_length_m']:.3g} m; "
        f"one of the thesis's units is {answer['unit_m']:.3g} m"
    )
    output.emit("")
    numeric = {title for title in _TITLES if title not in ("", "ball", "limits", "method")}
    emit_table(_TITLES, [_texts(row) for row in answer["rows"]], numeric=numeric)
    output.emit("")
    output.emit(textwrap.fill(_NOTES, 100))
    if answer["preset"] == "thesis":
        for key, words in (("mismatch", "1 to 4"), ("mismatch_in_box", "1, 2b, 3, 4b")):
            if (off := answer[key]) is not None:
                output.emit(
                    f"Mean difference from the thesis in {words}: {off['efficiency_points']:.0f} points of efficiency, "
                    f"a factor of {off['iterations_factor']:.1f} in iterations."
                )


def _texts(row: Mapping[str, Any]) -> tuple[str, ...]:
    cell = row["thesis"]
    theirs = ("", "", "", "")
    if cell is not None:
        theirs = (
            f"{1000 * cell['time_s']:.1f}",
            f"{cell['iterations']:.0f}",
            f"{100 * cell['efficiency']:.0f}",
            f"{100 * row['time_of_thesis']:.2f}",
        )
    return (
        row["comparison"],
        row["motion"],
        "on" if row["limits"] else "off",
        row["method"],
        f"{1000 * row['time_s']:.4f}",
        f"{row['counted_iterations']:.1f}",
        f"{row['iterations']:.1f}",
        f"{row['joint_updates']:.1f}" if row["joint_updates"] else "",
        f"{100 * row['efficiency']:.1f}",
        f"{1000 * row['error_m']:.3f}",
        f"{row['jump']:.2f}",
        f"{row['largest_jump']:.2f}",
        *theirs,
    )
