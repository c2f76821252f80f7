"""Draw the pictures of docs/self_motion.md: a Panda whose elbow moves while its hand stays, and its joint angles.

`python tools/draw_self_motion.py` writes them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pinik

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
FRAME = "panda_hand_tcp"
COLORS = ("#1f6fc4", "#d97a00", "#0c9a72", "#b9559a", "#7a5fd0", "#8a6d3b", "#4d7c8a")


def motion() -> pinik.SelfMotion:
    """The self-motion of the Panda at its default pose."""
    panda = pinik.load("panda")
    return panda.self_motion(FRAME, panda.poses["default"])


def draw_fan(found: pinik.SelfMotion) -> None:
    """Draw configurations at equal distances along the arc, as ghosts around the one that it was found from."""
    robot = found.robot
    hand = robot.placement(FRAME, found.start).translation
    picture = pinik.draw(robot, found, balls=hand, view=(0.5, 0.35), size=(900, 620))
    (IMAGES / "self_motion.png").write_bytes(picture.png(colors=256))


def draw_angles(found: pinik.SelfMotion) -> None:
    """Draw the angles along the arc, with the limits at which it ends dashed."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    axes = figure.subplots()
    robot = found.robot
    gone = np.linspace(0.0, found.length, len(found))
    for column, color in enumerate(COLORS):
        axes.plot(gone, np.degrees(found.angles[:, column]), color=color, label=found.joint_names[column])
    for end in found.arcs[0].ends:
        for name, side in end.limits.items():
            column = found.joint_names.index(name)
            limit = (robot.lower if side == "lower" else robot.upper)[column]
            axes.axhline(np.degrees(limit), color=COLORS[column], linewidth=1.0, linestyle="--")
    axes.set_xlabel("arc length [rad]")
    axes.set_ylabel("joint angle [°]")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.savefig(IMAGES / "self_motion_angles.png", dpi=110)


def main() -> None:
    """Write both pictures."""
    found = motion()
    draw_fan(found)
    draw_angles(found)


if __name__ == "__main__":
    main()
