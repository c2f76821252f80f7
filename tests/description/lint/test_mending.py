"""Mended copies of documents: read again by pinik and placed by plain Pinocchio, and all other bytes as before."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from pinik.description.lint.mending import Mending, mended
from pinik.description.xml import DocumentError
from urdf_texts import joint, link, robot

TREE = (
    '<?xml version="1.0"?>\n<!-- a robot > of "mine" -->\n<robot name="r">\n'
    '  <link name="a"/><link name="b"/>\n'
    '  <joint name="j" type="revolute"{joint}>   <parent link="a"/> <child link="b"/>\n'
    '    {origin}\t<!-- kept -->\n    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n</robot>\n'
)


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


def test_an_axis_that_was_an_attribute_turns_the_link_as_pinocchio_reads_it():
    result = mend(TREE.format(joint=' axis="0 1 0"', origin='<origin xyz="0 0 1"/>'))
    at = placed(result.document)[:3, :3]
    np.testing.assert_allclose(at, pinocchio.rpy.rpyToMatrix(0.0, 0.3, 0.0), atol=1e-12)


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


def test_an_unknown_encoding_is_an_error():
    with pytest.raises(DocumentError):
        mended(b'<?xml version="1.0" encoding="nonsense"?><robot/>')


def test_many_mends_are_made_at_once():
    """2,000 slips, each with its own edit; a reading for each of them would take minutes."""
    links = [link(f"l{i}") for i in range(2000)]
    joints = [joint(f"j{i}", "l0", f"l{i}", '<origin xzy="0 0 1"/>', kind="fixed", limit="") for i in range(1, 2000)]
    result = mend(robot(*links, *joints))
    assert (len(result.done), result.left, b"xzy" in result.document) == (1999, (), False)
