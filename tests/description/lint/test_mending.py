"""Mended copies of documents: read again by pinik and placed by plain Pinocchio, and all other bytes as before."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from pinik.description.lint.mending import Mending, mended
from pinik.description.reader import read
from pinik.description.xml import DocumentError
from urdf_texts import joint, link, robot

TREE = (
    '<?xml version="1.0"?>\n<!-- a robot > of "mine" -->\n<robot name="r">\n'
    '  <link name="a"/><link name="b"/>\n'
    '  <joint name="j" type="revolute"{joint}>   <parent link="a"/> <child link="b"/>\n'
    '    {origin}\t<!-- kept -->\n    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n</robot>\n'
)
SPHERE = '<visual><geometry><sphere radius="1"/></geometry><material name="m"/></visual>'


def placed(document: bytes, link: str = "b", angle: float = 0.3) -> np.ndarray:
    """The placement of a link by Pinocchio's own reader, at one angle of the first joint."""
    model = pinocchio.buildModelFromXML(document.decode())
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, np.array([angle]))
    return data.oMf[model.getFrameId(link)].homogeneous


def mend(text: str) -> Mending:
    return mended(text.encode())


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ('<origin xzy="1 2 3"/>', '<origin xyz="1 2 3"/>'),
        ("<Origin xyz='1 2 3' ></Origin >", "<origin xyz='1 2 3' ></origin >"),
        ("<Origin xzy='1 2 3' ></Origin >", "<origin xyz='1 2 3' ></origin >"),
    ],
)
def test_the_mended_text_differs_in_the_slip_alone(wrong, right):
    """Also where one slip hides another."""
    result = mend(TREE.format(joint="", origin=wrong))
    assert result.document.decode() == TREE.format(joint="", origin=right)
    assert (result.left, result.fault) == ((), "")
    np.testing.assert_allclose(placed(result.document)[:3, 3], [1, 2, 3])


def test_equal_elements_are_removed_but_one_and_different_ones_are_left():
    once, twice = ('<origin xyz="1 2 3"/>', '<origin xyz="1 2 3"/><origin  xyz="1 2 3"></origin><origin xyz="1 2 3"/>')
    result = mend(TREE.format(joint="", origin=twice))
    assert result.document.decode() == TREE.format(joint="", origin=once)
    assert ([flaw.code for flaw in result.done], result.left) == (["second-element"], ())
    different = TREE.format(joint="", origin='<origin xyz="1 2 3"/><origin xyz="1 2 4"/>')
    result = mend(different)
    assert (result.document.decode(), [one.flaw.code for one in result.left]) == (different, ["second-element"])


def test_an_axis_that_was_an_attribute_turns_the_link_as_pinocchio_reads_it():
    result = mend(TREE.format(joint=' axis="0 1 0"', origin='<origin xyz="0 0 1"/>'))
    at = placed(result.document)[:3, :3]
    np.testing.assert_allclose(at, pinocchio.rpy.rpyToMatrix(0.0, 0.3, 0.0), atol=1e-12)


@pytest.mark.parametrize(
    ("written", "xyz", "rpy"),
    [
        ('xyz="0.1, 0, 0.3" rpy="1.57, 0 0"', [0.1, 0, 0.3], [1.57, 0, 0]),
        ('xyz="0.1; 0; 0.3"', [0.1, 0, 0.3], [0, 0, 0]),
        ("xyz='[0.1 0 0.3]'", [0.1, 0, 0.3], [0, 0, 0]),
        ('xyz="0.1f 0.0f 0.3F"', [0.1, 0, 0.3], [0, 0, 0]),
        ('xyz="100mm 0mm 300mm"', [0.1, 0, 0.3], [0, 0, 0]),
        ('xyz="0.1 0 3d-1"', [0.1, 0, 0.3], [0, 0, 0]),
        ('xyz="&#x2212;0.1 0 0.3"', [-0.1, 0, 0.3], [0, 0, 0]),
        ('xyz="0.1 0 0.3" rpy="20 0 50 deg"', [0.1, 0, 0.3], [np.pi / 9, 0, np.pi / 3.6]),
        ('xyz="0.1234567890123456, 0 0" rpy=""', [0.1234567890123456, 0, 0], [0, 0, 0]),
    ],
)
def test_loose_numbers_become_plain_ones_of_the_same_value(written, xyz, rpy):
    text = TREE.format(joint="", origin=f"<origin {written}/>")
    before = pinik.robot.Robot(read(text))
    result = mend(text)
    assert (result.left, result.fault) == ((), "")
    after = pinik.load(result.document, strict=True)
    placement = placed(result.document, angle=0.0)
    np.testing.assert_allclose(placement[:3, 3], xyz, rtol=1e-15)
    np.testing.assert_allclose(placement[:3, :3], pinocchio.rpy.rpyToMatrix(*map(float, rpy)), atol=1e-15)
    assert after.description.joints == before.description.joints
    origin = result.document[result.document.index(b"<origin") :]
    origin = origin[: origin.index(b">") + 1]
    assert result.document.replace(origin, b"{origin}").decode() == TREE.format(joint="", origin="{origin}")


