"""The colours of a robot's materials; a colour that cannot be read is left out."""

from __future__ import annotations

from ..echoes import QUOTED, shortened
from .flaw import Flaw
from .numbers import Reading
from .part import Part
from .xml import DocumentError, Element

__all__ = ["Color", "color_of", "materials_of_visuals", "named_colors"]

Color = tuple[float, float, float, float]
"""Red, green, blue, opacity, each in 0..1."""

_BYTE = 255.0


def named_colors(robot: Element, flaws: list[Flaw], document: bytes) -> dict[str, Color]:
    """The colours of all materials that have a name: those of `<robot>` first, then those in links, the first of each.

    Flaws in them are added to `flaws`, with edits of `document`.
    """
    in_links = [material for _, material in materials_of_visuals(robot)]
    colors: dict[str, Color] = {}
    for material in [*robot.named("material"), *in_links]:
        name = material.attributes.get("name", "")
        color = color_of(
            material, f"material {shortened(name, QUOTED)!r}" if name else "material without a name", flaws, document
        )
        if color is not None and name:
            colors.setdefault(name, color)
    return colors


def materials_of_visuals(robot: Element) -> list[tuple[Element, Element]]:
    """(link, material) for each `<material>` in a visual shape, in the file's order."""
    return [
        (link, material)
        for link in robot.named("link")
        for visual in link.named("visual")
        for material in visual.named("material")
    ]


def color_of(material: Element, owner: str, flaws: list[Flaw] | None = None, document: bytes = b"") -> Color | None:
    """The colour that a `<material>` itself gives; None if there is none, or none that can be read.

    Args:
        material: The element.
        owner: What flaws call it.
        flaws: The list to which its flaws are added; None to add them nowhere.
        document: The bytes in which the element stands; empty if its flaws need no edits.
    """
    noted: list[Flaw] = [] if flaws is None else flaws
    part = Part(material, owner, noted, document).only("color")
    if part is None:
        return None
    try:
        part.text("rgba")
        values = part.numbers("rgba", (4,))
        if not all(0.0 <= value <= _BYTE for value in values):
            raise part.bad_value("rgba", "must be four numbers from 0 to 1")
    except DocumentError as fault:
        cause = f"{fault.message}; its colour is left out"
        part.flaw(cause, code="bad-color", common="it has no colour that can be read; it is grey")
        return None
    return _within_one(part, values)


def _within_one(part: Part, values: tuple[float, ...]) -> Color:
    """The colour, with numbers above 1 read as 0..255 if they look so, and cut to 1 if not."""
    *rgb, opacity = values
    if max(values) <= 1.0:
        red, green, blue = rgb
        return red, green, blue, opacity
    if max(rgb) >= 2.0 and all(value.is_integer() for value in rgb):
        red, green, blue = (value / _BYTE for value in rgb)
        opacity = opacity / _BYTE if opacity > 1.0 else opacity
        how = "read as red, green and blue from 0 to 255"
    else:
        red, green, blue, opacity = (min(value, 1.0) for value in values)
        how = "cut to 1"
    text = shortened(part.element.attributes["rgba"], QUOTED)
    part.misread(
        "rgba",
        f'<color rgba="{text}"> has numbers above 1, which are {how}',
        Reading((red, green, blue, opacity)).exact,
        code="bright-color",
        common=f"its colour has numbers above 1, which are {how}",
    )
    return red, green, blue, opacity
