"""Why each sort of flaw matters, and what to do about it, where a flaw has no words of its own for that."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

__all__ = ["ADVICE", "Advice"]


class Advice(NamedTuple):
    """What can be said about a sort of flaw.

    Attributes:
        why: Why it matters, in one sentence.
        mend: What to do about it, in one sentence.
    """

    why: str
    mend: str


_LOST = "What it says is lost, as readers of URDF ignore it without a word."
_NOT_DRAWN = "The shape is missing from pictures and the live view; kinematics works without it."
_DYNAMICS = "Dynamics with this link is wrong, or fails; kinematics does not use it."
_UNITS = "Check the units: kg and kg m²."
_COMPUTE = "Compute the inertia about the centre of mass again."
_EXPORT = "Export the mesh again, as STL, OBJ, COLLADA or glTF."
_OTHERS = "Other programs refuse the file, or read it in another way."

ADVICE: Mapping[str, Advice] = MappingProxyType({
    "pose-outside-limits": Advice(
        "No configuration inside the limits is this pose, so nothing can start from it.",
        "Correct the pose in the SRDF, or the limits of the joint.",
    ),
    "bad-srdf": Advice("Without the SRDF there are no poses.", "Correct what is named in the SRDF."),
    "unknown-element": Advice(_LOST, "Write the name that URDF has."),
    "unknown-attribute": Advice(_LOST, "Write the name that URDF has."),
    "unknown-name": Advice(_LOST, "Take it out."),
    "stray-text": Advice(_LOST, "Take it out; URDF has attributes instead."),
    "misplaced-element": Advice(_LOST, "Move it to its place, or take it out."),
    "misplaced-attribute": Advice(_LOST, "Move it to its place, or take it out."),
    "second-shape": Advice("Programs differ in which of the shapes they take.", "Write an element for each shape."),
    "limit-in-degrees": Advice(
        "The joint is as good as unlimited: solutions may wind it up by whole turns.", "Write the limits in radians."
    ),
    "limit-in-millimetres": Advice("The joint can slide far out of the robot.", "Write the limits in metres."),
    "rpy-in-degrees": Advice("The orientation is another one than the file seems to say.", "Write rpy in radians."),
    "origin-in-millimetres": Advice("It stands far from the rest of the robot.", "Write xyz in metres."),
    "inertia-not-positive": Advice(_DYNAMICS, _COMPUTE),
    "inertia-singular": Advice(_DYNAMICS, "Give the inertia about the centre of mass, if dynamics is wanted."),
    "inertia-triangle": Advice(_DYNAMICS, _COMPUTE),
    "massless-inertia": Advice(_DYNAMICS, "Give the mass, or remove <inertial>."),
    "density": Advice(_DYNAMICS, _UNITS),
    "soft-limits": Advice(
        "A controller that keeps them lets the joint go nowhere; kinematics does not use them.",
        "Swap soft_lower_limit and soft_upper_limit, or correct one of them.",
    ),
    "no-travel": Advice(
        "Solves that need the joint miss their targets.", 'Give its limits, or write type="fixed".'
    ),
    "zero-outside-limits": Advice(
        "The neutral configuration breaks the limits; solves start from the nearest one inside.",
        "Nothing, if this is meant; give a start (q0) where it matters.",
    ),
    "follower-narrows": Advice(
        "pinik keeps followers inside their limits, and other programs do not.",
        "Give leader and follower limits that fit the multiplier and the offset.",
    ),
    "follower-limits": Advice(
        "The follower may go beyond its own limits when its leader moves.",
        "Give leader and follower limits that fit the multiplier and the offset.",
    ),
    "similar-names": Advice(
        "The two are easily confused, and some programs take them for one.",
        "Rename one of them, and all that refers to it.",
    ),
    "material-twice": Advice(
        "Programs differ in which of the two colours they take.", "Give the materials different names."
    ),
    "undefined-material": Advice("The shape is drawn grey.", "Define it, with a <color>, below <robot>."),
    "shape-too-large": Advice(
        "The shape hides the robot.", 'If the mesh is in millimetres, write scale="0.001 0.001 0.001".'
    ),
    "shape-too-small": Advice("The shape cannot be seen.", "Check the mesh's scale."),
    "missing-mesh": Advice(_NOT_DRAWN, "Put the mesh where its address says, or correct the address."),
    "mesh-outside": Advice(_NOT_DRAWN, "Move the mesh into a folder that belongs to the robot."),
    "lfs-pointer": Advice(_NOT_DRAWN, "Fetch the meshes by git lfs pull."),
    "not-a-mesh": Advice(_NOT_DRAWN, _EXPORT),
    "unknown-mesh-format": Advice(_NOT_DRAWN, _EXPORT),
    "mesh-archive": Advice(_NOT_DRAWN, "Unpack the archive, and name the mesh in it."),
    "mesh-too-large": Advice(_NOT_DRAWN, "Export the mesh with fewer triangles."),
    "truncated-mesh": Advice(_NOT_DRAWN, "Fetch or export the mesh again."),
    "empty-mesh": Advice(_NOT_DRAWN, "Export the mesh again, or take the shape out."),
    "nan-in-mesh": Advice(_NOT_DRAWN, _EXPORT),
    "unreadable-mesh": Advice(_NOT_DRAWN, _EXPORT),
    "unreadable-shape": Advice(_NOT_DRAWN, "Correct what the cause names, or take the shape out."),
    "dropped-shape": Advice(_NOT_DRAWN, "Correct what the cause names, or take the shape out."),
    "bad-inertial": Advice(_DYNAMICS, "Give <inertial> a mass and an inertia in plain numbers, or take it out."),
    "bad-strength": Advice(
        "What the joint can bear, or how it rubs, is unknown; placements do not need it.",
        "Write a plain number that is not negative, in SI units.",
    ),
    "bad-color": Advice("The shape is drawn grey.", "Write rgba as four numbers from 0 to 1."),
    "bright-color": Advice("Programs differ in what they make of such a colour.", "Write numbers from 0 to 1."),
    "loose-number": Advice(_OTHERS, "Write plain numbers with spaces between them, in SI units."),
    "loose-type": Advice(_OTHERS, "Write the type without white space."),
    "loose-scale": Advice(_OTHERS, "Write three numbers."),
    "empty-origin": Advice(_OTHERS, 'Write "0 0 0".'),
    "second-element": Advice("Programs differ in which of the elements they take.", "Remove all of them but one."),
    "no-name": Advice("Other programs refuse the file.", "Write <robot name=…>."),
    "junk-around": Advice("Other programs refuse the file, as it is no XML.", "Take out what stands around it."),
    "bad-comment": Advice(
        "Other programs refuse the file, as it is no XML.", 'Write "- -" instead of "--" inside comments.'
    ),
    "encoding": Advice(
        "Names with other letters than those of English may be read wrongly, and other programs refuse the file.",
        'Save the file in UTF-8, and write encoding="utf-8" in its declaration.',
    ),
    "xacro": Advice(
        "The URDF that xacro makes may not be the one that is meant.", "Correct the xacro file where xacro says."
    ),
    "absent-limit": Advice(
        "The joint may have less travel than is meant, or none.", "Write both lower= and upper= in <limit>."
    ),
    "endless-limit": Advice(
        "Solves take the joint as unlimited, and other programs may refuse the number.",
        "Write the limits that the joint has.",
    ),
    "limit-ignored": Advice("Solutions may go beyond the limit that is meant.", "Take <limit> out."),
    "planar-axis": Advice(
        "Other programs move such a joint in another plane.", "Write the normal of its plane as <axis xyz=…>."
    ),
    "mimic-ignored": Advice(
        "The joint moves on its own, and not with the one that is meant.",
        "Name a joint with one axis as the leader, or take <mimic> out.",
    ),
    "mimic-left-free": Advice(
        "The joint moves on its own, and not with its leader.",
        "Give it a multiplier other than 0, or let the leader mimic it.",
    ),
    "changed-roles": Advice(
        "The vector q holds the angle of the follower, and not that of the leader.",
        "Nothing, if angles are given by name; or let the leader mimic this joint instead.",
    ),
    "other": Advice("pinik, or a library that it uses, found something odd.", "Read what the warning says."),
})  # fmt: skip
"""Code of a flaw → why it matters, and what to do about it."""
