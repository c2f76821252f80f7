"""Documents in other encodings than UTF-8."""

from __future__ import annotations

import pytest

from pinik.description.document import read_document
from pinik.description.encodings import as_utf_8, as_utf_8_somehow
from pinik.description.xml import DocumentError, parse


@pytest.mark.parametrize(
    "encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be", "iso-8859-1", "windows-1252"]
)
def test_a_document_in_another_encoding_becomes_the_same_one_in_utf_8(encoding):
    declared = f'<?xml version="1.0" encoding="{encoding[:6] if "utf" in encoding else encoding}"?>\n<robot name="é"/>'
    given = declared.encode(encoding)
    content = as_utf_8(given)
    assert content.decode("utf-8").lstrip("\ufeff") == declared.replace(declared.split('"')[3], "utf-8")
    assert parse(content).attributes == {"name": "é"}


def test_a_document_in_utf_8_stays_as_it_is():
    for document in (
        b"<a/>",
        b'<?xml version="1.0" encoding="UTF-8"?><a/>',
        b"\xef\xbb\xbf<a/>",
        b"\n <?xml version='1.0'?><a/>",
    ):
        assert as_utf_8(document) is document


@pytest.mark.parametrize("document", [b'<?xml version="1.0" encoding="nonsense"?><a/>', b"\xff\xfe<"])
def test_bytes_that_are_not_in_their_encoding_are_an_error_in_words(document):
    with pytest.raises(DocumentError, match="its encoding cannot be read"):
        as_utf_8(document)


# What the declaration names, and the bytes of one letter → the letter that is read, and as what.
SOMEHOW = {
    ("iso-8859-1", b"\xe9"): ("é", ""),
    ("us-ascii", "日".encode()): ("日", "UTF-8"),
    ("klingon", "é".encode()): ("é", "UTF-8"),
    ("utf-8", b"\xe9"): ("é", "Latin-1"),
}


@pytest.mark.parametrize(("given", "expected"), SOMEHOW.items())
def test_bytes_that_are_not_in_their_encoding_are_read_as_utf_8_or_latin_1(given, expected):
    declared, letter = given
    document = b"<?xml version='1.0' encoding='%s'?><robot name='%s'/>" % (declared.encode(), letter)
    content, taken = as_utf_8_somehow(document)
    assert (parse(content).attributes["name"], taken) == expected
    assert content.startswith(b"<?xml version='1.0' encoding='utf-8'?>")


@pytest.mark.parametrize("declared", ["utf-16", "UTF-16", "utf-16le", "utf-32", "cp037"])
@pytest.mark.parametrize("end", ["", "\n", "\n\n", "\n\n\n"])
def test_single_bytes_that_declare_several_per_character_are_read_as_utf_8_whatever_their_number(declared, end):
    """.NET writes "utf-16" into the text of a document, which then may be saved in UTF-8."""
    text = f'<?xml version="1.0" encoding="{declared}"?><robot name="é"><link name="a"/></robot>{end}'
    document = read_document(text.encode("utf-8"))
    assert (document.root.attributes, [link.attributes["name"] for link in document.root.children]) == (
        {"name": "é"},
        ["a"],
    )
    assert [(flaw.code, "read as UTF-8" in flaw) for flaw in document.flaws] == [("encoding", True)]
    assert parse(as_utf_8(text.encode("utf-8"))).attributes == {"name": "é"}


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"])
def test_a_cut_off_document_of_several_bytes_per_character_is_called_what_it_is(encoding):
    whole = '<robot name="r"><link name="a"/></robot>'.encode(encoding)
    with pytest.raises(DocumentError, match=f"{encoding[:6].upper()}, and its last character is cut off"):
        read_document(whole[:-1])
    assert read_document(whole).root.attributes == {"name": "r"}
