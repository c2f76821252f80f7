"""Read and check a `<link>`: its mass and inertia, and the addresses of its meshes."""

from __future__ import annotations

from dataclasses import dataclass

from .flaw import Flaw
from .values import Vector, attribute_text, bad_value, number, numbers, only_child, read_origin, required_name, vector
from .xml import Element

__all__ = ["INERTIA_ATTRIBUTES", "Inertial", "LinkTag", "read_link"]

INERTIA_ATTRIBUTES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
# The dimensions of each shape: attribute, and its count of numbers.
SHAPE_SIZES = {
    "box": (("size", 3),),
    "sphere": (("radius", 1),),
    "cylinder": (("radius", 1), ("length", 1)),
    "capsule": (("radius", 1), ("length", 1)),
    "mesh": (),
}


@dataclass(frozen=True)
class Inertial:
    """The `<inertial>` of a link.

    Attributes:
        xyz: The centre of mass in the link's frame [m].
        rpy: The orientation of the inertia's axes in the link's frame: roll, pitch, yaw [rad].
        mass: The mass [kg].
        inertia: ixx, ixy, ixz, iyy, iyz and izz about the centre of mass [kg m²].
    """

    xyz: Vector
    rpy: Vector
    mass: float
    inertia: tuple[float, ...]


@dataclass(frozen=True)
class LinkTag:
    """One `<link>`.

    Attributes:
        name: Its name.
        inertial: Its mass and inertia, if the file gives them.
        meshes: The addresses of its meshes as written, in the file's order.
    """

    name: str
    inertial: Inertial | None
    meshes: tuple[str, ...]


def read_link(element: Element, warnings: list[str]) -> LinkTag:
    """Read and check a `<link>`. Parts that are left out are named in `warnings`, which is appended to.

    Raises:
        DocumentError: A number is malformed, not finite or out of range, or a required attribute is missing.
    """
    name = required_name(element)
    owner = f"link {name!r}"
    meshes: list[str] = []
    for tag in ("visual", "collision"):
        shapes = element.named(tag)
        for index, shape in enumerate(shapes, start=1):
            place = f"{owner}, {tag} {index}" if len(shapes) > 1 else f"{owner}, {tag}"
            meshes.extend(_read_shape(shape, place, warnings))
    inertial = only_child(element, "inertial", owner)
    return LinkTag(
        name=name,
        inertial=None if inertial is None else _read_inertial(inertial, owner, warnings),
        meshes=tuple(meshes),
    )


def _read_inertial(element: Element, owner: str, warnings: list[str]) -> Inertial | None:
    xyz, rpy = read_origin(element, f"{owner}, inertial")
    mass_element = only_child(element, "mass", owner)
    inertia_element = only_child(element, "inertia", owner)
    mass = None
    if mass_element is not None:
        attribute_text(mass_element, "value", owner)
        mass = number(mass_element, "value", owner)
        if mass is not None and mass < 0.0:
            raise bad_value(mass_element, "value", owner, "the mass is negative")
    inertia = []
    if inertia_element is not None:
        for attribute in INERTIA_ATTRIBUTES:
            attribute_text(inertia_element, attribute, owner)
            inertia.append(number(inertia_element, attribute, owner) or 0.0)
    if mass is None or inertia_element is None:
        absent = "mass" if mass is None else "inertia"
        cause = f"<inertial> has no <{absent}>; the link is taken as massless"
        warnings.append(Flaw(owner, cause, code="incomplete-inertial", line=element.line))
        return None
    return Inertial(xyz, rpy, mass, tuple(inertia))


def _read_shape(shape: Element, owner: str, warnings: list[str]) -> tuple[str, ...]:
    """Check a `<visual>` or `<collision>`; return the address of its mesh, if it has one."""
    read_origin(shape, owner)
    geometry = only_child(shape, "geometry", owner)
    solid = geometry.children[0] if geometry is not None and geometry.children else None
    if solid is None or solid.tag not in SHAPE_SIZES:
        what = "has no shape" if solid is None else f"<{solid.tag}> is not a URDF shape"
        warnings.append(Flaw(owner, f"{what}; it is left out", code="dropped-shape", line=shape.line))
        return ()
    for attribute, count in SHAPE_SIZES[solid.tag]:
        attribute_text(solid, attribute, owner)
        if min(numbers(solid, attribute, count, owner)) <= 0.0:
            raise bad_value(solid, attribute, owner, "sizes must be positive")
    if solid.tag != "mesh":
        return ()
    # A negative scale mirrors the mesh, as is common for left and right limbs.
    if 0.0 in vector(solid, "scale", owner, (1.0, 1.0, 1.0)):
        raise bad_value(solid, "scale", owner, "a scale must not be zero")
    return (attribute_text(solid, "filename", owner),)
