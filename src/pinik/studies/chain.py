"""The planar chain of Welman's figures: hinges and equal links, without limits."""

from __future__ import annotations

import math

from ..loading import load
from ..robot import Robot

__all__ = ["TIP", "length_of", "planar_chain"]

TIP = "tip"
"""The frame at the end of the chain."""

_JOINT = """
  <joint name="joint{number}" type="revolute">
    <origin xyz="{offset!r} 0 0"/><parent link="{parent}"/><child link="link{number}"/><axis xyz="0 0 1"/>
    <limit lower="-{half_turn!r}" upper="{half_turn!r}" effort="1" velocity="1"/>
  </joint>"""
_LINK = """
  <link name="link{number}">
    <visual>
      <origin xyz="{middle!r} 0 0" rpy="0 {quarter_turn!r} 0"/>
      <geometry><cylinder radius="{radius!r}" length="{bone!r}"/></geometry>
      <material name="bone"><color rgba="0.12 0.44 0.77 1"/></material>
    </visual>
    <visual>
      <geometry><sphere radius="{knob!r}"/></geometry>
      <material name="knob"><color rgba="0.11 0.13 0.16 1"/></material>
    </visual>
  </link>"""


def planar_chain(joints: int = 7, length: float = 1.0) -> Robot:
    """Links end to end in the world's x-y plane, along x at zero; joint1 to jointN turn about z.

    Args:
        joints: The number of hinges and links.
        length: The length of all links together [m].
    """
    bone = length / joints
    sizes = {"bone": bone, "middle": bone / 2, "radius": bone / 12, "knob": bone / 8}
    turns = {"half_turn": math.pi, "quarter_turn": math.pi / 2}
    links = [_LINK.format(number=number, **sizes, **turns) for number in range(1, joints + 1)]
    hinges = [
        _JOINT.format(
            number=number,
            parent=f"link{number - 1}" if number > 1 else "base",
            offset=bone if number > 1 else 0.0,
            **turns,
        )
        for number in range(1, joints + 1)
    ]
    end = f"""
  <joint name="end" type="fixed">
    <origin xyz="{bone!r} 0 0"/><parent link="link{joints}"/><child link="{TIP}"/>
  </joint>"""
    return load(
        f'<robot name="chain{joints}">\n  <link name="base"/>{"".join(links + hinges)}'
        f'\n  <link name="{TIP}"/>{end}\n</robot>'
    )


def length_of(chain: Robot) -> float:
    """The length of all links together [m]."""
    return float(chain.placement(TIP, chain.neutral()).translation[0])
