"""The planar arm of two hinges: a small plotter on the table, its pen on the plane z = 0."""

from __future__ import annotations

import math

from .description import Description

UPPER, LOWER = 0.5, 0.4  # [m]


def build() -> Description:
    robot = Description("two_link", "A planar arm of two hinges in the world's x-y plane.")
    robot.link("base")
    robot.link("link1")
    robot.link("link2")
    robot.link("tip")
    limits = (-math.pi, math.pi)
    robot.revolute("joint1", "base", "link1", axis=(0, 0, 1), limits=limits)
    robot.revolute("joint2", "link1", "link2", axis=(0, 0, 1), limits=limits, xyz=(UPPER, 0, 0))
    robot.fixed("link2", "tip", xyz=(LOWER, 0, 0))
    robot.pose("relaxed", joint1=25, joint2=60)
    robot.pose("reach", joint1=-20, joint2=35)
    return robot
