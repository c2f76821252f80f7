"""Ways to spoil or disguise the text of a document as bytes."""

from __future__ import annotations

import codecs
from collections.abc import Callable
from random import Random

__all__ = ["ENCODERS"]

DECLARATIONS = (
    "utf-8",
    "UTF-16",
    "latin-1",
    "ISO-8859-15",
    "cp1252",
    "ascii",
    "utf-7",
    "cp037",
    "gb18030",
    "utf-32",
    "rot13",
)
BOMS = (codecs.BOM_UTF8, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, codecs.BOM_UTF32_LE)
BOMB = "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 10}">' for i in range(9))
DOCTYPES = (
    f'<!DOCTYPE robot [<!ENTITY e0 "0">{BOMB}]>',
    f'<!DOCTYPE robot [<!ENTITY e "{"x" * 100_000}">]>',
    '<!DOCTYPE robot SYSTEM "file:///dev/zero">',
    '<!DOCTYPE robot [<!ENTITY e SYSTEM "file:///proc/self/environ">]>',
    '<!DOCTYPE robot [<!ENTITY % e SYSTEM "http://127.0.0.1:9/"> %e;]>',
    "<!DOCTYPE robot>",
)


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _truncated(random: Random, text: str) -> bytes:
    document = _bytes(text)
    return document[: random.randrange(len(document) + 1)]


def _spoiled(random: Random, text: str) -> bytes:
    document = bytearray(_bytes(text))
    for _ in range(random.choice((1, 1, 2, 20))):
        document[random.randrange(len(document))] = random.choice(
            (0, 9, 0x20, 0x22, 0x3C, 0x3E, 0x26, 0x80, 0xC3, 0xFE, 0xFF)
        )
    return bytes(document)


def _spliced(random: Random, text: str) -> bytes:
    document = _bytes(text)
    a, b = sorted((random.randrange(len(document)), random.randrange(len(document))))
    where = random.randrange(len(document))
    return document[:where] + document[a : min(b, a + 200)] + document[where + random.randrange(3) :]


def _nulls(random: Random, text: str) -> bytes:
    return _bytes(text) + b"\0" * random.choice((1, 3, 4096)) + random.choice((b"", b"\n", b"x", b"<robot/>"))


def _before(random: Random, text: str) -> bytes:
    junk = (
        b"\n\n ",
        b"\xef\xbb\xbf\xef\xbb\xbf",
        b"\0",
        b"x",
        b"<!-- -->",
        b"\xc2\xa0",
        b"#!/usr/bin/env pinik\n",
        b"\x1f\x8b\x08",
    )
    return random.choice(junk) + _bytes(text)


def _after(random: Random, text: str) -> bytes:
    junk = (b"\n\n ", b"\x1a", b"x", b"<!-- -->", b"<robot/>", b"\xff", b"]]>", b" " * 100_000, b"\xef\xbb\xbf")
    return _bytes(text) + random.choice(junk)


def _encoded(random: Random, text: str) -> bytes:
    name = random.choice(DECLARATIONS)
    written = random.choice(DECLARATIONS[:9])
    head = f'<?xml version="1.{random.choice((0, 1))}" encoding="{name}"?>\n' if random.randrange(4) else ""
    bom = random.choice(BOMS) if random.randrange(3) == 0 else b""
    return bom + (head + text).encode(written, "replace")


def _with_doctype(random: Random, text: str) -> bytes:
    return _bytes(random.choice(DOCTYPES) + text.replace('="', random.choice(('="', '="&e9;', '="&e;')), 1))


def _with_namespace(random: Random, text: str) -> bytes:
    names = ("http://www.ros.org/wiki/xacro", "http://www.w3.org/2001/XInclude", "", "http://example.org")
    prefix = random.choice(("xmlns", "xmlns:xacro", "xmlns:link", "xml:base"))
    return _bytes(text.replace("<robot", f'<robot {prefix}="{random.choice(names)}"', 1))


def _shifted(random: Random, text: str) -> bytes:
    return _bytes(
        text.replace("\n", random.choice(("\r", "\r\n", " ", "\u2028", "\x0b", "\n" * 50)), random.choice((1, -1)))
    )


ENCODERS: tuple[Callable[[Random, str], bytes], ...] = (
    *(
        _truncated,
        _spoiled,
        _spoiled,
        _spliced,
        _nulls,
        _before,
        _after,
        _encoded,
        _with_doctype,
        _with_namespace,
        _shifted,
    ),
)
