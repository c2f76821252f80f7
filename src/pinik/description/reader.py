"""Read a URDF safely, and check it before it is given to Pinocchio.

Pinocchio answers most faults with "does not contain a valid URDF model" and silently accepts others. Here each fault
raises a `RobotLoadError` that names the element and the cause. What was checked is written as a new text, without
shapes, so that Pinocchio reads exactly that.
"""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import RobotLoadError
from .joints import JointTag, Mimic, read_joint
from .links import read_link
from .tree import check_unique, resolved_mimics, root_link
from .unknown import unknown_in_joints
from .writer import written
from .xml import MAX_BYTES, DocumentError, Element, parse

__all__ = ["Description", "JointTag", "Mimic", "read"]

# What a document is if its root element is not <robot>.
OTHER_FORMATS = {
    "sdf": "an SDF file; convert it to URDF first",
    "world": "an SDF file; convert it to URDF first",
    "model": "an SDF file; convert it to URDF first",
    "mujoco": "an MJCF (MuJoCo) file; convert it to URDF first",
    "mujocoinclude": "an MJCF (MuJoCo) file; convert it to URDF first",
    "COLLADA": "a COLLADA mesh, not a robot",
}
SRDF_TAGS = {"group", "group_state", "virtual_joint", "end_effector", "disable_collisions", "passive_joint"}
XACRO_HELP = "an unexpanded xacro file; expand it first: xacro file.xacro > file.urdf"


@dataclass(frozen=True)
class Description:
    """A robot description that was read and checked.

    Attributes:
        name: The robot's name.
        source: The file that was read, or "<text>".
        path: The absolute path of that file; None for text.
        root: The root link.
        links: The links, in the file's order.
        joints: The joints, in the file's order; a mimic of a mimic names the leader at the end of the chain.
        meshes: The addresses of the meshes as written, in order, without repetitions.
        xml: The URDF text for Pinocchio: kinematics, inertias and limits, without shapes.
        warnings: What was repaired or left out.
        document: The bytes that were read, shapes included.
    """

    name: str
    source: str
    path: Path | None
    root: str
    links: tuple[str, ...]
    joints: tuple[JointTag, ...]
    meshes: tuple[str, ...]
    xml: str
    warnings: tuple[str, ...]
    document: bytes = field(repr=False)


def read(source: str | os.PathLike[str]) -> Description:
    """Read a URDF and check it.

    Args:
        source: The path of a file, or URDF text: a string that begins with "<" after any white space and byte-order
            mark.

    Raises:
        RobotLoadError: The file cannot be read, or is not a valid URDF; the message names the element and the cause.
    """
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        label, path = "<text>", None
    else:
        label = _shown(os.fspath(source))
        path = Path(source)
    try:
        document = _file_bytes(path) if path else _text_bytes(str(source))
        return _describe(parse(document, None if path else "utf-8"), label, path, document)
    except DocumentError as fault:
        line = f" (line {fault.line})" if fault.line else ""
        raise RobotLoadError(fault.message + line, source=label, element=fault.owner) from None


def _shown(path: str) -> str:
    if len(path) > 200:
        return repr(path[:60]) + "..."
    return path if path and path.isprintable() else repr(path)


def _text_bytes(text: str) -> bytes:
    try:
        return text.lstrip("\ufeff").encode("utf-8")
    except UnicodeEncodeError as error:
        raise DocumentError(f"not XML: the text cannot be encoded ({error.reason})") from None


def _file_bytes(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise DocumentError("this is a directory, not a URDF file")
        if not (stat.S_ISREG(path.stat().st_mode) or _is_open_already(path)):
            raise DocumentError("this is a pipe or a device, not a URDF file")
        # An endless stream must not fill up the memory.
        with path.open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise DocumentError("there is no such file (URDF text would begin with '<')") from None
    except (OSError, ValueError) as error:
        cause = getattr(error, "strerror", None) or str(error)
        raise DocumentError(f"the file cannot be read: {cause}") from None


def _is_open_already(path: Path) -> bool:
    """Whether the path names a stream that is open already, such as "<(xacro ...)" or "/dev/stdin"."""
    return os.path.abspath(path).startswith(("/dev/fd/", "/proc/self/fd/", "/dev/stdin"))


def _describe(robot: Element, source: str, path: Path | None, document: bytes) -> Description:
    _check_root(robot)
    warnings: list[str] = []
    if not robot.named("link"):
        raise DocumentError(_why_no_links(robot), owner="<robot>", line=robot.line)
    check_unique(robot)
    links = [read_link(element, warnings) for element in robot.named("link")]
    joints = [read_joint(element, warnings) for element in robot.named("joint")]
    root = root_link([link.name for link in links], joints)
    joints = resolved_mimics(joints, warnings)
    warnings.extend(unknown_in_joints(robot))
    name = robot.attributes.get("name")
    if name is None:
        name = path.stem if path else "robot"
        warnings.append(f"<robot> has no name; the robot is named {name!r}")
    return Description(
        name=name,
        source=source,
        path=path.absolute() if path else None,
        root=root,
        links=tuple(link.name for link in links),
        joints=tuple(joints),
        meshes=tuple(dict.fromkeys(mesh for link in links for mesh in link.meshes)),
        xml=written(name, links, joints),
        warnings=tuple(warnings),
        document=document,
    )


def _check_root(robot: Element) -> None:
    if robot.tag != "robot":
        kind = OTHER_FORMATS.get(robot.tag, "not a URDF file, whose root is <robot>")
        raise DocumentError(f"the root element is <{robot.tag}>: this is {kind}", owner=f"<{robot.tag}>")
    for element in robot.walk():
        if element.tag.startswith("xacro:"):
            raise DocumentError(f"this is {XACRO_HELP}", owner=f"<{element.tag}>", line=element.line)
    for part in [*robot.named("link"), *robot.named("joint")]:
        for element in part.walk():
            for attribute, text in element.attributes.items():
                if "${" in text or "$(" in text:
                    raise DocumentError(
                        f'{attribute}="{text[:60]}" is a xacro expression: this is {XACRO_HELP}',
                        owner=f"<{element.tag}>",
                        line=element.line,
                    )


def _why_no_links(robot: Element) -> str:
    if any(child.tag in SRDF_TAGS for child in robot.children):
        return "there are no <link> elements: this is an SRDF file; load the URDF that it belongs to"
    if "xmlns:xacro" in robot.attributes:
        return "there are no <link> elements: the xacro file from which it was made contains only macros"
    return "there are no <link> elements"
