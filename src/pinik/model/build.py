"""Build Pinocchio's model from a checked description, with its mimic joints."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from xml.etree import ElementTree

import pinocchio

from ..description.reader import Description, JointTag
from ..description.writer import UNLIMITED
from ..errors import InputError, RobotLoadError
from .joint import Joint, joints_of
from .order import leaders_first
from .ranges import set_position_limits

__all__ = ["MAX_DEGREES_OF_FREEDOM", "build_model"]

# pinocchio.Data contains tensors of nv³ numbers, and a solve needs two of them: 0.9 GB at nv = 200, 1.6 GB at 250,
# 2.7 GB at 300 (the largest resident size of `pinik solve`).
MAX_DEGREES_OF_FREEDOM = 250

# The parser recurses once for each link of a chain, with 2.1 to 2.4 kB of stack each: an 8 MB stack overflows between
# 3,500 and 4,000 links. Deep trees are built on a stack with room for twice `reader.MAX_LINKS`.
DEEP_TREE = 100
DEEP_STACK_BYTES = 64 * 1024 * 1024
_stack_size_lock = threading.Lock()

FREEDOMS = {"revolute": 1, "continuous": 1, "prismatic": 1, "fixed": 0, "floating": 6, "planar": 3}
ROOT_JOINTS = {
    "fixed": None,
    "free_flyer": pinocchio.JointModelFreeFlyer,
    "planar": pinocchio.JointModelPlanar,
}


def build_model(
    description: Description, *, root: str = "fixed", mimic: bool = True
) -> tuple[pinocchio.Model, tuple[str, ...]]:
    """Build Pinocchio's model of a robot.

    Args:
        description: The checked URDF.
        root: How the root link is attached to the world: "fixed", "free_flyer" (6 degrees of freedom) or "planar"
            (3). The joint is called "root_joint".
        mimic: Whether mimic joints follow their leaders; if not, they are free.

    Returns:
        The model, with the robot's position limits (`ranges.set_position_limits`), and warnings: followers that changed
        roles with their leader or are left free (`order.leaders_first`), and followers whose limits are ignored.

    Raises:
        InputError: Another root than these.
        RobotLoadError: The robot is too large, or Pinocchio refuses it.
    """
    if not isinstance(root, str) or root not in ROOT_JOINTS:
        raise InputError(f"root must be one of {', '.join(map(repr, ROOT_JOINTS))}; got {root!r}")
    root_joint = None if ROOT_JOINTS[root] is None else ROOT_JOINTS[root]()
    _check_names(description, root)
    _check_size(description, 0 if root_joint is None else root_joint.nv)
    joints, warnings = leaders_first(description) if mimic else ((), ())
    if any(tag.mimic is not None for tag in joints):
        model = _built(description, _in_order(description.xml, joints), root_joint, mimic=True)
        _restore_names(model, joints)
    else:
        model = _built(description, description.xml, root_joint, mimic=False)
    movable = joints_of(model, description)
    for joint in movable:
        if joint.kind == "planar":
            _turn_into_plane(model, joint)
    warnings += set_position_limits(model, movable, description)
    return model, tuple(flaw.of_expansion() for flaw in warnings) if description.expanded else warnings


def _turn_into_plane(model: pinocchio.Model, joint: Joint) -> None:
    """Let a planar joint move in the plane across its axis; Pinocchio's moves in the xy-plane of its frame.

    The joint's frame is turned, and all that it carries is turned back, so that at the neutral configuration everything
    stays where the file says.
    """
    to_plane = joint.to_plane
    back = to_plane.inverse()
    model.jointPlacements[joint.id] = model.jointPlacements[joint.id] * to_plane
    model.inertias[joint.id] = back.act(model.inertias[joint.id])
    for child in range(1, model.njoints):
        if model.parents[child] == joint.id:
            model.jointPlacements[child] = back * model.jointPlacements[child]
    for frame in model.frames:
        if frame.parentJoint == joint.id:
            frame.placement = back * frame.placement


def _check_names(description: Description, root: str) -> None:
    """Refuse the two names that Pinocchio reserves for its own joints."""
    for joint in description.joints:
        owner = f"joint {joint.name!r}"
        if joint.name == "universe":
            raise RobotLoadError(
                "Pinocchio uses this name for the world; rename the joint", source=description.source, element=owner
            )
        if joint.name == "root_joint" and root != "fixed" and joint.kind != "fixed":
            raise RobotLoadError(
                f"with root={root!r}, Pinocchio uses this name for the root joint; rename the joint",
                source=description.source,
                element=owner,
            )


def _check_size(description: Description, root_freedoms: int) -> None:
    freedoms = root_freedoms + sum(FREEDOMS[joint.kind] for joint in description.joints)
    if freedoms > MAX_DEGREES_OF_FREEDOM:
        raise RobotLoadError(
            f"it has {freedoms:,} degrees of freedom; at most {MAX_DEGREES_OF_FREEDOM} can be loaded, because "
            "Pinocchio's memory grows with their third power (a solve with 250 takes 1.6 GB)",
            source=description.source,
        )


def _in_order(xml: str, joints: Sequence[JointTag]) -> str:
    """The text with the mimics of `joints`, renamed so that Pinocchio adds the joints in this order.

    Continuous leaders and followers become revolute joints. As (cos, sin), a leader would lose its whole turns, which
    its followers need, and could not have the limits that they impose. Besides, Pinocchio pairs continuous joints only
    with each other.
    """
    names = _ordered_names(joints)
    tags = {tag.name: tag for tag in joints}
    leaders = {tag.mimic.leader for tag in joints if tag.mimic is not None}
    robot = ElementTree.fromstring(xml)
    for joint in robot.iter("joint"):
        name = joint.attrib["name"]
        mimic, written = tags[name].mimic, joint.find("mimic")
        joint.set("name", names[name])
        if written is not None:
            joint.remove(written)
        if mimic is not None:
            scale = {"multiplier": repr(mimic.multiplier), "offset": repr(mimic.offset)}
            ElementTree.SubElement(joint, "mimic", joint=names[mimic.leader], attrib=scale)
        if joint.attrib["type"] == "continuous" and (mimic is not None or name in leaders):
            joint.set("type", "revolute")
            limit = joint.find("limit")
            if limit is None:
                limit = ElementTree.SubElement(joint, "limit", effort=repr(UNLIMITED), velocity=repr(UNLIMITED))
            limit.attrib.update(lower="0", upper="0")  # required by URDF; `set_position_limits` removes them
    return ElementTree.tostring(robot, encoding="unicode")


def _ordered_names(joints: Sequence[JointTag]) -> dict[str, str]:
    """Joint → a name that sorts by its place in `joints`."""
    width = len(str(len(joints)))
    return {tag.name: f"{place:0{width}} {tag.name}" for place, tag in enumerate(joints)}


def _restore_names(model: pinocchio.Model, joints: Sequence[JointTag]) -> None:
    """Give the joints of a model that was built from `_in_order` and their frames the names of the file again."""
    names = {ordered: name for name, ordered in _ordered_names(joints).items()}
    for joint_id, name in enumerate(model.names):
        model.names[joint_id] = names.get(name, name)
    for frame in model.frames:
        if frame.type != pinocchio.BODY:
            frame.name = names.get(frame.name, frame.name)


def _built(
    description: Description, xml: str, root_joint: pinocchio.JointModel | None, *, mimic: bool
) -> pinocchio.Model:
    """Pinocchio's model of a URDF text; its errors are raised as `RobotLoadError`."""
    arguments = (xml, mimic) if root_joint is None else (xml, root_joint, mimic)

    def build() -> pinocchio.Model:
        return pinocchio.buildModelFromXML(*arguments)

    try:
        return _on_deep_stack(build) if _depth(description) > DEEP_TREE else build()
    except Exception as error:
        cause = " ".join(str(error).split())
        raise RobotLoadError(f"Pinocchio refuses it: {cause}", source=description.source) from error


def _depth(description: Description) -> int:
    """The largest number of joints between the root and a link."""
    above = {joint.child: joint.parent for joint in description.joints}
    depth = {description.root: 0}
    for link in description.links:
        walk = []
        while link not in depth:
            walk.append(link)
            link = above[link]
        for below, name in enumerate(reversed(walk), start=1):
            depth[name] = depth[link] + below
    return max(depth.values())


def _on_deep_stack(build: Callable[[], pinocchio.Model]) -> pinocchio.Model:
    """Run `build` in a thread whose stack is large enough for the deepest tree that is allowed."""
    from concurrent.futures import ThreadPoolExecutor  # slow to import and rarely needed

    with _stack_size_lock, ThreadPoolExecutor(max_workers=1) as pool:
        usual = threading.stack_size(DEEP_STACK_BYTES)
        try:
            future = pool.submit(build)
        finally:
            threading.stack_size(usual)
        return future.result()
