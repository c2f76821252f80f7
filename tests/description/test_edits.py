"""Edits of a document's bytes, judged by expat: what it reads afterwards, and what it reads unchanged."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinik.description.edits import (
    edited,
    escaped,
    moved_to_child,
    overlap,
    renamed_attribute,
    renamed_element,
    start_tag,
    whole_element,
)
from pinik.description.flaw import Edit
from pinik.description.xml import parse

NAMES = st.sampled_from(["robot", "link", "Link", "a-b", "ä", "_x.1"])
VALUES = st.text(st.sampled_from(" ab>'\"&é/=<x!-\t\n"), max_size=8)
BLANKS = st.text(st.sampled_from(" \n\t"), min_size=1, max_size=3)
BETWEEN = st.sampled_from(
    ["", " text ", "<!-- <a b='>'> </robot> -->", "<![CDATA[ </link> <x ]]>", "<?php </a> ?>", "é&amp;&lt;", "a > b"]
)


@st.composite
def elements(draw: st.DrawFn, depth: int = 3) -> str:
    """An element as any program writes it: either quote, odd blanks, comments, and text that looks like tags."""
    name = draw(NAMES)
    attributes = ""
    for attribute in draw(st.lists(NAMES, unique=True, max_size=3)):
        quote = draw(st.sampled_from("\"'"))
        value = draw(VALUES).replace("&", "&amp;").replace("<", "&lt;").replace(quote, f"&#{ord(quote)};")
        equals = draw(st.sampled_from(["=", " = ", "\n="]))
        attributes += f"{draw(BLANKS)}{attribute}{equals}{quote}{value}{quote}"
    close = draw(st.sampled_from(["", " ", "\n"]))
    if depth == 0 or draw(st.booleans()):
        return f"<{name}{attributes}{close}/>"
    inside = "".join(
        draw(BETWEEN) + draw(elements(depth=depth - 1)) for _ in range(draw(st.integers(min_value=0, max_value=2)))
    )
    return f"<{name}{attributes}{close}>{inside}{draw(BETWEEN)}</{name}{close}>"


def documents() -> st.SearchStrategy[bytes]:
    before = st.sampled_from(["", "\n ", "\ufeff", '<?xml version="1.0" encoding="utf-8"?>\n', "<!-- <a> -->"])
    return st.builds(lambda start, root: (start + root).encode("utf-8"), before, elements())


def shape(root: ElementTree.Element) -> list[tuple[str, dict[str, str]]]:
    return [(element.tag, dict(element.attrib)) for element in root.iter()]


def in_order(document: bytes) -> list:
    """pinik's elements in the document's order, as `shape` has them."""
    return sorted(parse(document).walk(), key=lambda element: element.start)


@given(documents())
def test_tags_and_values_are_where_expat_finds_them(document):
    for element in in_order(document):
        tag = start_tag(document, element)
        assert document[slice(*tag.name)].decode() == element.tag
        assert list(tag.attributes) == list(element.attributes)
        for name, place in tag.attributes.items():
            around = b"<x " + document[place.name[0] : place.end] + b"/>"
            assert ElementTree.fromstring(around).attrib == {name: element.attributes[name]}
            assert document[place.value[0] - 1 : place.value[0]] in (b'"', b"'")
        start, _, end = whole_element(document, element)
        alone = ElementTree.fromstring(document[start:end])
        assert [tag for tag, _ in shape(alone)] == [
            one.tag for one in sorted(element.walk(), key=lambda one: one.start)
        ]


@given(documents(), st.data())
def test_a_renamed_element_is_all_that_expat_reads_otherwise(document, data):
    before = shape(ElementTree.fromstring(document.strip()))
    index = data.draw(st.integers(0, len(before) - 1))
    after = edited(document, renamed_element(document, in_order(document)[index], "renamed"))
    before[index] = ("renamed", before[index][1])
    assert shape(ElementTree.fromstring(after.strip())) == before


@given(documents(), st.data())
def test_a_renamed_attribute_is_all_that_expat_reads_otherwise(document, data):
    before = shape(ElementTree.fromstring(document.strip()))
    indices = [index for index, (_, attributes) in enumerate(before) if attributes]
    if indices:
        index = data.draw(st.sampled_from(indices))
        name = data.draw(st.sampled_from(sorted(before[index][1])))
        after = edited(document, renamed_attribute(document, in_order(document)[index], name, "renamed"))
        tag, attributes = before[index]
        before[index] = (tag, {"renamed" if one == name else one: text for one, text in attributes.items()})
        assert shape(ElementTree.fromstring(after.strip())) == before


@given(documents(), st.data())
def test_an_attribute_that_became_a_child_keeps_its_value(document, data):
    before = ElementTree.fromstring(document.strip())
    indices = [index for index, (_, attributes) in enumerate(shape(before)) if attributes]
    if indices:
        index = data.draw(st.sampled_from(indices))
        place = list(before.iter())[index]
        name = data.draw(st.sampled_from(sorted(place.attrib)))
        after = edited(document, moved_to_child(document, in_order(document)[index], name, "axis", "xyz"))
        child = ElementTree.Element("axis", {"xyz": place.attrib.pop(name)})
        place.insert(0, child)
        assert shape(ElementTree.fromstring(after.strip())) == shape(before)


def test_edits_leave_all_other_bytes_as_they_are():
    document = b"<a  b = '1'\r\n><!-- <b> -->\t<b  c=\"2\" /></a >"
    root = parse(document)
    (inner,) = root.children
    edits = [*renamed_element(document, root, "A"), *renamed_attribute(document, inner, "c", "d")]
    assert edited(document, edits[::-1]) == b"<A  b = '1'\r\n><!-- <b> -->\t<b  d=\"2\" /></A >"


def test_edits_that_overlap_are_told_apart_from_neighbours():
    insertion = Edit(5, 5, "x")
    assert overlap([Edit(0, 5, "")], [Edit(4, 6, "")])
    assert overlap([Edit(4, 6, "")], [insertion])
    assert not overlap([Edit(0, 5, "")], [Edit(5, 6, ""), insertion])
    assert not overlap([insertion], [insertion])
    with pytest.raises(ValueError, match="two edits overlap"):
        edited(b"0123456789", [Edit(0, 5, ""), Edit(4, 6, "")])


@given(VALUES)
def test_an_escaped_text_is_read_back(text):
    assert parse(f'<a b="{escaped(text)}"/>'.encode()).attributes["b"] == text
