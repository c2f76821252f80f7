"""The XML document of a robot description: its bytes, cleared of what does not belong to it, and its elements."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..echoes import QUOTED, shortened
from .encodings import WIDE, as_utf_8, as_utf_8_somehow, declared_encoding
from .flaw import Flaw
from .xml import COMMENT, BrokenXMLError, DocumentError, Element, parse

__all__ = ["Document", "read_document"]

_BEGINNINGS = (b"<?xml", b"<robot", b"<!--")


@dataclass(frozen=True)
class Document:
    """A document that was read.

    Attributes:
        root: The root element.
        content: The bytes that were parsed: those of the file, with spaces in place of what does not belong to it; in
            UTF-8 if the file is in UTF-16 or UTF-32, or in another encoding than its declaration names.
        flaws: What had to be assumed; `content` does not have these flaws any more.
    """

    root: Element
    content: bytes
    flaws: tuple[Flaw, ...]


def read_document(given: bytes) -> Document:
    """Parse a document that may have null bytes or other text around it, or bytes in an encoding that it does not name.

    Raises:
        DocumentError: It is not XML, or not safe to read (`xml.parse`).
    """
    flaws: list[Flaw] = []
    content = _without_surroundings(given, flaws)
    tried: set[bytes] = set()
    while True:
        tried.add(content)
        try:
            return Document(parse(content), content, tuple(flaws))
        except BrokenXMLError as fault:
            mended = _mended(content, fault, flaws)
            if mended is None or mended in tried:
                raise
            content = mended


def _without_surroundings(content: bytes, flaws: list[Flaw]) -> bytes:
    """The document, with spaces for null bytes at its end and for text before it; in UTF-8 if it was in a wider one."""
    if content.startswith(WIDE):
        content = as_utf_8(content)
    whole = content.rstrip(b"\0 \t\r\n")
    if b"\0" in content[len(whole) :]:
        _note(flaws, "null bytes at its end are ignored", code="junk-around", line=whole.count(b"\n") + 1)
        content = whole + content[len(whole) :].replace(b"\0", b" ")
    blank = len(content) - len(content.lstrip(b"\xef\xbb\xbf \t\r\n"))
    if not content.startswith(b"<", blank):
        begins = min((place for word in _BEGINNINGS if (place := content.find(word)) > 0), default=0)
        if begins and b"\0" not in content[:begins]:
            _note(flaws, "text before its first element is ignored", code="junk-around", line=1)
            content = _blank(content, 0, begins)
    return content


def _mended(content: bytes, fault: BrokenXMLError, flaws: list[Flaw]) -> bytes | None:
    """The document without what the parser found fault with; None if only one fault can be read in one way."""
    if fault.kind == "junk":
        begins = fault.start
        if begins is None or b"<robot" in content[begins:]:
            raise DocumentError(f"it holds two documents; the second begins on line {fault.line}") from None
        _note(flaws, "text after its last element is ignored", code="junk-around", line=fault.line)
        return _blank(content, begins, len(content))
    if fault.kind == "encoding":
        return _in_utf_8(content, fault.line, flaws)
    if fault.kind == "token" and any(map(_is_bad, COMMENT.findall(content))):
        _note(
            flaws,
            'a comment contains "--", which XML forbids; comments are ignored',
            code="bad-comment",
            line=fault.line,
        )
        return COMMENT.sub(lambda comment: _blank(comment[0], 0, len(comment[0])), content)
    return None


def _is_bad(comment: bytes) -> bool:
    """Whether a comment has an end, and "--" before it."""
    return comment.endswith(b"-->") and b"--" in comment[4:-3]


def _in_utf_8(content: bytes, line: int | None, flaws: list[Flaw]) -> bytes | None:
    """The document in UTF-8, in whatever encoding it is; None if it holds null bytes."""
    if b"\0" in content:
        return None
    mended, taken = as_utf_8_somehow(content)
    if taken:
        name = shortened(declared_encoding(content), QUOTED)
        cause = f"its bytes are not {name!r}, as it declares; they are read as {taken}"
        _note(flaws, cause, code="encoding", line=line or 1)
    return mended


def _blank(content: bytes, start: int, end: int) -> bytes:
    """The bytes with spaces from `start` to `end`, except for line feeds, so that lines and offsets stay."""
    return content[:start] + re.sub(rb"[^\n]", b" ", content[start:end]) + content[end:]


def _note(flaws: list[Flaw], cause: str, *, code: str, line: int | None = None) -> None:
    flaws.append(Flaw("the document", cause, code=code, line=line))
