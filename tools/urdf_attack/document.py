"""A URDF that is written in one way and meant in another: a tree of elements to be taken apart and put together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

__all__ = ["Node", "parsed", "subtree"]

# What stands inside these elements says nothing about where the links are.
WITHOUT_KINEMATICS = {"visual", "collision", "material", "inertial", "transmission", "gazebo", "ros2_control", "sensor"}


@dataclass(slots=True)
class Node:
    """An element.

    Attributes:
        tag: Its name.
        written: Its attributes as they stand in the file.
        meant: Attributes whose plain form is another than the written one: what every reader understands.
        children: The elements in it.
        text: Text before the first child, as it stands in the file.
    """

    tag: str
    written: dict[str, str]
    meant: dict[str, str] = field(default_factory=dict)
    children: list[Node] = field(default_factory=list)
    text: str = ""

    def write(self, name: str, value: str) -> None:
        """Write an attribute, which then means what is written."""
        self.written[name] = value
        self.meant.pop(name, None)

    def copy(self) -> Node:
        """The element and all that is in it, once more."""
        children = [child.copy() for child in self.children]
        return Node(self.tag, dict(self.written), dict(self.meant), children, self.text)

    def walk(self, inside: bool = False) -> Iterator[tuple[Node, Node, bool]]:
        """(Parent, element, whether it says nothing about kinematics) of every element below this one."""
        for child in self.children:
            harmless = inside or child.tag in WITHOUT_KINEMATICS
            yield self, child, harmless
            yield from child.walk(harmless)

    def render(self, *, plainly: bool = False) -> str:
        """The element as XML: as it is written, or in plain form, which has only what places the links."""
        attributes = self.written
        if plainly:  # other readers look for elements without a namespace only
            attributes = {name: text for name, text in {**self.written, **self.meant}.items() if name != "xmlns"}
        said = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())
        children = [child for child in self.children if not (plainly and child.tag in WITHOUT_KINEMATICS)]
        inside = "".join(child.render(plainly=plainly) for child in children)
        text = "" if plainly else self.text
        return f"<{self.tag}{said}>{text}{inside}</{self.tag}>\n"


def parsed(document: bytes) -> Node:
    """The tree of a well-formed document."""

    def node(element: ElementTree.Element) -> Node:
        return Node(element.tag, dict(element.attrib), children=[node(child) for child in element])

    return node(ElementTree.fromstring(document))


def subtree(robot: Node, root: str, most_joints: int, *, mesh: str) -> Node:
    """A copy of the robot's links from `root` on, at most `most_joints` joints of it, all with the same small mesh."""
    joints: dict[str, list[Node]] = {}
    for joint in robot.children:
        if joint.tag == "joint":
            joints.setdefault(_end(joint, "parent"), []).append(joint)
    kept, links, pending = [], [root], [root]
    while pending and len(kept) < most_joints:
        for joint in joints.get(pending.pop(0), []):
            if len(kept) < most_joints:
                kept.append(joint)
                links.append(_end(joint, "child"))
                pending.append(links[-1])
    names = {joint.written.get("name") for joint in kept}
    others = [part for part in robot.children if part.tag not in ("link", "joint")]
    children = [part for part in robot.children if part.tag == "link" and part.written.get("name") in links]
    part = Node("robot", robot.written, children=[*children, *kept, *_about(others, {*names, *links})]).copy()
    for _, element, _ in part.walk():
        if "filename" in element.written:
            element.written["filename"] = mesh
    return part


def _end(joint: Node, role: str) -> str:
    return next((child.written.get("link", "") for child in joint.children if child.tag == role), "")


def _about(parts: list[Node], names: set[str | None]) -> list[Node]:
    """At most four of the other parts: materials, and what names a link or joint that was kept."""
    named = [
        part
        for part in parts
        if part.tag == "material" or any(value in names for _, one, _ in part.walk() for value in one.written.values())
    ]
    return named[:4]
