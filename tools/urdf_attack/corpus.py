"""The robots that the attack mutates: parts of example-robot-data, pinik's own, and one with every element."""

from __future__ import annotations

from pathlib import Path
from random import Random

from pinik.description.shares import example_robot_data

from .document import Node, parsed, subtree

__all__ = ["robots"]

MESH = "package://victim/meshes/ok.stl"
PARTS_OF_EACH = 3
MOST_JOINTS = (1, 2, 4)


def robots() -> list[Node]:
    """Small robots, as mutations of small robots find as much as those of large ones, and a hundred times faster."""
    random = Random(0)
    own = Path(__file__).parents[2] / "urdf"
    examples = example_robot_data()
    files = [*sorted(own.glob("*.urdf")), *(sorted(examples.glob("*/*/*.urdf")) if examples else [])]
    everything = parsed(Path(__file__).with_name("everything.urdf").read_bytes())
    found = []
    for file in files:
        found += [everything, *_parts(everything, random), *_parts(parsed(file.read_bytes()), random)]
    return found


def _parts(robot: Node, random: Random) -> list[Node]:
    """Random parts of a robot, each from one of its links on."""
    links = [part.written["name"] for part in robot.children if part.tag == "link"]
    roots = random.choices(links, k=min(PARTS_OF_EACH, len(links)))
    return [subtree(robot, root, random.choice(MOST_JOINTS), mesh=MESH) for root in roots]
