"""Find elements and attributes that URDF does not know, or not at their place, with the names that were meant."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher

from ..errors import near_names
from .edits import moved_to_child, renamed_attribute, renamed_element
from .flaw import Edit, Flaw
from .vocabulary import ASSUMED, FOREIGN, MAIN_ATTRIBUTES, URDF, Word
from .xml import Element

__all__ = ["unknown_in_joints", "unknown_parts"]

_WHY_KINEMATICS = "The joint or link is not where the file seems to say."
_WHY = "What it says is lost, as readers of URDF ignore it without a word."
_RESEMBLES = 0.7  # of 1: how much two names have in common
_SURELY = 0.8  # so much that only a slip of the keyboard explains it
_LETTERS = 4  # so many letters are needed for one of them to be wrong
_LONGEST = 60
_MANY = frozenset({"link", "joint", "visual", "collision"})  # of these an element may hold several


@dataclass(frozen=True, slots=True)
class _Place:
    """An element under inspection.

    Attributes:
        element: The element.
        word: What may stand in it.
        owner: What messages call the link or joint that it belongs to.
        document: The bytes of the document; None if nobody wants edits.
        given: The names of those of its children that URDF knows.
    """

    element: Element
    word: Word
    owner: str
    document: bytes | None
    given: frozenset[str]


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
    """What is lost of `<robot>` itself and of its joints because its name is misspelt or misplaced; without edits."""
    # Nearly all elements are right, and loading must be quick.
    suspects = [] if _is_known(robot) else [(robot, "<robot>")]
    for joint in robot.named("joint"):
        inside = [child for child in joint.children if child.tag not in FOREIGN]
        if not (_is_known(joint) and all(map(_is_known, inside))):
            suspects.extend(_within(joint))
    flaws = [flaw for element, owner in suspects for flaw in _unknown(element, owner, None)]
    return [flaw for flaw in flaws if flaw.code != "unknown-name"]


def _is_known(element: Element) -> bool:
    word = URDF.get(element.tag)
    return word is None or (
        element.attributes.keys() <= word.attributes and {child.tag for child in element.children} <= word.children
    )


def _known(robot: Element) -> Iterator[tuple[Element, str]]:
    """The elements that URDF knows, each with its owner."""
    yield robot, "<robot>"
    for part in robot.children:
        if part.tag in URDF and part.tag not in FOREIGN:
            yield from _within(part)


def _within(part: Element) -> Iterator[tuple[Element, str]]:
    """A link, joint or material and what URDF knows in it, each with its owner."""
    owner = f"{part.tag} {_short(part.attributes.get('name', ''))!r}"
    pending = [part]
    while pending:
        element = pending.pop()
        yield element, owner
        known = URDF[element.tag].children - FOREIGN
        pending.extend(child for child in reversed(element.children) if child.tag in known)


def _unknown(element: Element, owner: str, document: bytes | None) -> Iterator[Flaw]:
    word = URDF[element.tag]
    place = _Place(element, word, owner, document, word.children.intersection(child.tag for child in element.children))
    for attribute in element.attributes:
        if attribute not in place.word.attributes and ":" not in attribute and attribute != "xmlns":
            yield from _unknown_attribute(place, attribute)
    for child in element.children:
        if child.tag not in place.word.children and ":" not in child.tag and "xmlns" not in child.attributes:
            yield from _unknown_child(place, child)


def _unknown_attribute(place: _Place, attribute: str) -> Iterator[Flaw]:
    element, word = place.element, place.word
    tag = element.tag
    held = f"<{tag} {_short(attribute)}=…>"
    meant = _meant(attribute, word.attributes, element.attributes)
    if meant is None and (child := attribute.casefold()) in word.children:
        yield _attribute_of_child(place, attribute, child)
    elif meant is None and (parents := [child for child in sorted(word.children) if _holds(child, attribute)]):
        cause = f"{held} is unknown to URDF and ignored; URDF has {attribute!r} in <{parents[0]}>"
        yield _flaw(place, cause, "misplaced-attribute", mend=f"Write it as <{parents[0]} {attribute}=…>.")
    elif meant is not None:
        cause = f"{held} is unknown to URDF and ignored (near: {meant!r}){_loss(place, meant)}"
        edits: tuple[Edit, ...] = ()
        if place.document is not None and _is_sure(attribute, word.attributes) and meant not in element.attributes:
            edits = renamed_attribute(place.document, element, attribute, meant)
        yield _flaw(
            place, cause, "unknown-attribute", mend=f"Write {meant}= instead of {_short(attribute)}=.", edits=edits
        )
    elif not word.is_open:
        known = ", ".join(sorted(word.attributes)) or "no attributes"
        cause = f"{held} is unknown to URDF and ignored"
        yield _flaw(place, cause, "unknown-name", mend=f"Take it out; <{tag}> has {known}.")


def _attribute_of_child(place: _Place, attribute: str, child: str) -> Flaw:
    """`<joint axis="0 0 1">`, where URDF has `<axis xyz="0 0 1"/>`."""
    element = place.element
    main = MAIN_ATTRIBUTES.get(child)
    written = f"<{child} {main}=…>" if main else f"<{child} …>"
    cause = f"{attribute} is an attribute here and ignored; URDF has {written}{_loss(place, child)}"
    edits: tuple[Edit, ...] = ()
    if place.document is not None and main and child not in place.given:
        edits = moved_to_child(place.document, element, attribute, child, main)
    text = element.attributes[attribute]
    example = f'<{child} {main}="{_short(text)}"/>' if main else written
    mend = f"Write {example} inside <{element.tag}>."
    return _flaw(place, cause, "misplaced-attribute", mend=mend, edits=edits)


def _unknown_child(place: _Place, child: Element) -> Iterator[Flaw]:
    element, word = place.element, place.word
    tag = _short(child.tag)
    meant = _meant(child.tag, word.children, place.given - _MANY)
    if meant is not None:
        cause = f"<{tag}> is unknown to URDF and ignored with all that it holds (near: <{meant}>){_loss(place, meant)}"
        edits: tuple[Edit, ...] = ()
        is_free = meant in _MANY or meant not in place.given
        if place.document is not None and _is_sure(child.tag, word.children) and is_free:
            edits = renamed_element(place.document, child, meant)
        yield _flaw(place, cause, "unknown-element", child, mend=f"Write <{meant}> instead of <{tag}>.", edits=edits)
    elif child.tag in URDF:
        homes = ", ".join(f"<{name}>" for name, known in URDF.items() if child.tag in known.children)
        cause = f"<{tag}> has no place in <{element.tag}> and is ignored with all that it holds"
        yield _flaw(
            place,
            cause,
            "misplaced-element",
            child,
            mend=f"URDF has <{tag}> in {homes}; move it there, or take it out.",
        )
    elif not word.is_open:
        known = ", ".join(f"<{name}>" for name in sorted(word.children)) or "no elements"
        cause = f"<{tag}> in <{element.tag}> is unknown to URDF and ignored"
        yield _flaw(place, cause, "unknown-name", child, mend=f"Take it out; <{element.tag}> holds {known}.")


def _flaw(
    place: _Place, cause: str, code: str, child: Element | None = None, *, mend: str, edits: tuple[Edit, ...] = ()
) -> Flaw:
    element = place.element if child is None else child
    owner = place.owner
    if owner == "<robot>" and child is not None and child.attributes.get("name"):
        owner = f"<{_short(child.tag)}> {_short(child.attributes['name'])!r}"
    moves = place.owner.startswith(("joint", "<robot>")) and code != "unknown-name"
    why = _WHY_KINEMATICS if moves else _WHY
    return Flaw(owner, cause, code=code, line=element.line, why=why, mend=mend, edits=edits)


def _loss(place: _Place, meant: str) -> str:
    """What is assumed without the attribute or child that was meant, as the rest of a sentence."""
    element = place.element
    is_given = meant in element.attributes and meant in place.word.attributes
    if is_given or meant in place.given - _MANY:
        return ", and it is given too"
    assumed = ASSUMED.get((element.tag, meant))
    return f"; {assumed}" if assumed else ""


def _holds(child: str, attribute: str) -> bool:
    return child in URDF and child not in FOREIGN and attribute in URDF[child].attributes and attribute != "name"


def _meant(name: str, known: Collection[str], given: Collection[str]) -> str | None:
    """The known name that this one resembles most, or None; one that is given beside it only if it is very near."""
    for near in near_names(_short(name), known):
        if _likeness(name, near) >= (_SURELY if near in given else _RESEMBLES):
            return near
    return None


def _is_sure(name: str, known: Collection[str]) -> bool:
    """Whether one known name is so near that it must be the one, and no other is."""
    return sum(_likeness(name, one) >= _SURELY for one in known) == 1


def _likeness(name: str, known: str) -> float:
    """From 0 to 1: how much two names have in common; case, the order of letters and one wrong letter hardly count."""
    word = name[:_LONGEST].casefold()
    if sorted(word) == sorted(known):
        return 1.0
    if len(word) == len(known) >= _LETTERS and sum(one != other for one, other in zip(word, known, strict=True)) == 1:
        return _SURELY
    return SequenceMatcher(None, word, known).ratio()


def _short(name: str) -> str:
    return name if len(name) <= _LONGEST else name[: _LONGEST - 1] + "…"
