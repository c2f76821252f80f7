"""The elements and attributes of URDF 1.0 and 1.1, and what a reader assumes where one of them is missing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

__all__ = ["ASSUMED", "BOUNDED_KINDS", "FOREIGN", "MAIN_ATTRIBUTES", "PLACES", "SYNONYMS", "URDF", "Word"]

BOUNDED_KINDS = ("revolute", "prismatic")
"""The kinds of joints with a lower and an upper limit."""


@dataclass(frozen=True, slots=True)
class Word:
    """What may stand in an element.

    Attributes:
        attributes: The names of its attributes.
        children: The names of its child elements.
        is_open: Whether programs add elements and attributes of their own here.
    """

    attributes: frozenset[str]
    children: frozenset[str]
    is_open: bool


def _word(attributes: str = "", children: str = "", *, is_open: bool = False) -> Word:
    return Word(frozenset(attributes.split()), frozenset(children.split()), is_open)


URDF: Mapping[str, Word] = MappingProxyType({
    "robot": _word("name version", "link joint material transmission gazebo", is_open=True),
    "link": _word("name type", "inertial visual collision gazebo", is_open=True),
    "joint": _word(
        "name type", "origin parent child axis limit dynamics mimic safety_controller calibration gazebo", is_open=True
    ),
    "inertial": _word("", "origin mass inertia"),
    "visual": _word("name", "origin geometry material", is_open=True),
    "collision": _word("name", "origin geometry material verbose contact_coefficients", is_open=True),
    "geometry": _word("", "box sphere cylinder capsule mesh"),
    "material": _word("name", "color texture", is_open=True),
    "origin": _word("xyz rpy quat_xyzw"),
    "parent": _word("link"),
    "child": _word("link"),
    "axis": _word("xyz"),
    "limit": _word("lower upper effort velocity acceleration deceleration jerk"),
    "dynamics": _word("damping friction", is_open=True),
    "mimic": _word("joint multiplier offset"),
    "safety_controller": _word("soft_lower_limit soft_upper_limit k_position k_velocity"),
    "calibration": _word("rising falling reference_position"),
    "mass": _word("value"),
    "inertia": _word("ixx ixy ixz iyy iyz izz"),
    "box": _word("size"),
    "sphere": _word("radius"),
    "cylinder": _word("radius length"),
    "capsule": _word("radius length"),
    "mesh": _word("filename scale", is_open=True),
    "color": _word("rgba"),
    "texture": _word("filename"),
})  # fmt: skip
"""What may stand in each element of URDF, by its name."""

FOREIGN = frozenset({"gazebo", "transmission", "verbose", "contact_coefficients", "safety_controller", "calibration"})
"""Elements of URDF whose content does not belong to it, or has no meaning for kinematics."""

PLACES = frozenset(
    [
        "pose",
        "pos",
        "position",
        "orientation",
        "rotation",
        "translation",
        "transform",
        "transformation",
        "xyz",
        "rpy",
        "quat",
        "quaternion",
        "euler",
    ]
)
"""What other formats call the place of something, for which URDF has `<origin>`; in small letters."""

MAIN_ATTRIBUTES = MappingProxyType({
    "axis": "xyz", "parent": "link", "child": "link", "mimic": "joint", "mass": "value", "color": "rgba",
})  # fmt: skip
"""Element → the attribute that holds what people write as an attribute of its parent, as in `<joint axis="0 0 1">`."""

SYNONYMS = MappingProxyType({
    **{("mesh", name): ("filename", "") for name in ("file", "url", "uri", "src", "path", "href")},
    **{("texture", name): ("filename", "") for name in ("file", "url", "uri", "src", "path", "href")},
    **{(tag, name): ("link", "") for tag in ("parent", "child") for name in ("name", "body")},
    **{(tag, "diameter"): ("radius", "half of it") for tag in ("sphere", "cylinder", "capsule")},
    **{(tag, "height"): ("length", "") for tag in ("cylinder", "capsule")},
    **{("box", name): ("size", "the three lengths of its edges") for name in ("length", "width", "height")},
})  # fmt: skip
"""(Element, what people write as its attribute) → the attribute that URDF has for it, and what to write there if
that is not the same value."""

ASSUMED = MappingProxyType({
    ("robot", "link"): "the link is missing from the robot",
    ("robot", "joint"): "the joint is missing from the robot",
    ("robot", "name"): "the robot has no name",
    ("robot", "material"): "the shapes that use the material are grey",
    ("link", "name"): "the link has no name",
    ("link", "inertial"): "the link has no mass",
    ("link", "visual"): "the shape is not drawn",
    ("link", "collision"): "the shape does not collide",
    ("joint", "origin"): "the joint stands at the origin of its parent link: xyz is taken as 0 0 0 and rpy as 0 0 0",
    ("joint", "axis"): "the axis is taken as 1 0 0",
    ("joint", "limit"): "the joint has no limits",
    ("joint", "mimic"): "the joint follows no other joint",
    ("joint", "parent"): "the joint has no parent link",
    ("joint", "child"): "the joint has no child link",
    ("joint", "dynamics"): "damping and friction are unknown",
    ("joint", "type"): "the joint has no type",
    ("joint", "name"): "the joint has no name",
    ("origin", "xyz"): "xyz is taken as 0 0 0",
    ("origin", "rpy"): "rpy is taken as 0 0 0",
    ("axis", "xyz"): "the axis has no direction",
    ("limit", "lower"): "lower is taken as 0",
    ("limit", "upper"): "upper is taken as 0",
    ("limit", "effort"): "no largest effort is known",
    ("limit", "velocity"): "no largest velocity is known",
    ("dynamics", "damping"): "the damping is unknown",
    ("dynamics", "friction"): "the friction is unknown",
    ("mimic", "joint"): "the joint has nothing to follow",
    ("mimic", "multiplier"): "the multiplier is taken as 1",
    ("mimic", "offset"): "the offset is taken as 0",
    ("parent", "link"): "the joint has no parent link",
    ("child", "link"): "the joint has no child link",
    ("inertial", "origin"): "the centre of mass is taken at the origin of the link",
    ("inertial", "mass"): "the link is taken as massless",
    ("inertial", "inertia"): "the link is taken as massless",
    ("mass", "value"): "the mass is unknown",
    ("visual", "origin"): "the shape stands at the origin of the link",
    ("visual", "geometry"): "the shape is left out",
    ("visual", "material"): "the shape has no colour",
    ("collision", "origin"): "the shape stands at the origin of the link",
    ("collision", "geometry"): "the shape is left out",
    ("mesh", "scale"): "the mesh keeps its own size",
    ("mesh", "filename"): "the shape is left out",
    ("material", "color"): "the material has no colour",
    ("color", "rgba"): "the material has no colour",
})  # fmt: skip
"""(Element, its attribute or child) → what is assumed without it, as a clause."""
