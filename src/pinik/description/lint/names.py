"""Names that are easily confused, and names of materials that lead nowhere."""

from __future__ import annotations

from collections.abc import Iterator

from ..edits import escaped, start_tag
from ..flaw import Edit, Flaw
from ..materials import materials_of_visuals
from ..xml import Element
from .plain import named

__all__ = ["materials", "similar_names"]


def similar_names(robot: Element) -> Iterator[Flaw]:
    """Links and joints whose names differ only in upper and lower case from that of an earlier one."""
    for tag in ("link", "joint"):
        first: dict[str, Element] = {}
        for element in robot.named(tag):
            name = element.attributes.get("name", "")
            other = first.setdefault(name.casefold(), element)
            if other.attributes.get("name", "") != name:
                yield Flaw(
                    named(element),
                    f"its name differs from that of {named(other)} (line {other.line}) only in upper and lower case",
                    code="similar-names",
                    line=element.line,
                    common=f"its name differs from that of another {tag} only in upper and lower case",
                )


def materials(robot: Element, document: bytes) -> Iterator[Flaw]:
    """Shapes whose material is nowhere defined, and materials that are defined twice with different colours."""
    in_shapes = materials_of_visuals(robot)
    defined: dict[str, Element] = {}
    for material in [*robot.named("material"), *(material for _, material in in_shapes)]:
        name = material.attributes.get("name", "")
        if not material.named("color") and not material.named("texture"):
            continue
        first = defined.setdefault(name, material)
        if name and _rgba(first) != _rgba(material):
            yield Flaw(
                named(material),
                f"it is defined on line {first.line} with another colour",
                code="material-twice",
                line=material.line,
                common="it is defined before with another colour",
            )
    folded: dict[str, list[str]] = {}
    for name in defined:
        folded.setdefault(name.casefold(), []).append(name)
    for link, material in in_shapes:
        name = material.attributes.get("name", "")
        if name and name not in defined and not material.named("color") and not material.named("texture"):
            yield _undefined(link, material, folded.get(name.casefold(), []), document)


def _undefined(link: Element, material: Element, near: list[str], document: bytes) -> Flaw:
    edits: tuple[Edit, ...] = ()
    mend = ""
    if len(near) == 1:
        place = start_tag(document, material).attributes["name"].value
        edits = (Edit(*place, escaped(near[0])),)
        mend = f"Write <material name={near[0]!r}>, which is defined."
    return Flaw(
        named(link),
        f"its {named(material)} is defined nowhere; the shape has no colour",
        code="undefined-material",
        line=material.line,
        common="the material of its shape is defined nowhere; the shape has no colour",
        mend=mend,
        edits=edits,
    )


def _rgba(material: Element) -> list[list[str]]:
    return [color.attributes.get("rgba", "").split() for color in material.named("color")]
