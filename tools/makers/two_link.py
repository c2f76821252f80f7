"""The planar arm of two hinges: a small plotter on the table, its pen on the plane z = 0."""

from __future__ import annotations

import math

from .description import Collision, Description, Visual, box, cylinder, mesh_visual
from .sculpt import Mesh, joined, lathe, plate

UPPER, LOWER = 0.5, 0.4  # [m], the lengths
MATERIALS = {
    "teal": (0.05, 0.47, 0.45),
    "silver": (0.82, 0.83, 0.84),
    "graphite": (0.16, 0.17, 0.19),
    "orange": (0.95, 0.48, 0.10),
}
# Heights above the table [m]: the first link's underside, its top and the second's underside, its top.
LOW, MIDDLE, HIGH = 0.055, 0.100, 0.140
SHOULDER, ELBOW, WRIST = 0.058, 0.048, 0.032  # [m], radii


def _beam(length: float, radius: float, end_radius: float, bottom: float, top: float) -> Mesh:
    """A link seen from above: two round ends and their common tangents."""
    turn = math.acos((radius - end_radius) / length)
    steps = [k / 9 for k in range(10)]
    start = [turn + t * (2 * math.pi - 2 * turn) for t in steps]
    end = [-turn + t * 2 * turn for t in steps]
    outline = [(radius * math.cos(a), radius * math.sin(a)) for a in start]
    outline += [(length + end_radius * math.cos(a), end_radius * math.sin(a)) for a in end]
    return plate(outline, bottom, top, 0.006)


def _disc(radius: float, bottom: float, top: float, bevel: float = 0.004) -> Mesh:
    inner = radius - bevel
    return lathe(
        [(0, bottom), (inner, bottom), (radius, bottom + bevel), (radius, top - bevel), (inner, top), (0, top)]
    )


def _shapes() -> dict[str, dict[str, Mesh]]:
    """For each link its surfaces by material."""
    foot = lathe(
        [(0, 0), (0.115, 0), (0.115, 0.010), (0.110, 0.015), (0.070, 0.018), (0.052, 0.030), (0.050, LOW), (0, LOW)]
    )
    pen = lathe([(0, 0), (0.0015, 0), (0.006, 0.020), (0.006, 0.026), (0, 0.026)], 20)
    top = HIGH + 0.030
    holder = lathe(
        [(0, 0.024), (0.009, 0.024), (0.013, 0.034), (0.013, top), (0.010, top + 0.004), (0, top + 0.004)], 18
    )
    spacer = _disc(0.042, MIDDLE - 0.004, MIDDLE + 0.004)
    return {
        "base": {"graphite": foot},
        "link1": {
            "teal": _beam(UPPER, SHOULDER, ELBOW, LOW + 0.002, MIDDLE),
            "graphite": joined([_disc(0.040, MIDDLE - 0.002, MIDDLE + 0.010), spacer.moved((UPPER, 0, 0))]),
            "orange": _disc(0.018, MIDDLE, MIDDLE + 0.014),
        },
        "link2": {
            "silver": _beam(LOWER, ELBOW, WRIST, MIDDLE + 0.003, HIGH),
            "graphite": joined([_disc(0.032, HIGH - 0.002, HIGH + 0.009), holder.moved((LOWER, 0, 0))]),
            "orange": joined([_disc(0.015, HIGH, HIGH + 0.013), pen.moved((LOWER, 0, 0))]),
        },
    }  # fmt: skip


def _solids() -> dict[str, list[Collision]]:
    """For each link what can touch others: its beam with its round ends, and the pen's tip on the table."""

    def beam(length: float, radius: float, end_radius: float, bottom: float, top: float) -> list[Collision]:
        width = 2 * min(radius, end_radius)
        return [
            box((length, width, top - bottom), (length / 2, 0.0, (bottom + top) / 2)),
            cylinder(radius, (0.0, 0.0, bottom), (0.0, 0.0, top)),
            cylinder(end_radius, (length, 0.0, bottom), (length, 0.0, top)),
        ]

    return {
        "base": [
            cylinder(0.115, (0.0, 0.0, 0.0), (0.0, 0.0, 0.018)),
            cylinder(0.052, (0.0, 0.0, 0.018), (0.0, 0.0, LOW)),
        ],
        "link1": beam(UPPER, SHOULDER, ELBOW, LOW + 0.002, MIDDLE),
        "link2": [
            *beam(LOWER, ELBOW, WRIST, MIDDLE + 0.003, HIGH),
            cylinder(0.013, (LOWER, 0.0, 0.0), (LOWER, 0.0, HIGH + 0.034)),
        ],
    }


def build() -> Description:
    robot = Description("two_link", "A planar arm of two hinges in the world's x-y plane.", MATERIALS)
    for link, surfaces in _shapes().items():
        visuals: list[Visual] = []
        for material, shape in surfaces.items():
            path = f"meshes/two_link/{link}_{material}.obj"
            robot.files[path] = shape.obj()
            visuals.append(mesh_visual(path, material))
        robot.link(link, visuals)
    robot.link("tip")
    for link, solids in _solids().items():
        robot.solid(link, solids)
    limits = (-math.pi, math.pi)
    robot.revolute("joint1", "base", "link1", axis=(0, 0, 1), limits=limits)
    robot.revolute("joint2", "link1", "link2", axis=(0, 0, 1), limits=limits, xyz=(UPPER, 0, 0))
    robot.fixed("link2", "tip", xyz=(LOWER, 0, 0))
    robot.pose("relaxed", joint1=25, joint2=60)
    robot.pose("reach", joint1=-20, joint2=35)
    return robot
