"""`lint`: all flaws of a robot description that do not keep it from being read, and slips in the types of joints."""

from __future__ import annotations

from collections.abc import Iterator

from ...echoes import QUOTED, shortened
from ..edits import new_value, renamed_element
from ..encodings import as_utf_8
from ..flaw import Flaw
from ..joints import JOINT_KINDS
from ..reader import Description
from ..slips import is_sure, meant
from ..unknown import unknown_parts
from ..xml import DocumentError, Element, parse
from .inertias import inertias
from .limits import followers, limits
from .magnitudes import magnitudes
from .names import materials, similar_names
from .plain import named

__all__ = ["NOTES", "lint"]

NOTES = frozenset({"inertia-singular", "zero-outside-limits"})
"""The codes of flaws that many good robots have; they are worth knowing, but no warnings."""


def lint(document: bytes, description: Description | None = None) -> tuple[Flaw, ...]:
    """The flaws of a robot description that its reader passes over, by line.

    Args:
        document: The bytes of the description. If they are in another encoding than UTF-8, the edits of the flaws
            belong to `encodings.as_utf_8(document)`.
        description: The same description as it was read; None if it could not be read.

    Returns:
        The flaws; none if the document is no XML, or its root is not `<robot>`.
    """
    try:
        content = as_utf_8(document)
        robot = parse(content)
    except DocumentError:
        return ()
    if robot.tag != "robot":
        return tuple(_misspelt_root(robot, content))
    flaws = [
        *unknown_parts(robot, content),
        *magnitudes(robot),
        *inertias(robot),
        *limits(robot),
        *similar_names(robot),
        *materials(robot, content),
        *_second_shapes(robot),
        *_misspelt_types(robot, content),
    ]
    if description is not None:
        flaws.extend(followers(description.joints, robot))
    return tuple(sorted(flaws, key=lambda flaw: flaw.line or 0))


def _misspelt_root(root: Element, content: bytes) -> Iterator[Flaw]:
    if root.tag.casefold() == "robot":
        yield Flaw(
            f"<{root.tag}>",
            "URDF writes <robot> in small letters",
            code="unknown-element",
            line=root.line,
            why="Readers of URDF refuse the file.",
            mend="Write <robot>.",
            edits=renamed_element(content, root, "robot"),
        )


def _second_shapes(robot: Element) -> Iterator[Flaw]:
    """A `<geometry>` with several shapes, of which readers take one."""
    for link in robot.named("link"):
        for part in [*link.named("visual"), *link.named("collision")]:
            for geometry in part.named("geometry"):
                shapes = [child for child in geometry.children if ":" not in child.tag]
                if len(shapes) > 1:
                    kept, *dropped = shapes
                    lost = ", ".join(f"<{shape.tag}>" for shape in dropped[:4])
                    yield Flaw(
                        f"{named(link)}, {part.tag}",
                        f"its <geometry> has {len(shapes)} shapes; the first one, <{kept.tag}>, is taken, "
                        f"and {lost} dropped",
                        code="second-shape",
                        line=dropped[0].line,
                        why=f"A {part.tag} has one shape; other programs take another one of them.",
                        mend=f"Write a <{part.tag}> of its own for each shape.",
                    )


def _misspelt_types(robot: Element, content: bytes) -> Iterator[Flaw]:
    for joint in robot.named("joint"):
        kind = joint.attributes.get("type", "").strip()
        near = None if kind in JOINT_KINDS else meant(kind, JOINT_KINDS)
        if near is not None and is_sure(kind, JOINT_KINDS):
            yield Flaw(
                named(joint),
                f"URDF knows no type {shortened(kind, QUOTED)!r} (near: {near!r})",
                code="loose-type",
                line=joint.line,
                why="The file cannot be loaded.",
                mend=f'Write type="{near}".',
                edits=new_value(content, joint, "type", near),
            )
