"""Read XML with expat alone: without document types, entities, external references or unbounded nesting."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from xml.parsers import expat

__all__ = ["COMMENT", "BrokenXMLError", "DocumentError", "Element", "parse"]

# The largest robots of the catalogue have 0.2 MB, 5,000 elements, 9 levels and 170 names; these bounds stop XML bombs
# only.
MAX_BYTES = 16 * 1024 * 1024
MAX_ELEMENTS = 500_000
MAX_NAMES = 10_000  # of elements and attributes; each one that URDF does not know is compared with those that it knows
MAX_DEPTH = 100
XINCLUDE = "http://www.w3.org/2001/XInclude"

COMMENT = re.compile(rb"<!--.*?(?:-->|\Z)", re.DOTALL)
"""A comment; one without an end reaches to the end of the document, so that it is searched only once."""


class DocumentError(Exception):
    """A fault in a document, raised where the name of the file is not known.

    Attributes:
        message: The cause.
        owner: The faulty element, such as "joint 'elbow'", or None if the whole document is at fault.
        line: Its line, from 1.
        others: The other faults that were found.
    """

    def __init__(
        self,
        message: str,
        *,
        owner: str | None = None,
        line: int | None = None,
        others: Sequence[DocumentError] = (),
    ) -> None:
        self.message = message
        self.owner = owner
        self.line = line
        self.others = tuple(others)
        super().__init__(message)


class BrokenXMLError(DocumentError):
    """A document that is not well-formed.

    Attributes:
        kind: "junk" for something after the root element, "encoding" for bytes that are not in the encoding of the
            document, "token" for characters that XML does not allow, "" for anything else.
        start: The offset of what comes after the root element; None for other kinds.
    """

    def __init__(self, message: str, *, kind: str = "", line: int | None = None, start: int | None = None) -> None:
        self.kind = kind
        self.start = start
        super().__init__(message, line=line)


@dataclass(slots=True)
class Element:
    """An XML element.

    Attributes:
        tag: The name as written, with its namespace prefix.
        attributes: The decoded attributes.
        line: The line on which the element begins, from 1.
        start: The offset of its "<" in the bytes of the document.
        children: The child elements, in order.
        text: The first piece of text in it, without white space around; empty if there is none, as in good URDFs.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    start: int = 0
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def named(self, tag: str) -> list[Element]:
        """The direct children with this tag, in order."""
        return [child for child in self.children if child.tag == tag]

    def says_the_same(self, other: Element) -> bool:
        """Whether another element has the same tag and attributes, and children that say the same in the same order."""
        if (self.tag, self.attributes, self.text) != (other.tag, other.attributes, other.text):
            return False
        pairs = zip(self.children, other.children, strict=False)
        return len(self.children) == len(other.children) and all(one.says_the_same(two) for one, two in pairs)

    def walk(self) -> Iterator[Element]:
        """This element and all its descendants, parents first; siblings come in any order."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending.extend(element.children)


class _Builder:
    """Builds a tree of `Element` from expat's events."""

    def __init__(self, parser: expat.XMLParserType, blank: bytes) -> None:
        self.root: Element | None = None
        self.end: int | None = None  # the offset of the tag that ends the root element
        self._open: list[Element] = []
        self._count = 0
        self._names: set[str] = set()
        self._parser = parser
        self._lines_before = blank.count(b"\n")
        self._bytes_before = len(blank)
        self._xinclude_prefixes = {"xi"}
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._add_text
        parser.StartDoctypeDeclHandler = self._refuse_doctype

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._line()
        self._count += 1
        if self._count > MAX_ELEMENTS:
            raise DocumentError(f"more than {MAX_ELEMENTS:,} XML elements", line=line)
        if len(self._open) == MAX_DEPTH:
            raise DocumentError(f"XML elements nested more than {MAX_DEPTH} deep", line=line)
        self._names.add(tag)
        self._names.update(attributes)
        if len(self._names) > MAX_NAMES:
            raise DocumentError(f"more than {MAX_NAMES:,} different names of XML elements and attributes", line=line)
        self._refuse_xinclude(tag, attributes, line)
        element = Element(tag, attributes, line, self._parser.CurrentByteIndex + self._bytes_before)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def _end(self, _tag: str) -> None:
        self._open.pop()
        if not self._open:
            self.end = self._parser.CurrentByteIndex + self._bytes_before

    def _add_text(self, text: str) -> None:
        if not text.isspace() and not self._open[-1].text:
            self._open[-1].text = text.strip()

    def _refuse_doctype(self, name: str, *_: object) -> None:
        raise DocumentError(
            f"<!DOCTYPE {name}>: document types, entities and external references are refused",
            line=self._line(),
        )

    def _refuse_xinclude(self, tag: str, attributes: dict[str, str], line: int) -> None:
        if XINCLUDE in attributes.values():
            names = (name for name, value in attributes.items() if value == XINCLUDE)
            self._xinclude_prefixes.update(name[6:] for name in names if name == "xmlns" or name.startswith("xmlns:"))
        if (tag.partition(":")[0] if ":" in tag else "") in self._xinclude_prefixes:
            raise DocumentError("external references (XInclude) are refused", owner=f"<{tag}>", line=line)

    def _line(self) -> int:
        return self._parser.CurrentLineNumber + self._lines_before


