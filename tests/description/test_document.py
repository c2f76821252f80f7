"""What stands around a document, or is wrong with its bytes, is ignored with a warning where one reading is left."""

from __future__ import annotations

import re

import pytest

from pinik.description import reader as urdf
from pinik.errors import RobotLoadError
from urdf_texts import link, pair, robot

PLAIN = pair().encode()
DECLARED = b'<?xml version="1.0" encoding="%b"?>'


def name_of(letter: str, encoding: str) -> bytes:
    return robot(link(letter)).encode(encoding)


# What the bytes are, the bytes, the name of the first link, and the warnings.
READ = {
    "null bytes at the end": (
        PLAIN + b"\n\0\0\n",
        "a",
        ["the document: null bytes at its end are ignored (line 1)"],
    ),
    "text after the robot": (
        PLAIN + b"\n\nuser@host:~$ ",
        "a",
        ["the document: text after its last element is ignored (line 3)"],
    ),
    "a tag closed twice": (PLAIN + b"</robot>", "a", ["the document: text after its last element is ignored (line 1)"]),
    "text before the robot": (
        b"[INFO] expanding\n" + PLAIN,
        "a",
        ["the document: text before its first element is ignored (line 1)"],
    ),
    "text before a declaration": (
        b"expanding <x>\n" + DECLARED % b"utf-8" + PLAIN,
        "a",
        ["the document: text before its first element is ignored (line 1)"],
    ),
    "Latin-1 without a declaration": (
        name_of("é", "latin-1"),
        "é",
        ["the document: its bytes are not 'utf-8', as it declares; they are read as Latin-1 (line 1)"],
    ),
    "Latin-1 declared as UTF-8": (
        DECLARED % b"utf-8" + name_of("é", "latin-1"),
        "é",
        ["the document: its bytes are not 'utf-8', as it declares; they are read as Latin-1 (line 1)"],
    ),
    "UTF-8 declared as ASCII": (
        DECLARED % b"us-ascii" + name_of("日本", "utf-8"),
        "日本",
        ["the document: its bytes are not 'us-ascii', as it declares; they are read as UTF-8 (line 1)"],
    ),
    "an unknown encoding": (
        DECLARED % b"klingon" + name_of("é", "utf-8"),
        "é",
        ["the document: its bytes are not 'klingon', as it declares; they are read as UTF-8 (line 1)"],
    ),
    "a comment with two hyphens": (
        PLAIN.replace(b"<link", b"<!-- old -- \n -- -->\n<link", 1),
        "a",
        ['the document: a comment contains "--", which XML forbids; comments are ignored (line 1)'],
    ),
    "GB2312 as declared": (DECLARED % b"gb2312" + name_of("中文", "gb2312"), "中文", []),
    "UTF-16 as declared": (
        ('<?xml version="1.0" encoding="utf-16"?>' + robot(link("日本"))).encode("utf-16"),
        "日本",
        [],
    ),
    "UTF-16 with its mark alone": (name_of("日本", "utf-16"), "日本", []),
    "a byte-order mark": (b"\xef\xbb\xbf" + PLAIN, "a", []),
}


@pytest.mark.parametrize(("content", "name", "warnings"), READ.values(), ids=READ)
def test_what_is_left_to_read_is_read_and_the_rest_is_named(content, name, warnings):
    description = urdf.read(content)
    assert description.links[0] == name
    assert list(description.warnings) == warnings


# What the bytes are, the bytes, and words of the error.
REFUSED = {
    "two robots": (PLAIN + b"\n" + PLAIN, "it holds two documents; the second begins on line 2"),
    "null bytes inside": (PLAIN.replace(b'"a"', b'"a\0"'), "it contains null bytes"),
    "null bytes alone": (b"\0\0\0", "empty: it contains no XML"),
    "an attribute twice": (PLAIN.replace(b"<joint", b'<joint name="k"'), "duplicate attribute"),
    "a robot cut short": (PLAIN[:-20], "not XML"),
    "text with a link in it": (b"see <link> and </link>", "not XML"),
}


@pytest.mark.parametrize(("content", "words"), REFUSED.values(), ids=REFUSED)
def test_what_has_two_readings_or_none_is_refused(content, words):
    with pytest.raises(RobotLoadError, match=re.escape(words)):
        urdf.read(content)


def test_lines_and_offsets_are_those_of_the_file_after_a_repair():
    content = b"log\nlog\n" + pair('<origin xyz="1,2,3"/>').encode() + b"\n$ \0"
    description = urdf.read(content)
    (flaw,) = (flaw for flaw in description.warnings if flaw.code == "loose-number")
    assert flaw.line == 3
    assert len(description.document) == len(content)
    assert description.document.split() == content.split()[2:-2]


def test_what_is_kept_of_a_document_in_another_encoding_parses_by_itself():
    content = urdf.read(DECLARED % b"utf-8" + name_of("é", "latin-1")).document
    assert content == DECLARED % b"utf-8" + name_of("é", "utf-8")
