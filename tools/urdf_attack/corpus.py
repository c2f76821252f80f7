"""The robots that the attack mutates: parts of example-robot-data, pinik's own, and one with every element."""

from __future__ import annotations

from pathlib import Path
from random import Random

from pinik.description.shares import example_robot_data

from .document import Node, parsed, subtree

__all__ = ["robots"]

MESH = "package://victim/meshes/ok.stl"
PARTS_OF_EACH = 3


def robots() -> list[Node]:
    """Small robots, as mutations of small robots find as much as those of large ones, and a hundred times faster."""
    random = Random(0)
    own = Path(__file__).parents[2] / "urdf"
    examples = example_robot_data()
    files = [*sorted(own.glob("*.urdf")), *(sorted(examples.glob("*/*/*.urdf")) if examples else [])]
    everything = Path(__file__).with_name("everything.urdf")
    found = [parsed(everything.read_bytes())] * len(files)
    for file in files:
        robot = parsed(file.read_bytes())
        links = [part.written["name"] for part in robot.children if part.tag == "link"]
        for _ in range(min(PARTS_OF_EACH, len(links))):
            found.append(subtree(robot, random.choice(links), random.choice((2, 4, 6)), mesh=MESH))
    return found
