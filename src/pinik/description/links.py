"""Read and check a `<link>`: its mass and inertia, and its shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .flaw import Flaw
from .materials import Color
from .part import Part, Vector
from .shape_tags import ShapeTag, read_shapes
from .xml import Element

__all__ = ["INERTIA_ATTRIBUTES", "Inertial", "LinkTag", "read_link"]

INERTIA_ATTRIBUTES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


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
        inertial: Its mass and inertia, if the file gives them and they can be read.
        visuals: Its visual shapes that can be read, in the file's order.
        collisions: Its collision shapes, likewise.
    """

    name: str
    inertial: Inertial | None
    visuals: tuple[ShapeTag, ...]
    collisions: tuple[ShapeTag, ...]

    @property
    def shapes(self) -> tuple[ShapeTag, ...]:
        """All of its shapes that can be read, the visual ones first."""
        return self.visuals + self.collisions


def read_link(element: Element, colors: Mapping[str, Color], flaws: list[Flaw], document: bytes) -> LinkTag:
    """Read and check a `<link>`. What is left out or assumed is added to `flaws`.

    Args:
        element: The `<link>`.
        colors: The colours of the materials that have a name.
        flaws: The list of flaws.
        document: The bytes in which the element stands.

    Raises:
        DocumentError: The link has no name.
    """
    link = Part.named(element, flaws, document)
    return LinkTag(
        name=link.name,
        visuals=read_shapes(link, "visual", colors),
        collisions=read_shapes(link, "collision", colors),
        inertial=_read_inertial(link),
    )


def _read_inertial(link: Part) -> Inertial | None:
    """The `<inertial>`; None if there is none, or if something in it cannot be read, which is a flaw."""
    inertial = link.only("inertial")
    if inertial is None:
        return None
    massless = "the link is taken as massless"
    common = f"<inertial> cannot be read; {massless}"
    return inertial.unless_faulty(_checked_inertial, massless, code="bad-inertial", common=common)


def _checked_inertial(inertial: Part) -> Inertial:
    xyz, rpy = inertial.origin()
    parts = {tag: inertial.only(tag) for tag in ("mass", "inertia")}
    mass_part, inertia_part = parts["mass"], parts["inertia"]
    if mass_part is None or inertia_part is None:
        raise inertial.fault(f"<inertial> has no <{next(tag for tag, part in parts.items() if part is None)}>")
    mass_part.text("value")
    mass = mass_part.numbers("value", (1,), "mass")[0]
    if mass < 0.0:
        raise mass_part.bad_value("value", "the mass is negative")
    inertia: list[float] = []
    for attribute in INERTIA_ATTRIBUTES:
        inertia_part.text(attribute)
        inertia.extend(inertia_part.numbers(attribute, (1,)))
    return Inertial(xyz, rpy, mass, tuple(inertia))
