"""The encoding of a document's bytes, and the same document in UTF-8."""

from __future__ import annotations

import contextlib
import re

from .xml import DocumentError

__all__ = ["WIDE", "as_utf_8", "as_utf_8_somehow", "declared_as_utf_8", "declared_encoding"]

# How documents begin in each encoding of several bytes per character, with a byte-order mark or without. That of UTF-32
# begins with that of UTF-16, and comes first.
_WIDE_BEGINNINGS = {
    b"\xff\xfe\0\0": "utf-32",
    b"\0\0\xfe\xff": "utf-32",
    b"<\0\0\0": "utf-32-le",
    b"\0\0\0<": "utf-32-be",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
    b"<\0": "utf-16-le",
    b"\0<": "utf-16-be",
}
WIDE = tuple(_WIDE_BEGINNINGS)
"""How documents in UTF-16 and UTF-32 begin, with a byte-order mark or without."""

_SAME = ("utf-8", "utf8", "us-ascii", "ascii")
_DECLARED = re.compile(rb"""\A((?:\xef\xbb\xbf)?\s*<\?xml\s[^>]*?\bencoding\s*=\s*["'])([^"'>]*)""")


def declared_encoding(document: bytes) -> str:
    """The encoding that a document declares in single bytes; "utf-8" if it declares none."""
    declared = _DECLARED.match(document)
    return declared[2].decode("latin-1") if declared else "utf-8"


def declared_as_utf_8(document: bytes) -> bytes:
    """The document with "utf-8" in its declaration, if that names an encoding."""
    return _DECLARED.sub(rb"\g<1>utf-8", document)


def as_utf_8(document: bytes) -> bytes:
    """The document in UTF-8, with a declaration that says so; unchanged if it is in UTF-8 already.

    Raises:
        DocumentError: The encoding that it declares is unknown, or its bytes are not in it.
    """
    wide = _wide_encoding(document)
    encoding = wide or declared_encoding(document)
    if encoding.lower().replace("_", "-") in _SAME:
        return document
    try:
        content = document.decode(encoding if wide or _has_ascii(encoding) else "utf-8").encode("utf-8")
    except (LookupError, UnicodeError) as error:
        raise DocumentError(_why_unreadable(wide, error)) from None
    return declared_as_utf_8(content)


def as_utf_8_somehow(document: bytes) -> tuple[bytes, str]:
    """The document in UTF-8, decoded as it declares, else as UTF-8, else as Latin-1.

    A document whose declaration can be read in single bytes is in none of the encodings that have no such bytes, even
    if it can be decoded as one: files in UTF-8 that declare UTF-16 are common, and decode as Chinese.

    Returns:
        The document, and "UTF-8" or "Latin-1" if it is not in the encoding that it declares; empty if it is.
    """
    declared = declared_encoding(document)
    with contextlib.suppress(UnicodeError, LookupError):
        if _has_ascii(declared):
            return declared_as_utf_8(document.decode(declared).encode("utf-8")), ""
    try:
        text, taken = document.decode("utf-8"), "UTF-8"
    except UnicodeDecodeError:
        text, taken = document.decode("latin-1"), "Latin-1"
    return declared_as_utf_8(text.encode("utf-8")), taken


def _wide_encoding(document: bytes) -> str:
    """UTF-16 or UTF-32, in the words of codecs, if the first bytes of a document are in it; else empty."""
    return next((name for begins, name in _WIDE_BEGINNINGS.items() if document.startswith(begins)), "")


def _has_ascii(encoding: str) -> bool:
    """Whether the letters of ASCII are single bytes, and the same ones, in an encoding.

    Raises:
        LookupError: It is unknown.
    """
    try:
        return b"<?".decode(encoding) == "<?"
    except UnicodeError:
        return False


def _why_unreadable(wide: str, error: Exception) -> str:
    """Why a document cannot be decoded, whose first bytes are in `wide` if they are in UTF-16 or UTF-32."""
    if not wide or not isinstance(error, UnicodeDecodeError):
        return f"its encoding cannot be read ({error})"
    name = wide[:6].upper()
    if error.end == len(error.object):
        return f"its encoding cannot be read: it is in {name}, and its last character is cut off"
    return f"its encoding cannot be read: it begins in {name}, but byte {error.start} is not in it ({error.reason})"
