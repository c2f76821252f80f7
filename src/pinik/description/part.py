"""A part of a URDF that is being read: its children, texts, numbers and origin, and the flaws that are found in it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import TypeVar

from ..echoes import QUOTED, shortened
from .edits import new_value, removed
from .flaw import Edit, Flaw
from .numbers import FARTHEST, NumberError, Reading, read_numbers
from .slips import meant
from .vocabulary import SYNONYMS, URDF
from .xml import DocumentError, Element

__all__ = ["Part", "Vector", "required_name"]

Vector = tuple[float, float, float]
Value = TypeVar("Value")

_MOST_SHOWN = 4
_ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Part:
    """An element that is being read.

    Attributes:
        element: The element.
        owner: What it belongs to, in the words of messages, such as "joint 'elbow'".
        flaws: The list to which the flaws of the document are added.
        document: The bytes in which the element stands; empty if its flaws need no edits.
    """

    element: Element
    owner: str
    flaws: list[Flaw]
    document: bytes = b""

    @classmethod
    def named(cls, element: Element, flaws: list[Flaw], document: bytes) -> Part:
        """A link or joint, which is its own owner.

        Raises:
            DocumentError: Its name is missing or empty.
        """
        return cls(element, f"{element.tag} {required_name(element)!r}", flaws, document)

    @property
    def name(self) -> str:
        """The `name` of a link or joint that has one."""
        return self.element.attributes["name"]

    def flaw(
        self, cause: str, *, code: str, common: str | None = None, mend: str = "", edits: Sequence[Edit] = ()
    ) -> None:
        """Add a flaw of this element."""
        flaw = Flaw(self.owner, cause, code=code, line=self.element.line, common=common, mend=mend, edits=edits)
        self.flaws.append(flaw)

    def misread(self, attribute: str, cause: str, value: str, *, code: str, common: str | None = None) -> None:
        """Add a flaw of an attribute whose mend is another value, which means what was read."""
        edits = new_value(self.document, self.element, attribute, value)
        self.flaw(cause, code=code, common=common, mend=f'Write {attribute}="{value}".', edits=edits)

    def fault(self, cause: str) -> DocumentError:
        """An error about this element."""
        return DocumentError(cause, owner=self.owner, line=self.element.line)

    def bad_value(self, attribute: str, cause: str) -> DocumentError:
        """An error that quotes an attribute and says what is wrong with it."""
        return self.fault(f"{self._quoted(attribute)}: {cause}")

    def of(self, element: Element, owner: str | None = None) -> Part:
        """A part of this part."""
        return Part(element, self.owner if owner is None else owner, self.flaws, self.document)

    def unless_faulty(self, read: Callable[[Part], Value], loss: str, *, code: str, common: str) -> Value | None:
        """What `read` makes of this part. If it cannot be read, that is one flaw instead of all in it.

        Args:
            read: Reads the part; its `DocumentError` says what is wrong.
            loss: What is assumed then, as the end of a sentence.
            code: The code of the flaw.
            common: The cause of the flaw without names.
        """
        before = len(self.flaws)
        try:
            return read(self)
        except DocumentError as fault:
            del self.flaws[before:]  # what was assumed about a part that is left out does not matter
            line = fault.line or self.element.line
            self.flaws.append(Flaw(self.owner, f"{fault.message}; {loss}", code=code, line=line, common=common))
            return None

    def only(self, tag: str) -> Part | None:
        """The child with this tag, or None. Of several the first counts, as in urdfdom and yourdfpy."""
        found = self.element.named(tag)
        if len(found) > 1:
            self._note_others(found)
        return self.of(found[0]) if found else None

    def text(self, attribute: str) -> str:
        """The text of a required attribute.

        Raises:
            DocumentError: The attribute is missing or empty.
        """
        text = self.element.attributes.get(attribute)
        if text is None or not text.strip():
            what = f"no {attribute}{self._instead(attribute)}" if text is None else f"an empty {attribute}"
            raise self.fault(f"<{self.element.tag}> has {what}")
        return text

    def number(self, attribute: str, quantity: str = "number", *, infinite: bool = False) -> float | None:
        """One number, or None if the attribute is missing.

        Raises:
            DocumentError: It is not a number, not finite (unless it may be infinite), or larger than 1e12.
        """
        if attribute not in self.element.attributes:
            return None
        return self.numbers(attribute, (1,), quantity, infinite=infinite)[0]

    def vector(self, attribute: str, quantity: str, default: Vector) -> Vector:
        """Three numbers, or `default` if the attribute is missing.

        Raises:
            DocumentError: They are not three finite numbers of at most 1e12.
        """
        if attribute not in self.element.attributes:
            return default
        x, y, z = self.numbers(attribute, (3,), quantity)
        return x, y, z

    def numbers(
        self, attribute: str, counts: Collection[int], quantity: str = "number", *, infinite: bool = False
    ) -> tuple[float, ...]:
        """The numbers of an attribute. A notation that can be read in one way only is a flaw.

        Raises:
            DocumentError: They are not numbers, not finite (unless they may be infinite), larger than 1e12, or too many
                or too few; or they can be read in two ways.
        """
        try:
            reading = read_numbers(self.element.attributes[attribute], counts, quantity, infinite=infinite)
        except NumberError as fault:
            raise self.bad_value(attribute, str(fault)) from None
        if not infinite and quantity != "axis" and max(map(abs, reading.values)) > FARTHEST:
            unit = {"length": " m", "angle": " rad", "mass": " kg"}.get(quantity, "")
            raise self.bad_value(attribute, f"must be at most {FARTHEST:g}{unit}")
        if reading.oddity:
            self._note(attribute, reading)
        return reading.values

    def origin(self) -> tuple[Vector, Vector]:
        """The `<origin>`: xyz [m] and rpy [rad], zero where missing or empty.

        Raises:
            DocumentError: A number is malformed, not finite or larger than 1e12.
        """
        origin = self.only("origin")
        if origin is None:
            return _ZERO, _ZERO
        if "quat_xyzw" in origin.element.attributes:
            raise origin.bad_value("quat_xyzw", "quaternions (URDF 1.1) are not supported; use rpy instead")
        return origin._vector_of_origin("xyz", "length"), origin._vector_of_origin("rpy", "angle")

    def _vector_of_origin(self, attribute: str, quantity: str) -> Vector:
        if self.element.attributes.get(attribute, "0").strip():
            return self.vector(attribute, quantity, _ZERO)
        cause = f'<origin {attribute}=""> is empty, which is read as "0 0 0"'
        self.misread(attribute, cause, "0 0 0", code="empty-origin")
        return _ZERO

    def _instead(self, attribute: str) -> str:
        """What stands in the place of an attribute that is missing, in words that follow its name."""
        for name in self.element.attributes:
            near, value = SYNONYMS.get((self.element.tag, name.casefold()), ("", ""))
            if attribute == near:
                return f"; {name}= is unknown to URDF, write {near}={f' with {value}' if value else ''}"
        known = URDF[self.element.tag].attributes if self.element.tag in URDF else ()
        unknown = (name for name in self.element.attributes if name not in known)
        near_name = next((name for name in unknown if meant(name, known) == attribute), None)
        return "" if near_name is None else f"; {shortened(near_name, QUOTED)}= is unknown to URDF, write {attribute}="

    def _quoted(self, attribute: str) -> str:
        return f'<{self.element.tag} {attribute}="{shortened(self.element.attributes[attribute], QUOTED)}">'

    def _note_others(self, found: Sequence[Element]) -> None:
        """Add a flaw about several elements of which one is taken. If all are equal, its mend removes the others."""
        first, *others = found
        count, tag = len(found), first.tag
        mend, end = f"Remove all <{tag}> elements but one.", "the first is taken"
        common = f"has several <{tag}> elements; {end}"
        if all(other.says_the_same(first) for other in others):
            edits = [edit for other in others for edit in removed(self.document, other)]
            cause = f"has {count} equal <{tag}> elements; {end}"
            self.of(others[0]).flaw(cause, code="second-element", common=common, mend=mend, edits=edits)
            return
        shown = " and ".join(f"{_start_tag(one)} (line {one.line})" for one in found[:_MOST_SHOWN])
        more = f" and {count - _MOST_SHOWN} more" if count > _MOST_SHOWN else ""
        cause = f"has {count} <{tag}> elements that differ, {shown}{more}; {end}"
        self.of(others[0]).flaw(cause, code="second-element", common=common, mend=mend)

    def _note(self, attribute: str, reading: Reading) -> None:
        self.misread(
            attribute,
            f'{self._quoted(attribute)} has {reading.oddity}; it is read as "{reading}"',
            reading.exact,
            code="loose-number",
            common=f"numbers have {reading.oddity}; they are read {reading.manner}",
        )


def _start_tag(element: Element) -> str:
    attributes = "".join(f' {name}="{shortened(value, QUOTED)}"' for name, value in element.attributes.items())
    return f"<{element.tag}{attributes}>"


def required_name(element: Element) -> str:
    """The `name` of a link or joint.

    Raises:
        DocumentError: The name is missing or empty.
    """
    name = element.attributes.get("name")
    if name is None or not name.strip():
        what = "has no name" if name is None else "has an empty name"
        raise DocumentError(what, owner=f"<{element.tag}>", line=element.line)
    return name
