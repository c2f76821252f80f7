"""A robot of two parallel hinges, made to measure."""

from __future__ import annotations

import pinik


def two_hinges(
    limits=((-9.0, 9.0), (-9.0, 9.0)),
    *,
    rpy=(0.0, 0.0, 0.0),
    axis="0 0 1",
    second_axis="0 0 1",
    second="revolute",
    extra="",
) -> pinik.Robot:
    """Bones of 0.5 m and 0.3 m along x in a plane 0.1 m above the base, with limits; the whole turned by `rpy`."""
    turned = " ".join(repr(float(angle)) for angle in rpy)
    bounds = [f'<limit lower="{low!r}" upper="{high!r}" effort="1" velocity="1"/>' for low, high in limits]
    return pinik.load(f"""<robot name="hinges">
      <link name="world"/><link name="base"/><link name="upper"/><link name="lower"/><link name="hand"/>
      <joint name="mount" type="fixed"><parent link="world"/><child link="base"/><origin rpy="{turned}"/></joint>
      <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.1"/>
        <axis xyz="{axis}"/>{bounds[0]}</joint>
      <joint name="elbow" type="{second}"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/>
        <axis xyz="{second_axis}"/>{bounds[1]}{extra}</joint>
      <joint name="wrist" type="fixed"><parent link="lower"/><child link="hand"/><origin xyz="0.3 0 0"/></joint>
    </robot>""")
