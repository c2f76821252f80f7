"""Find elements and attributes that URDF does not know, or not at their place, with the names that were meant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ..echoes import QUOTED, shortened
from .edits import moved_to_child, renamed_attribute, renamed_element
from .flaw import Edit, Flaw
from .numbers import NumberError, read_numbers
from .slips import is_sure, meant, rivals
from .vocabulary import ASSUMED, BOUNDED_KINDS, FOREIGN, MAIN_ATTRIBUTES, PLACES, SYNONYMS, URDF, Word
from .xml import Element

__all__ = ["unknown_in_joints", "unknown_parts"]

_WHY_KINEMATICS = "The joint or link is not where the file seems to say."
_DIRECTIONS = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1", "-x": "-1 0 0", "-y": "0 -1 0", "-z": "0 0 -1"}
_ORIGIN = "Write <origin xyz=… rpy=…> in <{}>, in metres and radians."
_TREE = frozenset({"link", "joint"})
_MOST_SHOWN = 4
_MANY = _TREE | frozenset({"visual", "collision"})  # of these an element may hold several
# What places links → what is assumed where it is not said in the way of URDF. A limit tells of its own if it has none.
_PLACING = {"origin": ("xyz", "rpy"), "mimic": ("multiplier", "offset"), "axis": (), "parent": (), "child": ()}


@dataclass(frozen=True, slots=True)
class _Place:
    """An element under inspection.

    Attributes:
        element: The element.
        word: What may stand in it.
        owner: What messages call the link or joint that it belongs to.
        document: The bytes of the document; None if nobody wants edits.
        given: The names of those of its children that URDF knows.
        rivals: The names that several words in it seem to mean, each with these words; empty if nobody wants edits.
    """

    element: Element
    word: Word
    owner: str
    document: bytes | None
    given: frozenset[str]
    rivals: Mapping[str, Sequence[str]]


def unknown_parts(robot: Element, document: bytes) -> list[Flaw]:
    """Everything in a robot description that URDF does not know, with edits where there is one answer.

    What programs add is let alone: elements and attributes with a prefix, `<gazebo>` and `<transmission>`, and other
    elements below `<robot>`, `<link>`, `<joint>` and shapes, unless their name resembles one of URDF.

    Args:
        robot: The root element.
        document: The bytes that it was parsed from, in UTF-8.
    """
    return [flaw for element, owner in _known(robot) for flaw in _unknown(element, owner, document)]


def unknown_in_joints(robot: Element) -> list[Flaw]:
    """What is lost of `<robot>` and of joints because it is misspelt, misplaced, or no attribute; without edits."""
    # Nearly all elements are right, and loading must be quick.
    flaws = [] if _is_known(robot) else list(_unknown(robot, "<robot>", None))
    for joint in robot.named("joint"):
        inside = [child for child in joint.children if child.tag not in FOREIGN]
        if not (_is_known(joint) and all(map(_is_known, inside))):
            for element, owner in _within(joint):
                found = _unknown(element, owner, None)
                flaws.extend(flaw for flaw in found if flaw.code != "unknown-name" or _places(element, joint))
    for link in robot.named("link"):
        if any(element.tag in _TREE for child in link.children for element in child.walk()):
            for element, owner in _within(link):
                place, lost = _place(element, owner, None), [one for one in element.children if one.tag in _TREE]
                flaws.extend(flaw for child in lost for flaw in _unknown_child(place, child))
    return [flaw for flaw in flaws if flaw.code != "unknown-name" or not flaw.element.startswith("<robot>")]


def _places(element: Element, joint: Element) -> bool:
    """Whether an element of a joint decides where links are, so that an unknown name in it matters.

    Unknown attributes of a `<limit>` are not reported here if a limit is missing: the flaw that says so names them.
    """
    if element.tag != "limit":
        return element.tag in _PLACING
    needs_limits = joint.attributes.get("type", "").strip() in BOUNDED_KINDS
    return needs_limits and bool(element.children) and not {"lower", "upper"} <= element.attributes.keys()


def _is_known(element: Element) -> bool:
    word = URDF.get(element.tag)
    return word is None or (
        not element.text
        and element.attributes.keys() <= word.attributes
        and {child.tag for child in element.children} <= word.children
    )


def _known(robot: Element) -> Iterator[tuple[Element, str]]:
    """The elements that URDF knows, each with its owner."""
    yield robot, "<robot>"
    for part in robot.children:
        if part.tag in URDF and part.tag not in FOREIGN:
            yield from _within(part)


def _within(part: Element) -> Iterator[tuple[Element, str]]:
    """A link, joint or material and what URDF knows in it, each with its owner."""
    owner = f"{part.tag} {shortened(part.attributes.get('name', ''), QUOTED)!r}"
    pending = [part]
    while pending:
        element = pending.pop()
        yield element, owner
        known = URDF[element.tag].children - FOREIGN
        pending.extend(child for child in reversed(element.children) if child.tag in known)


def _unknown(element: Element, owner: str, document: bytes | None) -> Iterator[Flaw]:
    place = _place(element, owner, document)
    if element.text:
        yield _stray_text(place)
    for attribute in element.attributes:
        if attribute not in place.word.attributes and ":" not in attribute and attribute != "xmlns":
            yield from _unknown_attribute(place, attribute)
    for child in element.children:
        if child.tag not in place.word.children and ":" not in child.tag and "xmlns" not in child.attributes:
            yield from _unknown_child(place, child)


def _place(element: Element, owner: str, document: bytes | None) -> _Place:
    word = URDF[element.tag]
    given = word.children.intersection(child.tag for child in element.children)
    several = {} if document is None else rivals(element, given - _MANY)
    return _Place(element, word, owner, document, given, several)


def _stray_text(place: _Place) -> Flaw:
    tag, main = place.element.tag, "xyz" if place.element.tag == "origin" else MAIN_ATTRIBUTES.get(place.element.tag)
    cause = f"the text {shortened(place.element.text, QUOTED)!r} in <{tag}> is ignored{_losses(place)}"
    mend = f"Write it as <{tag} {main}=…>, or take it out." if main else "Take it out; URDF has attributes instead."
    return _flaw(place, cause, code="stray-text", mend=mend)


def _unknown_attribute(place: _Place, attribute: str) -> Iterator[Flaw]:
    element, word = place.element, place.word
    tag = element.tag
    held = f"<{tag} {shortened(attribute, QUOTED)}=…>"
    near = meant(attribute, word.attributes, element.attributes)
    if near is None and (child := attribute.casefold()) in word.children:
        yield _attribute_of_child(place, attribute, child)
    elif near is None and (homes := _homes(place, attribute)):
        cause = f"{held} is unknown to URDF and ignored; URDF has {attribute!r} in {' or '.join(homes)}"
        written = " or as ".join(home.replace(">", f" {attribute}=…>") for home in homes)
        yield _flaw(place, cause, code="misplaced-attribute", mend=f"Write it as {written}.")
    elif near is not None:
        cause = f"{held} is unknown to URDF and ignored (near: {near!r}){_loss(place, near)}"
        edits: tuple[Edit, ...] = ()
        is_free = near not in element.attributes and near not in place.rivals
        if place.document is not None and is_sure(attribute, word.attributes) and is_free:
            edits = renamed_attribute(place.document, element, attribute, near)
        mend = _choice(place, near) or f"Write {near}= instead of {shortened(attribute, QUOTED)}=."
        yield _flaw(place, cause, code="unknown-attribute", mend=mend, edits=edits)
    elif (synonym := SYNONYMS.get((tag, attribute.casefold()))) and synonym[0] not in element.attributes:
        near, value = synonym
        cause = f"{held} is unknown to URDF and ignored; URDF has {near!r}{_loss(place, near)}"
        mend = f"Write {near}= instead of it{f', with {value}' if value else ''}."
        yield _flaw(place, cause, code="unknown-attribute", mend=mend)
    elif _means_origin(place, attribute):
        cause = f"{held} is unknown to URDF and ignored; URDF has <origin xyz=… rpy=…>{_loss(place, 'origin')}"
        yield _flaw(place, cause, code="unknown-attribute", mend=_ORIGIN.format(tag))
    elif not word.is_open:
        known = ", ".join(sorted(word.attributes)) or "no attributes"
        cause = f"{held} is unknown to URDF and ignored{_losses(place)}"
        yield _flaw(place, cause, code="unknown-name", mend=f"Take it out; <{tag}> has {known}.")


def _attribute_of_child(place: _Place, attribute: str, child: str) -> Flaw:
    """`<joint axis="0 0 1">`, where URDF has `<axis xyz="0 0 1"/>`."""
    element = place.element
    main = MAIN_ATTRIBUTES.get(child)
    written = f"<{child} {main}=…>" if main else f"<{child} …>"
    cause = f"{attribute} is an attribute here and ignored; URDF has {written}{_loss(place, child)}"
    edits: tuple[Edit, ...] = ()
    text = element.attributes[attribute]
    is_free = child not in place.given and child not in place.rivals
    if place.document is not None and main and is_free and _can_be(element, child, text):
        edits = moved_to_child(place.document, element, attribute, child, main)
    text = _DIRECTIONS.get(text.strip().casefold(), text) if child == "axis" else text
    example = f'<{child} {main}="{shortened(text, QUOTED)}"/>' if main else written
    mend = _choice(place, child) or f"Write {example} inside <{element.tag}>."
    return _flaw(place, cause, code="misplaced-attribute", mend=mend, edits=edits)


def _unknown_child(place: _Place, child: Element) -> Iterator[Flaw]:
    element, word = place.element, place.word
    tag = shortened(child.tag, QUOTED)
    near = meant(child.tag, word.children, place.given - _MANY)
    if near is not None:
        cause = f"<{tag}> is unknown to URDF and ignored with all that it holds (near: <{near}>){_loss(place, near)}"
        edits: tuple[Edit, ...] = ()
        is_free = near in _MANY or (near not in place.given and near not in place.rivals)
        if place.document is not None and is_sure(child.tag, word.children) and is_free:
            edits = renamed_element(place.document, child, near)
        mend = _choice(place, near) or f"Write <{near}> instead of <{tag}>."
        yield _flaw(place, cause, child, code="unknown-element", mend=mend, edits=edits)
    elif child.tag in URDF:
        homes = ", ".join(f"<{name}>" for name, known in URDF.items() if child.tag in known.children)
        name = f" {shortened(child.attributes['name'], QUOTED)!r}" if "name" in child.attributes else ""
        cause = f"<{tag}>{name} has no place in <{element.tag}> and is ignored with all that it holds"
        mend = f"URDF has <{tag}> in {homes}; move it there, or take it out."
        yield _flaw(place, cause, child, code="misplaced-element", mend=mend)
    elif _means_origin(place, child.tag):
        written = "URDF has <origin xyz=… rpy=…>"
        cause = f"<{tag}> is unknown to URDF and ignored with all that it holds; {written}{_loss(place, 'origin')}"
        yield _flaw(place, cause, child, code="unknown-element", mend=_ORIGIN.format(element.tag))
    elif not word.is_open:
        known = ", ".join(f"<{name}>" for name in sorted(word.children)) or "no elements"
        cause = f"<{tag}> in <{element.tag}> is unknown to URDF and ignored{_losses(place)}"
        yield _flaw(place, cause, child, code="unknown-name", mend=f"Take it out; <{element.tag}> holds {known}.")


def _flaw(
    place: _Place, cause: str, child: Element | None = None, *, code: str, mend: str, edits: tuple[Edit, ...] = ()
) -> Flaw:
    element = place.element if child is None else child
    owner = place.owner
    if owner == "<robot>" and child is not None and child.attributes.get("name"):
        owner = f"<{shortened(child.tag, QUOTED)}> {shortened(child.attributes['name'], QUOTED)!r}"
    moves = place.owner.startswith(("joint", "<robot>")) if code != "unknown-name" else place.element.tag in _PLACING
    moves = moves or (child is not None and child.tag in _TREE)
    why = _WHY_KINEMATICS if moves else ""
    return Flaw(owner, cause, code=code, line=element.line, why=why, mend=mend, edits=edits)


def _choice(place: _Place, near: str) -> str:
    """What to do if several words seem to mean one name; empty if there is only one, or there may be several."""
    words = [] if near in _MANY else place.rivals.get(near, [])
    name = near if near in place.word.attributes else f"<{near}>"
    more = f" and {len(words) - _MOST_SHOWN} more" if len(words) > _MOST_SHOWN else ""
    shown = f"{' and '.join(words[:_MOST_SHOWN])}{more}"
    return f"{shown} seem to mean {name}; write the right one as {name}, and take out the rest." if words else ""


def _loss(place: _Place, near: str) -> str:
    """What is assumed without the attribute or child that was meant, as the rest of a sentence."""
    element = place.element
    is_given = near in element.attributes and near in place.word.attributes
    if is_given or near in place.given - _MANY:
        return ", and it is given too"
    assumed = ASSUMED.get((element.tag, near))
    return f"; {assumed}" if assumed else ""


def _losses(place: _Place) -> str:
    """What is assumed because something in an element that places links is ignored, as the rest of a sentence."""
    absent = [name for name in _PLACING.get(place.element.tag, ()) if name not in place.element.attributes]
    assumed = [ASSUMED[place.element.tag, name] for name in absent]
    return f"; {' and '.join(assumed)}" if assumed else ""


def _means_origin(place: _Place, name: str) -> bool:
    return "origin" in place.word.children and name.casefold() in PLACES


def _can_be(element: Element, child: str, text: str) -> bool:
    """Whether a text can be the main attribute of a child; the axis of a joint that has none may be anything."""
    if child != "axis" or element.attributes.get("type") in ("fixed", "floating"):
        return True
    try:
        return any(read_numbers(text, (3,), "axis").values)
    except NumberError:
        return False


def _homes(place: _Place, attribute: str) -> list[str]:
    """The children that have an attribute of this name, in angle brackets, the likeliest first.

    With rpy beside it, xyz is that of an origin.
    """
    homes = [child for child in sorted(place.word.children) if _holds(child, attribute)]
    if "origin" in homes:
        others = [] if "rpy" in place.element.attributes else [home for home in homes if home != "origin"]
        homes = ["origin", *others]
    return [f"<{home}>" for home in homes]


def _holds(child: str, attribute: str) -> bool:
    return child in URDF and child not in FOREIGN and attribute in URDF[child].attributes and attribute != "name"
