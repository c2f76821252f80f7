"""Draw the pictures of docs/tracks.md: joint angles along two paths. `python tools/draw_tracks.py` writes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pinik

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
COLORS = ("#1f6fc4", "#d97a00", "#0c9a72", "#b9559a", "#7a5fd0", "#8a6d3b", "#4d7c8a")


def circle() -> pinik.Track:
    """The Panda along a circle of 12 cm, from examples/circle.csv."""
    numbers = np.loadtxt(ROOT / "examples" / "circle.csv", delimiter=",", skiprows=1)
    panda = pinik.load("panda")
    targets = [pinik.Target("panda_hand_tcp", row[:3], quat_xyzw=row[3:7]) for row in numbers]
    return pinik.track(panda, targets, q0=panda.poses["default"], times=numbers[:, 7])


def jump() -> pinik.Track:
    """The planar arm along an arc on which a joint comes to its limit, from examples/jump.csv."""
    numbers = np.loadtxt(ROOT / "examples" / "jump.csv", delimiter=",", skiprows=1)
    robot = pinik.load("two_link")
    start = robot.configuration({"joint1": -2.64, "joint2": 1.5})
    return pinik.track(robot, "tip", numbers[:, :3], start, times=numbers[:, 3])


def draw(track: pinik.Track, joints: int, name: str) -> None:
    """Draw the angles of the first joints over time; jumps are marked with their reasons, limits are dashed."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    axes = figure.subplots()
    robot, times = track.prepared.robot, track.times
    assert times is not None
    for column in range(joints):
        axes.plot(times, np.degrees(track.angles[:, column]), color=COLORS[column], label=track.joint_names[column])
    for found in track.jumps:
        axes.axvline(0.5 * (times[found.index - 1] + times[found.index]), color="#777777", linewidth=1.0)
        for joint, side in found.limits.items():
            column = track.joint_names.index(joint)
            limit = np.degrees((robot.lower if side == "lower" else robot.upper)[column])
            axes.axhline(limit, color=COLORS[column], linewidth=1.0, linestyle="--")
            axes.annotate(
                f"{joint} comes to its {side} limit",
                (times[found.index], limit),
                xytext=(8, 10),
                textcoords="offset points",
            )
    axes.set_xlabel("time [s]")
    axes.set_ylabel("joint angle [°]")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.savefig(IMAGES / name, dpi=110)


def main() -> None:
    """Write both pictures."""
    draw(circle(), 7, "track.png")
    draw(jump(), 2, "track_jump.png")


if __name__ == "__main__":
    main()
