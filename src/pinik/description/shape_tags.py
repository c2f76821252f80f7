"""Read and check `<visual>` and `<collision>`; a shape that cannot be read is left out, with a warning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from ..echoes import QUOTED, shortened
from .addresses import is_expression
from .materials import Color, color_of
from .numbers import FARTHEST, Reading
from .part import Part, Vector

__all__ = ["ShapeTag", "read_shapes"]

# The dimensions of each shape: attribute, and its count of numbers.
SHAPE_SIZES = {
    "box": (("size", 3),),
    "sphere": (("radius", 1),),
    "cylinder": (("radius", 1), ("length", 1)),
    "capsule": (("radius", 1), ("length", 1)),
    "mesh": (),
}
_SMALLEST = 1.0 / FARTHEST  # [m]: volumes and areas of smaller shapes could underflow


@dataclass(frozen=True)
class ShapeTag:
    """One `<visual>` or `<collision>`.

    Attributes:
        index: Its place among the elements of this tag in its link, from 0; shapes that were left out count too.
        line: Its line in the file, from 1.
        kind: "box", "sphere", "cylinder", "capsule" or "mesh".
        xyz: Its origin in the link's frame [m].
        rpy: Its orientation in the link's frame: fixed-axis roll, pitch, yaw [rad].
        size: A box's three edges, a sphere's radius, a cylinder's or capsule's radius and length [m]; a mesh's scale
            along its three axes.
        filename: The address of a mesh as written; empty for other shapes.
        color: The colour that the file gives it, if any.
    """

    index: int
    line: int
    kind: str
    xyz: Vector
    rpy: Vector
    size: tuple[float, ...]
    filename: str = ""
    color: Color | None = None


def read_shapes(link: Part, tag: str, colors: Mapping[str, Color]) -> tuple[ShapeTag, ...]:
    """The shapes of a link that can be read; the others are flaws.

    Args:
        link: The `<link>`.
        tag: "visual" or "collision".
        colors: The colours of the materials that have a name.
    """
    elements = link.element.named(tag)
    shapes = []
    for index, element in enumerate(elements):
        place = f"{link.owner}, {tag} {index + 1}" if len(elements) > 1 else f"{link.owner}, {tag}"
        shape = link.of(element, place).unless_faulty(
            partial(_read_shape, index=index, colors=colors),
            "the shape is left out",
            code="dropped-shape",
            common="a shape that cannot be read is left out",
        )
        if shape is not None:
            shapes.append(shape)
    return tuple(shapes)


def _read_shape(part: Part, index: int, colors: Mapping[str, Color]) -> ShapeTag:
    for element in part.element.walk():
        for attribute, text in element.attributes.items():
            if is_expression(attribute, text):
                raise part.fault(f'<{element.tag} {attribute}="{shortened(text, QUOTED)}"> is a xacro expression')
    xyz, rpy = part.origin()
    geometry = part.only("geometry")
    solid = geometry.of(geometry.element.children[0]) if geometry and geometry.element.children else None
    if solid is None or solid.element.tag not in SHAPE_SIZES:
        raise part.fault("has no shape" if solid is None else f"<{solid.element.tag}> is not a URDF shape")
    kind = solid.element.tag
    is_mesh = kind == "mesh"
    return ShapeTag(
        index=index,
        line=part.element.line,
        kind=kind,
        xyz=xyz,
        rpy=rpy,
        size=_scale(solid) if is_mesh else _size(solid),
        filename=solid.text("filename") if is_mesh else "",
        color=_color(part, colors),
    )


def _size(solid: Part) -> tuple[float, ...]:
    values: list[float] = []
    for attribute, count in SHAPE_SIZES[solid.element.tag]:
        solid.text(attribute)
        sizes = solid.numbers(attribute, (count,), "length")
        if min(sizes) <= 0.0:
            raise solid.bad_value(attribute, "sizes must be positive")
        if min(sizes) < _SMALLEST:
            raise solid.bad_value(attribute, f"sizes must be at least {_SMALLEST:g} m")
        values.extend(sizes)
    return tuple(values)


def _scale(mesh: Part) -> tuple[float, ...]:
    """The scale of a mesh; a negative one mirrors it, as is common for left and right limbs."""
    text = mesh.element.attributes.get("scale", "")
    if not text.strip():
        return (1.0, 1.0, 1.0)
    scale = mesh.numbers("scale", (1, 3, 4))
    if len(scale) != 3:
        what, how = ("one number", "for all axes") if len(scale) == 1 else ("four numbers", "without the last")
        scale = scale * 3 if len(scale) == 1 else scale[:3]
        reading = Reading(scale)
        mesh.misread(
            "scale",
            f'<mesh scale="{text.strip()}"> has {what} instead of three; it is read as "{reading}"',
            reading.exact,
            code="loose-scale",
            common=f"a mesh's scale has {what} instead of three, and is taken {how}",
        )
    if min(map(abs, scale)) < _SMALLEST:
        raise mesh.bad_value("scale", f"a scale must not be zero, or smaller than {_SMALLEST:g}")
    return scale


def _color(part: Part, colors: Mapping[str, Color]) -> Color | None:
    """The colour of a visual: the material's own one, or that of the material of the same name."""
    material = part.only("material") if part.element.tag == "visual" else None
    if material is None:
        return None
    # The flaws of materials are found where all of them are read, `named_colors`.
    return color_of(material.element, part.owner) or colors.get(material.element.attributes.get("name", ""))
