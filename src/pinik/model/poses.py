"""Named configurations: the poses in an SRDF file, read by Pinocchio."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio
from numpy.typing import NDArray

from ..description.xml import MAX_BYTES, DocumentError, Element, parse
from ..errors import RobotLoadError
from .joint import Joint

__all__ = ["read_poses"]

Array = NDArray[np.float64]


def read_poses(srdf: Path, model: pinocchio.Model, joints: Iterable[Joint]) -> dict[str, Array]:
    """The poses in an SRDF file: name → q (nq,). Joints that a pose does not mention are neutral.

    Followers, and joints that the model does not have, are skipped.

    Args:
        srdf: The SRDF file.
        model: Pinocchio's model; it is not modified.
        joints: The joints of the model.

    Raises:
        RobotLoadError: The file cannot be read, or is not XML.
    """
    try:
        with srdf.open("rb") as file:
            robot = parse(file.read(MAX_BYTES + 1))
    except OSError as error:
        raise RobotLoadError(f"the SRDF cannot be read: {error.strerror or error}", source=str(srdf)) from None
    except DocumentError as fault:
        line = f" (line {fault.line})" if fault.line else ""
        raise RobotLoadError(f"the SRDF cannot be read: {fault.message}{line}", source=str(srdf)) from None
    xml = _of_joints_that_can_be_set(robot, {joint.name: joint for joint in joints})
    posed = pinocchio.Model(model)
    try:
        pinocchio.loadReferenceConfigurationsFromXML(posed, xml, False)
    except (RuntimeError, ValueError) as error:
        raise RobotLoadError(f"the SRDF cannot be read: {error}", source=str(srdf)) from error
    references = posed.referenceConfigurations
    return {entry.key(): pinocchio.normalize(posed, np.array(entry.data())) for entry in references}


def _of_joints_that_can_be_set(robot: Element, joints: dict[str, Joint]) -> str:
    """The poses as XML, without joints for which Pinocchio would print a message to stdout."""
    kept = ElementTree.Element("robot", name="poses")
    for state in robot.named("group_state"):
        pose = ElementTree.SubElement(kept, "group_state", state.attributes)
        for setting in state.named("joint"):
            joint = joints.get(setting.attributes.get("name", ""))
            count = len(setting.attributes.get("value", "").split())
            if joint is not None and count == (1 if joint.has_one_axis and joint.leader is None else joint.nq):
                ElementTree.SubElement(pose, "joint", setting.attributes)
    return ElementTree.tostring(kept, encoding="unicode")