def test_a_scale_with_commas_and_four_numbers_becomes_three_plain_ones():
    mesh = '<visual><geometry><mesh filename="a.stl" scale="0.001, 0.001, 0.001, 1"/></geometry></visual>'
    result = mend(robot(link("a", mesh)))
    assert sorted(flaw.code for flaw in result.done) == ["loose-number", "loose-scale"]
    (found,) = ElementTree.fromstring(result.document).iter("mesh")
    assert found.attrib["scale"] == "0.001 0.001 0.001"


@pytest.mark.parametrize("first", ["\ufeff", '<?xml version="1.0" encoding="us-ascii"?>', "\n\n"])
def test_loose_numbers_are_found_again_in_a_document_that_could_not_be_loaded(first):
    """Its first mend, of the root, lets the reader change bytes before the numbers."""
    result = mend(first + '<Robot name="r"><link name="a"/>' + joint("j", "a", "b", '<origin xyz="1, 2, 3"/>') + "\n"
                  + link("b") + "</Robot>")  # fmt: skip
    assert (result.left, result.fault) == ((), "")
    (origin,) = ElementTree.fromstring(result.document).iter("origin")
    assert origin.attrib == {"xyz": "1 2 3"}


@pytest.mark.parametrize("root", ["robot", "Robot"])
@pytest.mark.parametrize(
    ("spoiled", "code"),
    [
        (lambda text: text + b"\0\0", "junk-around"),
        (lambda text: b'Here it is:\n<?xml version="1.0"?>' + text, "junk-around"),
        (lambda text: text.replace(b"</", b"<!-- a -- b --></", 1), "bad-comment"),
        (
            lambda text: b'<?xml version="1.0" encoding="utf-8"?>' + text.replace(b"<link", b"<!-- \xe9 --><link", 1),
            "encoding",
        ),
    ],
)
def test_what_the_reader_clears_a_document_of_is_mended_and_not_left(spoiled, code, root):
    text = robot(link("a"), joint("j", "a", "b", '<origin xyz="1, 2, 3"/>'), link("b")).replace("robot", root)
    result = mended(spoiled(text.encode()))
    assert code in [flaw.code for flaw in result.done]
    assert (result.left, result.fault) == ((), "")
    np.testing.assert_allclose(pinik.load(result.document, strict=True).description.joints[0].xyz, [1, 2, 3])


def test_loose_numbers_of_a_document_in_utf_16_are_mended():
    text = TREE.format(joint="", origin='<origin xyz="1, 2, 3"/>').replace('"1.0"', '"1.0" encoding="utf-16"')
    result = mended(text.encode("utf-16"))
    np.testing.assert_allclose(placed(result.document)[:3, 3], [1, 2, 3])
    (flaw,) = read(text.encode("utf-16")).warnings
    assert flaw.edits, "what is mended is reported as mendable"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize(
    ("rgba", "written"),
    [("255 128 0 255", (1, 128 / 255, 0, 1)), ("1.02 0 0 1", (1, 0, 0, 1)), ("255 0 51 0.5", (1, 0, 0.2, 0.5))],
)
def test_colours_beyond_1_are_written_as_they_are_read(rgba, written, encoding):
    text = robot(f'<material name="m"><color rgba="{rgba}"/></material>', link("a", SPHERE))
    result = mended(text.encode(encoding))
    assert ([flaw.code for flaw in result.done], result.left) == (["bright-color"], ())
    (color,) = ElementTree.fromstring(result.document).iter("color")
    assert [float(word) for word in color.get("rgba").split()] == list(written)
    assert read(result.document).link_tags == read(text).link_tags


