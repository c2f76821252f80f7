"""XML read with nothing but expat: no DTD, no entity, no outside reference, no bottomless nesting."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

__all__ = ["DocumentError", "Element", "parse"]

# The largest robot known here has 0.2 MB, 5,000 elements and 9 levels: these bounds stop bombs, not robots.
MAX_BYTES = 16 * 1024 * 1024
MAX_ELEMENTS = 500_000
MAX_DEPTH = 100
XINCLUDE = "http://www.w3.org/2001/XInclude"


class DocumentError(Exception):
    """What is wrong with a document, before it is known which file it came from.

    Attributes:
        message: The cause, in words.
        owner: The faulty element, such as "joint 'elbow'", or None where the whole document is at fault.
        line: Its line, from 1.
    """

    def __init__(self, message: str, *, owner: str | None = None, line: int | None = None) -> None:
        self.message = message
        self.owner = owner
        self.line = line
        super().__init__(message)


@dataclass(slots=True)
class Element:
    """One XML element without its text, which URDF does not use.

    Attributes:
        tag: The name as written, a namespace prefix included.
        attributes: The attributes, decoded.
        line: The line where it begins, from 1.
        children: The elements inside, in order.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)

    def named(self, tag: str) -> list[Element]:
        """The direct children with this tag, in order."""
        return [child for child in self.children if child.tag == tag]

    def walk(self) -> Iterator[Element]:
        """This element and all inside it, parents first; the order of siblings is not kept."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending.extend(element.children)


class _Builder:
    """Collects expat's events into a tree of `Element`."""

    def __init__(self, parser: expat.XMLParserType, lines_before: int) -> None:
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0
        self._parser = parser
        self._lines_before = lines_before
        self._xinclude_prefixes = {"xi"}
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.StartDoctypeDeclHandler = self._refuse_doctype

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._line()
        self._count += 1
        if self._count > MAX_ELEMENTS:
            raise DocumentError(f"more than {MAX_ELEMENTS:,} XML elements", line=line)
        if len(self._open) == MAX_DEPTH:
            raise DocumentError(f"XML elements nested more than {MAX_DEPTH} deep", line=line)
        self._refuse_xinclude(tag, attributes, line)
        element = Element(tag, attributes, line)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def _end(self, _tag: str) -> None:
        self._open.pop()

    def _refuse_doctype(self, name: str, *_: object) -> None:
        raise DocumentError(
            f"<!DOCTYPE {name}>: document types, entities and external references are refused",
            line=self._line(),
        )

    def _refuse_xinclude(self, tag: str, attributes: dict[str, str], line: int) -> None:
        for name, value in attributes.items():
            declared, _, prefix = name.partition(":")
            if declared == "xmlns" and value == XINCLUDE:
                self._xinclude_prefixes.add(prefix)
        prefix, colon, _ = tag.partition(":")
        if (prefix if colon else "") in self._xinclude_prefixes:
            raise DocumentError("external references (XInclude) are refused", owner=f"<{tag}>", line=line)

    def _line(self) -> int:
        return self._parser.CurrentLineNumber + self._lines_before


def parse(document: bytes, encoding: str | None = None) -> Element:
    """Read an XML document.

    Args:
        document: The bytes of the file.
        encoding: What they are encoded in; None where the document's own declaration decides.

    Returns:
        The root element.

    Raises:
        DocumentError: The document is not well-formed XML, declares a document type, or exceeds this module's
            bounds.
    """
    if len(document) > MAX_BYTES:
        raise DocumentError(f"larger than {MAX_BYTES // 1024**2} MB, too large for a robot description")
    if not document.strip():
        raise DocumentError("empty: there is no XML in it")
    # Blank lines before the declaration are common in pasted text, and every URDF reader accepts them.
    blank = document[: len(document) - len(document.lstrip())]
    parser = expat.ParserCreate(encoding)
    builder = _Builder(parser, blank.count(b"\n"))
    try:
        parser.Parse(document[len(blank) :], True)
    except expat.ExpatError as error:
        line = error.lineno + blank.count(b"\n")
        cause = _encoding_fault(document, parser.ErrorCode) or expat.ErrorString(error.code)
        raise DocumentError(f"not XML: {cause} (line {line}, column {error.offset + 1})") from None
    except (UnicodeError, LookupError, ValueError) as error:
        raise DocumentError(f"not XML: its encoding cannot be read ({error})") from None
    if builder.root is None:
        raise DocumentError("not XML: there is no element in it")
    return builder.root


def _encoding_fault(document: bytes, code: int) -> str | None:
    """A plainer name for expat's "invalid token" where the bytes are no text at all."""
    if code != expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]:
        return None
    if b"\0" in document:
        return "it contains null bytes"
    try:
        document.decode("utf-8")
    except UnicodeDecodeError as error:
        return f"byte 0x{document[error.start]:02x} is not UTF-8, and no other encoding is declared"
    return None
