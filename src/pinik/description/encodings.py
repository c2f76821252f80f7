"""The encoding of a document's bytes, and the same document in UTF-8."""

from __future__ import annotations

import re

from .xml import DocumentError

__all__ = ["UTF_16", "as_utf_8", "as_utf_8_somehow", "declared_as_utf_8", "declared_encoding"]

UTF_16 = (b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<")
"""How documents in UTF-16 begin, with a byte-order mark or without."""

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
    encoding = _encoding(document)
    if encoding.lower().replace("_", "-") in _SAME:
        return document
    try:
        content = document.decode(encoding).encode("utf-8")
    except (LookupError, UnicodeError) as error:
        raise DocumentError(f"its encoding cannot be read ({error})") from None
    return declared_as_utf_8(content)


def as_utf_8_somehow(document: bytes) -> tuple[bytes, str]:
    """The document in UTF-8, decoded as it declares, else as UTF-8, else as Latin-1.

    Returns:
        The document, and "UTF-8" or "Latin-1" if it is not in the encoding that it declares; empty if it is.
    """
    try:
        text, taken = document.decode(declared_encoding(document)), ""
    except (UnicodeError, LookupError):
        try:
            text, taken = document.decode("utf-8"), "UTF-8"
        except UnicodeDecodeError:
            text, taken = document.decode("latin-1"), "Latin-1"
    return declared_as_utf_8(text.encode("utf-8")), taken


def _encoding(document: bytes) -> str:
    """The encoding of a document, by its first bytes or its declaration."""
    if not document.startswith(UTF_16):
        return declared_encoding(document)
    if document[:1] not in (b"<", b"\0"):
        return "utf-16"
    return "utf-16-be" if document[:1] == b"\0" else "utf-16-le"
