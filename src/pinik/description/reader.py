"""Read a URDF safely, and check it before it is given to Pinocchio.

Pinocchio answers most faults with "does not contain a valid URDF model" and silently accepts others. Here each fault
raises a `RobotLoadError` that names the element and the cause. What was checked is written as a new text, without
shapes, so that Pinocchio reads exactly that.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..echoes import QUOTED, shortened
from ..errors import RobotLoadError
from .addresses import is_expression
from .document import Document, read_document
from .edits import new_attribute
from .flaw import Flaw
from .joints import JointTag, Mimic, read_joint
from .links import LinkTag, read_link
from .materials import named_colors
from .slips import meant, misspelt
from .source import RobotSource, Source
from .tree import check_links, check_unique, resolved_mimics, root_link
from .unknown import unknown_in_joints
from .vocabulary import URDF
from .writer import written
from .xml import BrokenXMLError, DocumentError, Element

__all__ = ["MAX_LINKS", "Description", "JointTag", "Mimic", "read", "read_content"]

# Pinocchio's parser searches all frames for each parent: 10,000 links take a second, 100,000 take minutes.
MAX_LINKS = 10_000
_MOST_SHOWN = 4

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
XACRO_HELP = "an unexpanded xacro file; load it by its path, or expand it first: xacro file.xacro > file.urdf"


@dataclass(frozen=True)
class Description:
    """A robot description that was read and checked.

    Attributes:
        name: The robot's name.
        source: The file that was read, or "<text>".
        path: The absolute path of that file; None if there is none.
        root: The root link.
        links: The names of the links, in the file's order.
        link_tags: The links themselves, with the shapes that can be read.
        joints: The joints, in the file's order; a mimic of a mimic names the leader at the end of the chain.
        meshes: The addresses of those shapes' meshes as written, in order, without repetitions.
        xml: The URDF text for Pinocchio: kinematics, inertias and limits, without shapes.
        warnings: What was repaired or left out.
        document: The bytes that were parsed, shapes included (`document.Document.content`).
        expanded: Whether these bytes are the URDF that xacro made of the file.
    """

    name: str
    source: str
    path: Path | None
    root: str
    links: tuple[str, ...]
    link_tags: tuple[LinkTag, ...]
    joints: tuple[JointTag, ...]
    meshes: tuple[str, ...]
    xml: str
    warnings: tuple[Flaw, ...]
    document: bytes = field(repr=False)
    expanded: bool = False


def read(given: RobotSource) -> Description:
    """Read a URDF and check it.

    Args:
        given: The path of a file, URDF text (a string that begins with "<" after any white space and byte-order mark),
            the bytes of a file, or an open file, which is read from its current position to its end.

    Raises:
        RobotLoadError: The file cannot be read, or is not a valid URDF; the message names the element and the cause.
    """
    source = Source.of(given)
    return read_content(source.content(), source)


def read_content(content: bytes, source: Source) -> Description:
    """Check a URDF whose bytes were read already.

    Args:
        content: The bytes.
        source: Where they come from.

    Raises:
        RobotLoadError: It is not a valid URDF; the message names the element and the cause.
    """
    try:
        return _described(read_document(content), source)
    except DocumentError as fault:
        raise _load_error(fault, source) from None


def _load_error(fault: DocumentError, source: Source) -> RobotLoadError:
    # The message of broken XML names line and column itself.
    of = " of the expanded file" if source.expanded else ""
    line = f" (line {fault.line}{of})" if fault.line and not isinstance(fault, BrokenXMLError) else ""
    others = [_load_error(other, source) for other in fault.others]
    return RobotLoadError(fault.message + line, source=source.label, element=fault.owner, others=others)


def _described(document: Document, source: Source) -> Description:
    robot = document.root
    _check_root(robot)
    flaws: list[Flaw] = list(document.flaws)
    if not robot.named("link"):
        raise DocumentError(_why_no_links(robot), owner="<robot>", line=robot.line)
    _check_size(robot)
    check_unique(robot)
    colors = named_colors(robot, flaws, document.content)
    links = [read_link(element, colors, flaws, document.content) for element in robot.named("link")]
    lines = {element.attributes["name"]: element.line for element in robot.named("link")}
    joints = _read_joints(robot, lines, flaws, document.content)
    root = _root(lines, joints, robot)
    joints = resolved_mimics(joints, flaws)
    flaws.extend(unknown_in_joints(robot))
    name = robot.attributes.get("name")
    if name is None:
        name = source.path.stem if source.path else "robot"
        flaws.append(_nameless(robot, name, document.content))
    return Description(
        name=name,
        source=source.label,
        path=source.path.absolute() if source.path else None,
        root=root,
        links=tuple(link.name for link in links),
        joints=tuple(joints),
        link_tags=tuple(links),
        meshes=tuple(dict.fromkeys(shape.filename for link in links for shape in link.shapes if shape.filename)),
        xml=written(name, links, joints),
        warnings=tuple(flaw.of_expansion() for flaw in flaws) if source.expanded else tuple(flaws),
        document=document.content,
        expanded=source.expanded,
    )


def _read_joints(robot: Element, links: Container[str], flaws: list[Flaw], document: bytes) -> list[JointTag]:
    """All joints; if any of them are faulty, one error that has the first fault of each."""
    joints, faults = [], []
    for element in robot.named("joint"):
        try:
            joints.append(read_joint(element, flaws, document))
        except DocumentError as fault:
            faults.append(fault)
    for joint in joints:
        try:
            check_links(joint, links)
        except DocumentError as fault:
            faults.append(_with_lost_tags(fault, robot))
    if faults:
        first, *others = faults
        raise DocumentError(first.message, owner=first.owner, line=first.line, others=others)
    return joints


def _root(links: Mapping[str, int], joints: Sequence[JointTag], robot: Element) -> str:
    try:
        return root_link(links, joints)
    except DocumentError as fault:
        raise _with_lost_tags(fault, robot) from None


def _with_lost_tags(fault: DocumentError, robot: Element) -> DocumentError:
    """A fault in the tree, which may come from a link or joint whose tag is misspelt; that one is named then."""
    known = URDF["robot"].children
    lost = [
        f"<{shortened(child.tag, QUOTED)}> on line {child.line}"
        for child in robot.children
        if child.tag not in known and meant(child.tag, known) in ("link", "joint")
    ]
    if not lost:
        return fault
    more = f" and {len(lost) - _MOST_SHOWN} more" if len(lost) > _MOST_SHOWN else ""
    cause = f"{fault.message}; URDF does not know {', '.join(lost[:_MOST_SHOWN])}{more}, and writes <link> and <joint>"
    return DocumentError(cause, owner=fault.owner, line=fault.line)


def _nameless(robot: Element, name: str, document: bytes) -> Flaw:
    """That `<robot>` has no name. If one is misspelt, the flaw of the misspelling has the edits."""
    edits = () if "name" in misspelt(robot) else new_attribute(document, robot, "name", name)
    cause = f"has no name; the robot is named {name!r}"
    return Flaw("<robot>", cause, code="no-name", line=robot.line, mend=f"Write <robot name={name!r}>.", edits=edits)


def _check_root(robot: Element) -> None:
    if robot.tag != "robot":
        kind = OTHER_FORMATS.get(robot.tag, "not a URDF file, whose root is <robot>")
        raise DocumentError(f"the root element is <{robot.tag}>: this is {kind}", owner=f"<{robot.tag}>")
    for element in robot.walk():
        if element.tag.startswith("xacro:"):
            raise DocumentError(f"this is {XACRO_HELP}", owner=f"<{element.tag}>", line=element.line)
    for part in [*robot.named("link"), *robot.named("joint")]:
        for element in _outside_shapes(part):
            for attribute, text in element.attributes.items():
                if is_expression(attribute, text):
                    raise DocumentError(
                        f'{attribute}="{shortened(text, QUOTED)}" is a xacro expression: this is {XACRO_HELP}',
                        owner=f"<{element.tag}>",
                        line=element.line,
                    )


def _outside_shapes(part: Element) -> Iterator[Element]:
    """The elements of a link or joint on which kinematics may depend."""
    yield part
    for child in part.children:
        if child.tag not in ("visual", "collision"):
            yield from child.walk()


def _check_size(robot: Element) -> None:
    """Refuse a robot that is too large, before time is spent on its links and joints."""
    for tag in ("link", "joint"):
        count = len(robot.named(tag))
        if count > MAX_LINKS:
            raise DocumentError(f"it has {count:,} {tag}s; at most {MAX_LINKS:,} can be loaded")


def _why_no_links(robot: Element) -> str:
    if any(child.tag in SRDF_TAGS for child in robot.children):
        return "there are no <link> elements: this is an SRDF file; load the URDF that it belongs to"
    if "xmlns:xacro" in robot.attributes:
        return "there are no <link> elements: the xacro file from which it was made contains only macros"
    return "there are no <link> elements"