def test_a_robot_without_a_name_gets_that_of_its_file():
    text = robot(link("a")).replace('<robot name="r">', '<?xml version="1.0"?><robot>')
    result = mended(text.encode(), Path("gripper & arm.urdf"))
    assert ([flaw.code for flaw in result.done], result.left) == (["no-name"], ())
    assert ElementTree.fromstring(result.document).get("name") == "gripper & arm"
    assert ElementTree.fromstring(mend(text).document).get("name") == "robot"


def test_the_misspelt_name_of_a_robot_is_mended_and_no_other_is_made_up():
    result = mend(robot(link("a")).replace("<robot name=", "<robot Name="))
    assert ElementTree.fromstring(result.document).attrib == {"name": "r"}


def test_links_and_joints_in_capitals_come_back_together():
    """A link alone would be a second root, and a joint alone would lead nowhere."""
    text = robot(
        '<Link name="x"/>', link("a"), '<Joint name="k" type="fixed"><parent link="a"/><child link="x"/></Joint>'
    )
    result = mend(text)
    assert len(result.done) == 2
    assert pinik.load(result.document.decode()).frame_names.count("x") == 1


def test_a_mend_that_spoils_the_file_is_left_out_and_the_others_are_made():
    """With a second <link>, the robot would have two roots."""
    text = robot('<Link name="x"/>', link("a"), link("b"), joint("j", "a", "b", '<origin xzy="0 0 1"/>'))
    result = mend(text)
    assert [flaw.code for flaw in result.done] == ["unknown-attribute"]
    (left,) = result.left
    assert left.flaw.code == "unknown-element"
    assert left.why.startswith("with this mend the file cannot be loaded: <robot>: 2 root links")
    np.testing.assert_allclose(placed(result.document)[:3, 3], [0, 0, 1])


def test_one_bad_mend_of_many_of_its_sort_does_not_keep_the_others():
    names = [f"l{i}" for i in range(8)]
    tree = [joint(f"j{i}", "a", name, '<origin xzy="0 0 1"/>', kind="fixed") for i, name in enumerate(names)]
    bad = joint("k", "a", "b", '<origin xzy="no number"/>', kind="fixed")
    result = mend(robot(link("a"), link("b"), *map(link, names), *tree[:3], bad, *tree[3:]))
    assert len(result.done) == len(names)
    assert [left.flaw.element for left in result.left] == ["joint 'k'"]


def test_shapes_are_mended_without_a_change_of_the_joints():
    shape = '<visual><orign xyz="0 0 1"/><geometry><sphere radius="1"/></geometry></visual>'
    text = robot(link("a", shape), link("b"), joint("j", "a", "b", '<origin xyz="1 2 3"/>'))
    result = mend(text)
    assert result.document.decode() == text.replace("orign", "origin")
    np.testing.assert_array_equal(placed(result.document), placed(text.encode()))


def test_what_has_two_answers_is_left_with_a_reason():
    text = robot(link("a"), link("b"), joint("j", "a", "b").replace('lower="-3" upper="3"', 'lower="-90" upper="90"'))
    result = mend(text)
    assert result.document.decode() == text
    assert [(left.flaw.code, left.why) for left in result.left] == [
        ("limit-in-degrees", "it has more than one answer, or none in this file")
    ]


def test_a_file_that_could_not_be_loaded_can_be_afterwards():
    text = robot(link("a"), link("b"), joint("j", "a", "b").replace("<parent", "<Parent"))
    with pytest.raises(pinik.RobotLoadError):
        pinik.load(text)
    result = mend(text)
    assert result.fault == ""
    assert pinik.load(result.document.decode()).joint_names == ("j",)


def test_a_file_that_cannot_be_loaded_at_all_says_why():
    result = mend(robot(link("a"), link("b"), '<Joint name="j" type="fixed"/>'))
    assert "root links" in result.fault or "parent" in result.fault


@pytest.mark.parametrize("encoding", ["iso-8859-1", "utf-16"])
def test_other_encodings_become_utf_8_with_the_right_declaration(encoding):
    text = TREE.format(joint="", origin='<origin xzy="1 2 3"/>').replace("mine", "meïne")
    text = text.replace('version="1.0"', f'version="1.0" encoding="{encoding}"')
    document = mended(text.encode(encoding)).document
    assert document.decode("utf-8").lstrip("\ufeff") == text.replace("xzy", "xyz").replace(encoding, "utf-8")