def parse(document: bytes, most_bytes: int = MAX_BYTES) -> Element:
    """Parse an XML document, in the encoding that it declares.

    Args:
        document: The bytes of the file.
        most_bytes: The largest size.

    Returns:
        The root element.

    Raises:
        BrokenXMLError: The document is not well-formed XML.
        DocumentError: It declares a document type, or exceeds the bounds of this module.
    """
    if len(document) > most_bytes:
        raise DocumentError(f"larger than {most_bytes // 1024**2} MB, too large for a robot description")
    if not document.strip():
        raise DocumentError("empty: it contains no XML")
    # Blank lines before the declaration are common in pasted text, and other URDF readers accept them.
    blank = document[: len(document) - len(document.lstrip())]
    parser = expat.ParserCreate()
    parser.buffer_text = True
    builder = _Builder(parser, blank)
    try:
        parser.Parse(document[len(blank) :], True)
    except expat.ExpatError as error:
        broken = _broken(document, error, parser.ErrorByteIndex + len(blank), blank.count(b"\n"))
        if builder.end is not None:
            broken.kind, broken.start = "junk", document.find(b">", builder.end) + 1
        raise broken from None
    except (UnicodeError, LookupError, ValueError) as error:
        raise BrokenXMLError(f"not XML: its encoding cannot be read ({error})", kind="encoding") from None
    if builder.root is None:
        raise DocumentError("not XML: it contains no element")
    return builder.root


def _broken(document: bytes, error: expat.ExpatError, start: int, lines_before: int) -> BrokenXMLError:
    """What expat found, with a plainer description of its "invalid token" where the bytes are not text."""
    codes = expat.errors.codes
    kinds = {
        codes[expat.errors.XML_ERROR_UNKNOWN_ENCODING]: "encoding",
        codes[expat.errors.XML_ERROR_INCORRECT_ENCODING]: "encoding",
        codes[expat.errors.XML_ERROR_INVALID_TOKEN]: "token",
    }
    kind, cause = kinds.get(error.code, ""), expat.ErrorString(error.code)
    if kind == "token" and b"\0" in document:
        kind, cause = "", "it contains null bytes"
    elif kind == "token" and document[start : start + 1] >= b"\x80":
        kind = "encoding"
        try:
            document.decode("utf-8")
        except UnicodeDecodeError as undecoded:
            cause = f"byte 0x{document[undecoded.start]:02x} is not UTF-8, and no other encoding is declared"
    line = error.lineno + lines_before
    message = f"not XML: {cause} (line {line}, column {error.offset + 1})"
    return BrokenXMLError(message, kind=kind, line=line)
