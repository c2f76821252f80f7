"""A configuration as JSON fields, the same in every command."""

from __future__ import annotations

from typing import Any

from ...robot import Robot

__all__ = ["configuration_fields"]


def configuration_fields(robot: Robot, q: Any) -> dict[str, Any]:
    """The fields "angles", "joint_placements" and "q"; as in a solution."""
    placements = robot.joint_placements(q)
    return {
        "angles": robot.angles(q),
        "joint_placements": {name: M.homogeneous.tolist() for name, M in placements.items()},
        "q": q.tolist(),
    }
