"""The arms that all peers are asked about, and the one URDF file of each that all of them read."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio
from numpy.typing import NDArray

from pinik.description import catalog as robot_catalog
from plain_robot import PlainRobot

__all__ = ["ARMS", "Arm", "ArmSource", "write_arm"]

Array = NDArray[np.float64]

# What says nothing about kinematics, or, like the Panda's soft limits of 0, is read by some peers alone.
LEFT_OUT_OF_ROBOT = ("gazebo", "transmission", "material")
LEFT_OUT_OF_LINK = ("visual", "collision")
LEFT_OUT_OF_JOINT = ("safety_controller",)
LEFT_OUT_OF_CHAIN = ("inertial",)


@dataclass(frozen=True)
class ArmSource:
    """An arm of a robot.

    Attributes:
        robot: The robot's name in pinik's catalogue, or the path of a URDF file.
        base: The link that targets are expressed in: the root of the file that the peers get.
        tip: The link that is placed.
        alone: Whether the file holds the links from base to tip only; else it holds the whole robot.
    """

    robot: str
    base: str
    tip: str
    alone: bool = False


ARMS = {
    "panda": ArmSource("panda", "panda_link0", "panda_link8"),
    "ur5": ArmSource("ur5", "world", "tool0"),
    "z1": ArmSource("z1", "world", "link06"),
    "xarm7": ArmSource("xarm7", "world", "link7"),
    "talos": ArmSource("talos", "torso_2_link", "gripper_left_base_link", alone=True),
}


class Arm:
    """An arm as the peers know it, and the judge's own reading of its file.

    Attributes:
        name: Its short name.
        urdf: The file that the peers read: the whole robot.
        chain: A file of the links and joints from base to tip alone, without masses, for peers that read no other.
        base: The root link.
        tip: The link that is placed.
        elements: Link, joint, link, …, from base to tip.
        joints: The n joints in between that move, from base to tip.
        lower: Their lower limits (n,) [rad].
        upper: Their upper limits (n,) [rad].
        plain: Pinocchio's model of the file, and the limits in it.
    """

    def __init__(self, name: str, source: ArmSource, urdf: Path, chain: Path) -> None:
        self.name = name
        self.urdf, self.chain = urdf, chain
        self.base, self.tip = source.base, source.tip
        joints = _joints_between(ElementTree.parse(urdf).getroot(), self.base, self.tip)
        self.elements = [self.base]
        for joint in joints:
            self.elements += [joint.attrib["name"], _link(joint, "child")]
        self.joints = [joint.attrib["name"] for joint in joints if joint.attrib["type"] != "fixed"]
        self.plain = PlainRobot(urdf.read_bytes())
        limits = self.plain.limits(self.joints)
        self.lower: Array = np.array([limits[joint][0] for joint in self.joints])
        self.upper: Array = np.array([limits[joint][1] for joint in self.joints])

    def placement(self, q: Array) -> pinocchio.SE3:
        """Where joint values (n,) put the tip, with respect to the base."""
        angles = dict(zip(self.joints, q, strict=True))
        return pinocchio.SE3(*self.plain.placements([self.tip], angles))

    def random(self, rng: np.random.Generator) -> Array:
        """Joint values (n,) uniform between the limits; of continuous joints, within a turn."""
        low = np.where(np.isfinite(self.lower), self.lower, -np.pi)
        return rng.uniform(low, np.where(np.isfinite(self.upper), self.upper, np.pi))

    def as_json(self) -> dict[str, object]:
        """What an adapter is told."""
        return {
            "name": self.name,
            "urdf": str(self.urdf),
            "chain": str(self.chain),
            "base": self.base,
            "tip": self.tip,
            "elements": self.elements,
            "joints": self.joints,
            "lower": self.lower.tolist(),
            "upper": self.upper.tolist(),
        }


def write_arm(name: str, folder: Path, source: ArmSource | None = None) -> Arm:
    """Write the URDF files of an arm into a folder: the robot's own without shapes, and one of its chain alone.

    Args:
        name: The arm's short name.
        folder: The folder.
        source: Where the arm comes from; that of this name in `ARMS` when None.
    """
    source = ARMS[name] if source is None else source
    file = source.robot if source.robot.endswith(".urdf") else robot_catalog.find(source.robot).urdf
    robot = ElementTree.parse(file).getroot()
    _leave_out(robot, LEFT_OUT_OF_ROBOT)
    for link in robot.iter("link"):
        _leave_out(link, LEFT_OUT_OF_LINK)
    for joint in robot.iter("joint"):
        _leave_out(joint, LEFT_OUT_OF_JOINT)
    if source.alone:
        _keep_chain(robot, source)
    urdf, chain = folder / f"{name}.urdf", folder / f"{name}_chain.urdf"
    ElementTree.ElementTree(robot).write(urdf, encoding="utf-8", xml_declaration=True)
    _keep_chain(robot, source)
    for link in robot.iter("link"):
        _leave_out(link, LEFT_OUT_OF_CHAIN)
    ElementTree.ElementTree(robot).write(chain, encoding="utf-8", xml_declaration=True)
    return Arm(name, source, urdf, chain)


def _leave_out(element: ElementTree.Element, tags: tuple[str, ...]) -> None:
    for child in [child for child in element if child.tag in tags]:
        element.remove(child)


def _keep_chain(robot: ElementTree.Element, source: ArmSource) -> None:
    """Take out every link and joint that is not between base and tip."""
    joints = _joints_between(robot, source.base, source.tip)
    links = {source.base, *(_link(joint, "child") for joint in joints)}
    for element in list(robot):
        if not (element in joints or (element.tag == "link" and element.attrib["name"] in links)):
            robot.remove(element)


def _joints_between(robot: ElementTree.Element, base: str, tip: str) -> list[ElementTree.Element]:
    """The joints from base to tip, in order."""
    above = {_link(joint, "child"): joint for joint in robot.findall("joint")}
    joints: list[ElementTree.Element] = []
    link = tip
    while link != base:
        joints.insert(0, above[link])
        link = _link(above[link], "parent")
    return joints


def _link(joint: ElementTree.Element, side: str) -> str:
    """The name of the link above ("parent") or below ("child") a joint."""
    element = joint.find(side)
    assert element is not None
    return element.attrib["link"]
