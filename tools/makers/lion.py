"""A lion: pelvis, spine, chest, neck, head and jaw, a tail of six segments, four legs of six hinges.

With every angle at zero it stands, and every frame but the tail's is aligned with the world: x forward, y left, z up.
A pitch swings about y, a yaw about z, a roll about x, on both sides alike; the right side's limits mirror the left's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from . import lion_shapes, lion_solids
from .description import Description, Vector, mesh_visual
from .lion_anatomy import (
    CHEST,
    FORE_LEG,
    HEAD,
    HIND_LEG,
    JAW,
    NECK,
    NOSE,
    PELVIS,
    SPINE,
    TAIL,
    TAIL_DROOP,
    TAIL_SEGMENT,
)
from .lion_poses import POSES
from .lion_shapes import Surfaces

AXES: dict[str, Vector] = {"roll": (1, 0, 0), "pitch": (0, 1, 0), "yaw": (0, 0, 1)}
Hinge = tuple[str, float, float]  # axis, lower and upper limit [deg] (of the left side)

# Positive pitch lowers a part that points forward, and swings a hanging part backward.
SPINE_HINGES: list[Hinge] = [("yaw", -20, 20), ("pitch", -30, 30), ("roll", -15, 15)]
CHEST_HINGES: list[Hinge] = [("yaw", -20, 20), ("pitch", -30, 25)]
NECK_HINGES: list[Hinge] = [("yaw", -40, 40), ("pitch", -40, 50)]
HEAD_HINGES: list[Hinge] = [("yaw", -40, 40), ("pitch", -40, 60), ("roll", -30, 30)]
JAW_HINGES: list[Hinge] = [("pitch", -3, 45)]
TAIL_HINGES: list[Hinge] = [("yaw", -30, 30), ("pitch", -35, 35)]
SHOULDER_HINGES: list[Hinge] = [("yaw", -20, 30), ("roll", -15, 40), ("pitch", -95, 45)]
ELBOW_HINGES: list[Hinge] = [("pitch", -105, 20)]
WRIST_HINGES: list[Hinge] = [("pitch", -30, 90)]
FORE_TOES_HINGES: list[Hinge] = [("pitch", -60, 60)]
HIP_HINGES: list[Hinge] = [("yaw", -25, 25), ("roll", -15, 40), ("pitch", -90, 60)]
KNEE_HINGES: list[Hinge] = [("pitch", -50, 80)]
HOCK_HINGES: list[Hinge] = [("pitch", -70, 45)]
HIND_TOES_HINGES: list[Hinge] = [("pitch", -60, 70)]


def _from(origin: Sequence[float], to: Sequence[float]) -> Vector:
    return (to[0] - origin[0], to[1] - origin[1], to[2] - origin[2])


def _mirror(point: Sequence[float], side: str) -> Vector:
    return (point[0], point[1] if side == "left" else -point[1], point[2])


def _articulate(
    robot: Description,
    parent: str,
    child: str,
    joint: str,
    hinges: list[Hinge],
    xyz: Vector,
    rpy: Vector = (0.0, 0.0, 0.0),
    *,
    mirrored: bool = False,
) -> None:
    """Attach `child` to `parent` by one hinge, or by several through the same point."""
    for axis, lower, upper in hinges:
        last = axis == hinges[-1][0]
        name = joint if len(hinges) == 1 else f"{joint}_{axis}"
        link = child if last else f"{name}_link"
        if mirrored and axis != "pitch":
            lower, upper = -upper, -lower
        robot.link(link)
        limits = (math.radians(lower), math.radians(upper))
        robot.revolute(name, parent, link, axis=AXES[axis], limits=limits, xyz=xyz, rpy=rpy)
        parent, xyz, rpy = link, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)


def _leg(robot: Description, side: str, end: str) -> None:
    """A leg from the trunk to the paw; the frame of the paw lies on the sole."""
    if end == "fore":
        trunk, trunk_at, points = "chest", CHEST, FORE_LEG
        segments = [
            ("shoulder", "upper_arm", SHOULDER_HINGES),
            ("elbow", "forearm", ELBOW_HINGES),
            ("wrist", "metacarpus", WRIST_HINGES),
            ("toes", "fore_toes", FORE_TOES_HINGES),
        ]
    else:
        trunk, trunk_at, points = "pelvis", PELVIS, HIND_LEG
        segments = [
            ("hip", "thigh", HIP_HINGES),
            ("knee", "shank", KNEE_HINGES),
            ("hock", "metatarsus", HOCK_HINGES),
            ("toes", "hind_toes", HIND_TOES_HINGES),
        ]
    parent, at = trunk, trunk_at
    for point, link, hinges in segments:
        here = _mirror(points[point], side)
        joint = f"{side}_{end}_toes_pitch" if point == "toes" else f"{side}_{point}"
        _articulate(robot, parent, f"{side}_{link}", joint, hinges, _from(at, here), mirrored=side == "right")
        parent, at = f"{side}_{link}", here
    robot.link(f"{side}_{end}_paw")
    robot.fixed(parent, f"{side}_{end}_paw", xyz=_from(at, _mirror(points["paw"], side)))


def _dress(robot: Description) -> None:
    """Add the links' shapes, one mesh for each colour, in the link's frame; the right legs mirror the left."""
    at = {"pelvis": PELVIS, "spine": SPINE, "chest": CHEST, "neck": NECK, "head": HEAD, "jaw": JAW}
    for link, surfaces in [
        *lion_shapes.trunk().items(),
        ("head", lion_shapes.head()),
        ("jaw", lion_shapes.jaw()),
        *lion_shapes.mane().items(),
    ]:
        _put_on(robot, [link], link, surfaces, at[link])
    for leg, points in ((lion_shapes.fore_leg(), FORE_LEG), (lion_shapes.hind_leg(), HIND_LEG)):
        for (link, surfaces), point in zip(leg.items(), points.values(), strict=False):
            _put_on(robot, [f"left_{link}", f"right_{link}"], link, surfaces, point)
    for number in range(1, len(TAIL_DROOP) + 1):
        surfaces = lion_shapes.tail(number, len(TAIL_DROOP))
        _put_on(robot, [f"tail{number}"], f"tail{number}", surfaces, (0.0, 0.0, 0.0))


def _put_on(robot: Description, links: list[str], name: str, surfaces: Surfaces, origin: Vector) -> None:
    for material, shape in surfaces.items():
        path = f"meshes/lion/{name}_{material}.obj"
        if path in robot.files:
            path = f"meshes/lion/{name}_ruff_{material}.obj"
        robot.files[path] = shape.moved(_from(origin, (0.0, 0.0, 0.0))).obj()
        for link in links:
            robot.links[link].append(mesh_visual(path, material, mirrored=link.startswith("right")))


def build() -> Description:
    robot = Description("lion", "A lion, standing when every angle is zero.", lion_shapes.MATERIALS)
    robot.link("pelvis")
    _articulate(robot, "pelvis", "spine", "spine", SPINE_HINGES, _from(PELVIS, SPINE))
    _articulate(robot, "spine", "chest", "chest", CHEST_HINGES, _from(SPINE, CHEST))
    _articulate(robot, "chest", "neck", "neck", NECK_HINGES, _from(CHEST, NECK))
    _articulate(robot, "neck", "head", "head", HEAD_HINGES, _from(NECK, HEAD))
    _articulate(robot, "head", "jaw", "jaw_pitch", JAW_HINGES, _from(HEAD, JAW))
    robot.link("nose")
    robot.fixed("head", "nose", xyz=_from(HEAD, NOSE))
    for end in ("fore", "hind"):
        for side in ("left", "right"):
            _leg(robot, side, end)
    parent, xyz = "pelvis", _from(PELVIS, TAIL)
    for number, droop in enumerate(TAIL_DROOP, start=1):
        link = f"tail{number}"
        _articulate(robot, parent, link, link, TAIL_HINGES, xyz, (0.0, math.radians(droop), 0.0))
        parent, xyz = link, (-TAIL_SEGMENT, 0.0, 0.0)
    robot.link("tail_tip")
    robot.fixed(parent, "tail_tip", xyz=xyz)
    _dress(robot)
    for link, solids in lion_solids.solids().items():
        robot.solid(link, solids)
    for name, angles in POSES.items():
        robot.pose(name, **angles)
    return robot
