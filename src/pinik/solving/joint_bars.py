"""Answers as HTML for notebooks: a sentence, and each joint as a bar between its limits."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..echoes import bounded
from ..model.robot_model import RobotModel

__all__ = ["joint_bars"]

Array = NDArray[np.float64]

_MOST_JOINTS = 40
_MOST_MARKS = 24
_WIDTH, _HEIGHT = 200, 14  # [px]
_EDGE = 3  # [px] between a bar's end and the picture's
_NEAR = 1e-6  # of a joint's range: so near to a limit it counts as at the limit
_MARK = "#2f80d8"
_AT_LIMIT = "#d97a00"


def joint_bars(
    robot: RobotModel, message: str, success: bool, angles: Array, names: Sequence[str] | None = None
) -> str:
    """A piece of HTML that needs no script and no style sheet, legible on white and on black.

    Args:
        robot: The robot.
        message: What came of the question, in one sentence.
        success: Whether that is good news.
        angles: Angles (n, len(names)) [rad or m]. With several rows each joint's bar has a mark for each, of evenly
            chosen ones if there are many, and a band over all of them.
        names: The joints, in the order of the angles; `robot.joint_names` when None.
    """
    from html import escape  # with its list of entities

    def cell(text: str, align: str = "left") -> str:
        return f'<td style="text-align:{align};padding:1px 8px;white-space:nowrap">{text}</td>'

    names = robot.joint_names if names is None else names
    limits = dict(zip(robot.joint_names, zip(robot.lower, robot.upper, strict=True), strict=True))
    shown = names[:_MOST_JOINTS] if len(angles) else ()
    rows = []
    for k, name in enumerate(shown):
        values, joint = angles[:, k], robot.joint(name)
        low, high = map(float, limits.get(name, (joint.lower, joint.upper)))
        unit = "m" if joint.slides() else "rad"
        ends = dict.fromkeys((_number(values.min()), _number(values.max())))
        rows.append(
            "<tr style='background:none'>" + cell(escape(bounded(name))) + cell(_number(low), "right")
            + cell(_bar(values, low, high)) + cell(_number(high)) + cell(f"<b>{' … '.join(ends)}</b> {unit}") + "</tr>"
        )  # fmt: skip
    more = len(names) - len(shown) if len(angles) else 0
    rest = f"<div>and {more} more joints</div>" if more else ""
    sign = "✓" if success else "✗"
    table = (
        f"<table style='border-collapse:collapse;color:inherit;font:inherit'>{''.join(rows)}</table>" if rows else ""
    )
    return f"<div><div>{sign} {escape(message)}</div>{table}{rest}</div>"


def _bar(values: Array, low: float, high: float) -> str:
    """One joint's bar as SVG. Without a limit it ends half a turn from 0, or beyond all values."""
    finite = values[np.isfinite(values)]
    left = low if math.isfinite(low) else min(-math.pi, float(finite.min(initial=0.0)))
    right = high if math.isfinite(high) else max(math.pi, float(finite.max(initial=0.0)))
    span = right - left or 1.0

    def x(value: float) -> float:
        part = min(max((value - left) / span, 0.0), 1.0)
        return round(_EDGE + part * (_WIDTH - 2 * _EDGE), 1)

    dashes = "" if math.isfinite(low) and math.isfinite(high) else ' stroke-dasharray="4 3"'
    middle = _HEIGHT / 2
    parts = [
        f'<line x1="{_EDGE}" x2="{_WIDTH - _EDGE}" y1="{middle}" y2="{middle}" stroke="currentColor" '
        f'stroke-opacity="0.35" stroke-width="2"{dashes}/>'
    ]
    if left < 0.0 < right:
        parts.append(
            f'<line x1="{x(0.0)}" x2="{x(0.0)}" y1="4" y2="{_HEIGHT - 4}" stroke="currentColor" stroke-opacity="0.5"/>'
        )
    if len(finite) > 1:
        first, last = x(finite.min()), x(finite.max())
        parts.append(
            f'<rect x="{first}" y="4" width="{round(last - first, 1)}" height="{_HEIGHT - 8}" fill="{_MARK}" '
            'fill-opacity="0.3"/>'
        )
    chosen = finite[np.unique(np.linspace(0, len(finite) - 1, _MOST_MARKS).round().astype(int))] if len(finite) else ()
    for value in {x(value): value for value in chosen}.values():
        at_limit = value - left <= _NEAR * span if math.isfinite(low) else False
        at_limit |= right - value <= _NEAR * span if math.isfinite(high) else False
        color = _AT_LIMIT if at_limit else _MARK
        parts.append(f'<rect x="{round(x(value) - 1.5, 1)}" y="1" width="3" height="{_HEIGHT - 2}" fill="{color}"/>')
    return (
        f'<svg width="{_WIDTH}" height="{_HEIGHT}" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        f'style="vertical-align:middle">{"".join(parts)}</svg>'
    )


def _number(value: float) -> str:
    """A number with three places; nothing for a limit that does not exist."""
    return f"{value + 0.0:.3f}".replace("-0.000", "0.000").replace("-", "−") if math.isfinite(value) else ""
