"""The thesis's robot arm: five segments, the gripper and the end effector; each of the first six swings about x and z.

A bone lies along its own y, as in Blender; the base turns the bones' axes so that the arm stands up along the
world's z: bone y is up, bone z forward (world x), bone x to the left (world y). `bone*_x` thus bends the arm forward.
"""

from __future__ import annotations

import math
from itertools import pairwise

from . import arm_shapes
from .description import ZERO, Description, Vector, box, cylinder, mesh_visual, sphere

BASE_HEIGHT = 0.12  # [m], up to the first swing
LENGTHS = (0.28, 0.25, 0.21, 0.17, 0.13, 0.16)  # [m], five segments and the gripper: 1.20 in all
RADII = (0.062, 0.055, 0.048, 0.041, 0.035, 0.030)  # [m], of the joints
RIMS = (0.077, 0.070, 0.064, 0.058, 0.052, 0.046)  # [m], of the segments next to the joints
SWING = (-math.pi / 4, math.pi / 4)
BONES_UP: Vector = (math.pi / 2, 0, math.pi / 2)  # bone axes (x, y, z) -> world (y, z, x)
TIP_UP: Vector = (-math.pi / 2, -math.pi / 2, 0)  # and back: the tip's z leaves the gripper


def _dress(robot: Description) -> None:
    """Add the links' shapes, one mesh for each colour."""
    shapes = {"base": arm_shapes.base(BASE_HEIGHT, RADII[0], RIMS[0])}
    for number, ends in enumerate(pairwise(zip(RADII, RIMS, strict=True)), start=1):
        shapes[f"bone{number}"] = arm_shapes.segment(LENGTHS[number - 1], *ends)
    shapes["gripper"] = arm_shapes.gripper(LENGTHS[-1], RADII[-1], RIMS[-1])
    for link, surfaces in shapes.items():
        for material, shape in surfaces.items():
            path = f"meshes/arm/{link}_{material}.obj"
            robot.files[path] = shape.obj()
            robot.links[link].append(mesh_visual(path, material, rpy=BONES_UP if link == "base" else ZERO))
    for material, shape in arm_shapes.knuckle().items():
        path = f"meshes/arm/knuckle_{material}.obj"
        robot.files[path] = shape.obj()
        for number, radius in enumerate(RADII, start=1):
            robot.links[f"knuckle{number}"].append(mesh_visual(path, material, scale=radius))


def _make_solid(robot: Description) -> None:
    """Add what can touch others: a ball in each joint, a cylinder around each segment, boxes for the hand."""
    top = BASE_HEIGHT - arm_shapes.FOOT * RADII[0]
    robot.solid("base", [cylinder(0.155, (0, 0, 0), (0, 0, 0.017)), cylinder(0.118, (0, 0, 0.017), (0, 0, top))])
    for number, radius in enumerate(RADII, start=1):
        robot.solid(f"knuckle{number}", [sphere(arm_shapes.FOOT * radius)])
    for number, (near, far) in enumerate(pairwise(RADII), start=1):
        start, end = arm_shapes.FOOT * near, LENGTHS[number - 1] - arm_shapes.FOOT * far
        robot.solid(f"bone{number}", [cylinder(RIMS[number - 1], (0, start, 0), (0, end, 0))])
    root, length = arm_shapes.FOOT * RADII[-1], LENGTHS[-1]
    robot.solid("gripper", [box((0.068, 0.053, 0.200), (0.0, root + 0.0265, 0.0))])
    for side in (1, -1):  # the fingers, whose pads hold a ball
        inner, outer, bottom, end = arm_shapes.GRIP, 0.082, root + 0.047, length + 0.034
        middle = (0.0, (bottom + end) / 2, side * (inner + outer) / 2)
        robot.solid("gripper", [box((0.036, end - bottom, outer - inner), middle)])


def build() -> Description:
    robot = Description("arm", "A robot arm of seven segments; six of them swing about x and z.", arm_shapes.MATERIALS)
    robot.link("base")
    parent, xyz, rpy = "base", (0.0, 0.0, BASE_HEIGHT), BONES_UP
    for number, length in enumerate(LENGTHS, start=1):
        knuckle = f"knuckle{number}"
        bone = "gripper" if number == len(LENGTHS) else f"bone{number}"
        robot.link(knuckle)
        robot.link(bone)
        robot.revolute(f"bone{number}_x", parent, knuckle, axis=(1, 0, 0), limits=SWING, xyz=xyz, rpy=rpy)
        robot.revolute(f"bone{number}_z", knuckle, bone, axis=(0, 0, 1), limits=SWING)
        parent, xyz, rpy = bone, (0.0, length, 0.0), (0.0, 0.0, 0.0)
    robot.link("tip")
    robot.fixed(parent, "tip", xyz=xyz, rpy=TIP_UP)
    _dress(robot)
    _make_solid(robot)
    robot.pose("relaxed", bone1_x=-18, bone2_x=32, bone3_x=28, bone4_x=30, bone5_x=24, bone6_x=12)
    robot.pose(
        "reach",
        bone1_x=22, bone1_z=-8, bone2_x=26, bone2_z=-10, bone3_x=20, bone3_z=-6, bone4_x=4, bone5_x=-8, bone6_x=-10,
    )  # fmt: skip
    return robot