def test_an_unknown_encoding_becomes_utf_8_as_the_reader_takes_it():
    result = mended(b'<?xml version="1.0" encoding="nonsense"?><robot name="r"><link name="\xc3\xa9"/></robot>')
    assert result.document.decode() == '<?xml version="1.0" encoding="utf-8"?><robot name="r"><link name="é"/></robot>'
    assert [flaw.code for flaw in result.done] == ["encoding"]


def test_null_bytes_in_an_unknown_encoding_are_an_error():
    with pytest.raises(DocumentError):
        mended(b'<?xml version="1.0" encoding="nonsense"?><robot name="\0"/>')


def test_many_mends_are_made_at_once():
    """2,000 slips, each with its own edit; a reading for each of them would take minutes."""
    links = [link(f"l{i}") for i in range(2000)]
    joints = [joint(f"j{i}", "l0", f"l{i}", '<origin xzy="0 0 1"/>', kind="fixed", limit="") for i in range(1, 2000)]
    result = mend(robot(*links, *joints))
    assert (len(result.done), result.left, b"xzy" in result.document) == (1999, (), False)


def test_slips_that_are_the_same_word_for_word_are_all_mended():
    shape = '<visual><orign xyz="0 0 1"/><geometry><sphere radius="1"/></geometry></visual>'
    result = mend(robot(link("a", *[shape] * 30)))
    assert (len(result.done), result.left, b"orign" in result.document) == (30, (), False)


SCRAPS = [
    b"<",
    b">",
    b'"',
    b"'",
    b"&amp;",
    b"link",
    b"Link",
    b"name",
    b' axis="1 2 3"',
    b"<origin/>",
    b"</joint>",
    b"nan",
]
SCRAPS += [
    b"<Joint>",
    b"1e400",
    b"\0",
    b"\xe9",
    b"<!--",
    b"-->",
    b"/>",
    b"=",
    b'<?xml version="1.0" encoding="utf-16"?>',
]


@given(st.lists(st.tuples(st.integers(0, 400), st.integers(0, 8), st.sampled_from(SCRAPS)), min_size=1, max_size=4))
def test_whatever_became_of_a_document_its_mending_ends_in_words(changes):
    red = '<material name="red"><color rgba="1 0 0 1"/></material>'
    shape = '<visual><geometry><sphere radius="1"/></geometry><material name="Red"/></visual>'
    slip = joint("j", "a", "b", '<origin xzy="1 2 3"/><mimic joint="j" multiplyer="2"/>')
    document = robot(red, link("a", shape), link("b"), slip).encode()
    for start, length, scrap in changes:
        document = document[:start] + scrap + document[start + length :]
    try:
        result = mended(document)
    except DocumentError:
        return
    if not result.fault:
        read(result.document.decode())


@pytest.mark.parametrize(
    "origin",
    [
        '<OriginX/><Origin xyz="0 0 1"/>',
        '<Origin xyz="0 0 1"/><orgin xyz="0 0 2"/>',
        '<origin xyz="0 0 1" Rpy="0 0 1" rpyy="0 0 2"/>',
        '<dynamics dampin="1" Damping="2"/>',
    ],
)
def test_of_two_misspelt_names_for_one_thing_none_is_chosen(origin):
    text = TREE.format(joint="", origin=origin)
    result = mend(text)
    assert (result.document.decode(), result.done) == (text, ())
    slips = [one.flaw for one in result.left if one.flaw.code.startswith("unknown")]
    assert len(slips) == 2
    assert all("write the right one as" in flaw.mend for flaw in slips)


def test_an_attribute_and_an_element_for_one_axis_leave_the_choice_to_the_user():
    text = TREE.format(joint=' axis="0 1 0"', origin='<Axis xyz="0 0 1"/>')
    result = mend(text)
    assert (result.document.decode(), result.done) == (text, ())


def test_two_limits_for_one_end_are_left():
    text = TREE.format(joint="", origin="").replace('lower="-1"', 'lowr="-1" Lower="-0.5"')
    assert mend(text).document.decode() == text


def test_two_misspelt_elements_that_say_the_same_become_one():
    result = mend(TREE.format(joint="", origin='<Origin xyz="1 2 3"/><orgin xyz="1 2 3"/>'))
    assert result.document.decode() == TREE.format(joint="", origin='<origin xyz="1 2 3"/>')
