from __future__ import annotations

import contextlib
import copy
import math
import os
from pathlib import Path
from xml.etree import ElementTree

import pinocchio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pinik.description import reader as urdf
from pinik.description.reader import Mimic
from pinik.errors import RobotLoadError
from pinik.model.build import build_model
from urdf_texts import LIMIT, chain, joint, link, pair, robot

INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'


def shape(geometry: str, origin: str = "") -> str:
    return link("a", f"<visual>{origin}<geometry>{geometry}</geometry></visual>")


def inertial(*parts: str) -> str:
    return link("a", f"<inertial>{''.join(parts)}</inertial>")


# What the document is, its text, the element that the error names, and words of the cause.
FAULTS = {
    "no element at all": ("<!-- only this -->", None, "not XML"),
    "an element left open": ("<robot><link", None, "not XML: unclosed token (line 1, column 8)"),
    "an element closed twice": ("<robot>\n</link></robot>", None, "mismatched tag (line 2"),
    "an entity of its own": ('<!DOCTYPE r [<!ENTITY e "x">]><robot/>', None, "entities"),
    "an external document type": ('<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot/>', None, "external"),
    "an undefined entity": ('<robot name="&e;"/>', None, "undefined entity"),
    "a null byte": ('<robot name="\0"/>', None, "null byte"),
    "a lone surrogate": ('<robot name="\ud800"/>', None, "cannot be encoded"),
    "a bottomless nesting": ("<a>" * 50_000, None, "nested more than"),
    "too many elements": (f"<robot>{'<a/>' * 500_000}</robot>", None, "more than 500,000"),
    "too many names": (
        "".join(["<robot>", *(f'<link{i} name{i}="a"/>' for i in range(5_000)), "</robot>"]),
        None,
        "more than 10,000 different names",
    ),
    "too many bytes": (f"<robot>{' ' * 2**24}</robot>", None, "too large"),
    "an SDF file": ('<sdf version="1.6"/>', "<sdf>", "SDF"),
    "an MJCF file": ("<mujoco/>", "<mujoco>", "MJCF"),
    "an SRDF file": ('<robot name="r"><group_state name="g"/></robot>', "<robot>", "SRDF"),
    "a web page": ("<html/>", "<html>", "the root element is <html>"),
    "a xacro macro": (robot("<xacro:macro/>", link("a")), "<xacro:macro>", "xacro file.xacro > file.urdf"),
    "a xacro expression": (robot(link("${side}_arm")), "<link>", "xacro"),
    "no links": (robot(), "<robot>", "no <link>"),
    "a link twice": (robot(link("a"), link("a")), "link 'a'", "defined twice, first on line 1"),
    "a link without a name": (robot("<link/>"), "<link>", "has no name"),
    "a link with an empty name": (robot(link(" ")), "<link>", "empty name"),
    "a joint twice": (
        robot(link("a"), link("b"), link("c"), joint("j", "a", "b"), joint("j", "b", "c")),
        "joint 'j'",
        "defined twice",
    ),
    "a joint without a name": (pair().replace('name="j"', ""), "<joint>", "has no name"),
    "a joint without a type": (pair().replace('type="revolute"', ""), "joint 'j'", "has no type"),
    "an unknown joint type": (pair(kind="hinge"), "joint 'j'", "unknown type 'hinge'; it must be one of revolute"),
    "a joint without a parent": (pair().replace('<parent link="a"/>', ""), "joint 'j'", "no <parent>"),
    "a joint without a child": (pair().replace('<child link="b"/>', ""), "joint 'j'", "no <child>"),
    "a parent without a link": (
        pair().replace('parent link="a"', "parent"),
        "joint 'j'",
        "<parent> has no link",
    ),
    "a missing parent": (
        robot(link("b"), joint("j", "a", "b")),
        "joint 'j'",
        "parent link 'a' is not defined",
    ),
    "a missing child": (robot(link("a"), joint("j", "a", "b")), "joint 'j'", "child link 'b' is not defined"),
    "two roots": (robot(link("a"), link("b")), "<robot>", "2 root links, but a robot has one: 'a', 'b'"),
    "two parents": (
        robot(link("a"), link("b"), joint("j", "a", "b"), joint("k", "a", "b")),
        "link 'b'",
        "two parents: joint 'j' from link 'a' and joint 'k' from link 'a'",
    ),
    "a cycle apart from the root": (
        robot(link("a"), link("b"), link("c"), joint("j", "b", "c"), joint("k", "c", "b")),
        "link 'c'",
        "cycle: 'b', 'c'",
    ),
    "a link that carries itself": (robot(link("a"), joint("j", "a", "a")), "link 'a'", "cycle: 'a'"),
    "an axis of zero": (pair('<axis xyz="0 0 0"/>'), "joint 'j'", 'xyz="0 0 0">: the axis is zero'),
    "an axis that is not finite": (pair('<axis xyz="0 nan 0"/>'), "joint 'j'", "'nan' is not finite"),
    "an axis without numbers": (pair("<axis/>"), "joint 'j'", "<axis> has no xyz"),
    "an axis of two numbers": (pair('<axis xyz="0 1"/>'), "joint 'j'", "must be 3 numbers; 2 given"),
    "an origin that is not finite": (pair('<origin xyz="0 0 inf"/>'), "joint 'j'", "'inf' is not finite"),
    "an origin that overflows": (pair('<origin rpy="0 0 1e999"/>'), "joint 'j'", "'1e999' is not finite"),
    "an origin out of this world": (pair('<origin xyz="0 0 1e300"/>'), "joint 'j'", "must be at most 1e+12 m"),
    "an origin of words": (pair('<origin rpy="0 0 half"/>'), "joint 'j'", "'half' is not a number"),
    "an origin turned out of this world": (pair('<origin rpy="0 0 1e300"/>'), "joint 'j'", "must be at most 1e+12 rad"),
    "an origin of four angles": (
        pair('<origin rpy="0 0 0 1"/>'),
        "joint 'j'",
        "4 given, which may be a quaternion, or roll, pitch and yaw with one number too many",
    ),
    "an origin whose commas have two meanings": (
        pair('<origin xyz="0,5, 0, 0"/>'),
        "joint 'j'",
        'can be read in two ways: as "0.5 0 0" or as one number more',
    ),
    "an offset of a thousand, or of one": (
        pair('<origin xyz="1,000 0 0"/>'),
        "joint 'j'",
        'can be read in two ways: as "1 0 0" or as "1000 0 0"',
    ),
    "two parents in one joint": (
        pair('<parent link="b"/>'),
        "joint 'j'",
        "has 2 <parent> elements, for link 'a' and for link 'b'",
    ),
    "an origin by quaternion": (pair('<origin quat_xyzw="0 0 0 1"/>'), "joint 'j'", "use rpy instead"),
    "a number in Python's notation": (pair('<origin xyz="0 0 1_0"/>'), "joint 'j'", "'1_0' is not a number"),
    "a number too long to be one": (
        pair(f'<origin xyz="0 0 {"1" * 10**6}"/>'),
        "joint 'j'",
        "must be 3 numbers; 1,000,004 characters given",
    ),
    "no limit on a revolute joint": (pair(limit=""), "joint 'j'", "revolute joint needs a <limit>"),
    "no limit on a prismatic joint": (pair(limit="", kind="prismatic"), "joint 'j'", "prismatic joint needs"),
    "a limit upside down": (
        pair(limit='<limit lower="2" upper="1"/>'),
        "joint 'j'",
        "lower limit 2 is above upper limit 1; either the two are swapped, and the range is 1..2, or one of them is",
    ),
    "a lower limit alone, above 0": (pair(limit='<limit lower="2"/>'), "joint 'j'", "(no upper is given, "),
    "a limit that is no number": (pair(limit='<limit lower="x" upper="1"/>'), "joint 'j'", "not a number"),
    "an empty limit": (pair(limit='<limit lower="" upper="1"/>'), "joint 'j'", "must be one number; 0 given"),
    "a mimic of itself": (pair('<mimic joint="j"/>'), "joint 'j'", "mimics itself"),
    "a mimic of nobody named": (pair("<mimic/>"), "joint 'j'", "<mimic> has no joint"),
    "a mimic without a number": (
        pair('<mimic joint="j" multiplier="x"/>'),
        "joint 'j'",
        "'x' is not a number",
    ),
    "mimics in a circle": (
        robot(
            *map(link, "abc"),
            joint("j", "a", "b", '<mimic joint="k"/>'),
            joint("k", "b", "c", '<mimic joint="j"/>'),
        ),
        "joint 'j'",
        "mimic in a circle: 'j', 'k'",
    ),
    "a mimic that multiplies beyond the far limit": (
        robot(*map(link, "abc"), joint("j", "a", "b"), joint("k", "b", "c", '<mimic joint="j" multiplier="1e308"/>')),
        "joint 'k'",
        '<mimic multiplier="1e308">: must be at most 1e+12',
    ),
    "a mimic whose offset lies beyond the far limit": (
        robot(*map(link, "abc"), joint("j", "a", "b"), joint("k", "b", "c", '<mimic joint="j" offset="-2e12"/>')),
        "joint 'k'",
        '<mimic offset="-2e12">: must be at most 1e+12',
    ),
    "mimics that together multiply beyond the far limit": (
        robot(
            *map(link, "abcd"),
            joint("j", "a", "b", '<mimic joint="k" multiplier="1e7"/>'),
            joint("k", "b", "c", '<mimic joint="l" multiplier="1e7"/>'),
            joint("l", "c", "d"),
        ),
        "joint 'j'",
        "it mimics 'l' with multiplier 1e+14 and offset 0, which must be at most 1e+12",
    ),
}


@pytest.mark.parametrize(("text", "element", "cause"), FAULTS.values(), ids=FAULTS)
def test_each_fault_is_refused_with_its_element_and_its_cause(text: str, element: str | None, cause: str) -> None:
    with pytest.raises(RobotLoadError) as caught:
        urdf.read(text)
    assert caught.value.element == element
    assert cause in str(caught.value)
    assert str(caught.value).startswith("<text>: " if element is None else f"<text>: {element}: ")


# What the document is, its text, and words of the warning.
WARNINGS = {
    "no bounds": (
        pair(limit="<limit/>"),
        "joint 'j': <limit> has no lower and no upper, which is read as 0: its range is 0..0",
    ),
    "no upper bound": (
        pair(limit='<limit lower="-1"/>'),
        "joint 'j': <limit> has no upper, which is read as 0: its range is -1..0",
    ),
    "a mimic of nobody": (pair('<mimic joint="k"/>'), "joint 'j': it mimics 'k', which does not exist"),
    "a mimic of a fixed joint": (
        robot(*map(link, "abc"), joint("k", "a", "b", kind="fixed"), joint("j", "b", "c", '<mimic joint="k"/>')),
        "joint 'j': it mimics 'k', which is a fixed joint; it is left free",
    ),
    "a floating mimic": (
        robot(
            *map(link, "abc"),
            joint("k", "a", "b"),
            joint("j", "b", "c", '<mimic joint="k"/>', kind="floating", limit=""),
        ),
        "joint 'j': a floating joint cannot mimic another",
    ),
    "a planar joint with limits": (
        pair('<axis xyz="0 0 1"/>', kind="planar"),
        "joint 'j': a planar joint has no limits here; its <limit> is ignored",
    ),
    "a floating joint with limits": (pair(kind="floating"), "joint 'j': a floating joint has no limits here"),
    "a planar joint without an axis": (
        pair(kind="planar", limit=""),
        "joint 'j': it has no <axis>, for which URDF's default is x; it moves in the yz-plane of its frame (line 1)",
    ),
    "two axes": (
        pair('<axis xyz="0 1 0"/><axis xyz="0 0 1"/>'),
        """joint 'j': has 2 <axis> elements that differ, <axis xyz="0 1 0"> (line 1) and <axis xyz="0 0 1"> (line 1)"""
        "; the first is taken (line 1)",
    ),
    "two origins": (pair("<origin/><origin/>"), "joint 'j': has 2 equal <origin> elements; the first is taken"),
    "the same parent twice": (
        pair('<parent link="a"/>'),
        "joint 'j': has 2 equal <parent> elements; the first is taken",
    ),
    "an empty origin": (pair('<origin xyz="" rpy="0 0 1"/>'), """joint 'j': <origin xyz=""> is empty, which is read"""),
    "commas": (
        pair('<origin xyz="0.1, 0, 0.3"/>'),
        """joint 'j': <origin xyz="0.1, 0, 0.3"> has commas between the numbers; it is read as "0.1 0 0.3" (line 1)""",
    ),
    "a limit without end": (
        pair(limit='<limit lower="-inf" upper="1"/>'),
        """joint 'j': <limit> lower="-inf" is infinite; it is read as no limit (line 1)""",
    ),
    "a limit that no joint reaches": (
        pair(limit='<limit lower="-1" upper="1e308"/>'),
        '<limit> upper="1e308" is beyond 1e+16; it is read as no limit',
    ),
    "two limits without end": (
        pair(limit='<limit lower="-INF" upper="1e17"/>'),
        """joint 'j': <limit> lower="-INF" is infinite and upper="1e17" is beyond 1e+16; they are read as no""",
    ),
    "a negative effort": (
        pair(limit='<limit lower="-1" upper="1" effort="-1"/>'),
        """joint 'j': <limit effort="-1">: it must not be negative; it is ignored (line 1)""",
    ),
    "a velocity that is no number": (
        pair(limit='<limit lower="-1" upper="1" velocity="fast"/>'),
        """joint 'j': <limit velocity="fast">: 'fast' is not a number; it is ignored""",
    ),
    "a negative friction": (pair('<dynamics friction="-1"/>'), "joint 'j': <dynamics friction=\"-1\">: it must not be"),
    "a damping that is no number": (pair('<dynamics damping="nan"/>'), "joint 'j': <dynamics damping=\"nan\">: 'nan'"),
    "a negative mass": (
        robot(inertial('<mass value="-1"/>', INERTIA)),
        """link 'a': <mass value="-1">: the mass is negative; the link is taken as massless (line 1)""",
    ),
    "a mass that is no number": (robot(inertial('<mass value="x"/>', INERTIA)), "link 'a': <mass value=\"x\">: 'x' is"),
    "a mass beyond reason": (
        robot(inertial('<mass value="1e300"/>', INERTIA)),
        "must be at most 1e+12 kg; the link is",
    ),
    "a mass without a value": (robot(inertial("<mass/>", INERTIA)), "link 'a': <mass> has no value; the link is taken"),
    "half an inertia": (
        robot(inertial('<mass value="1"/>', '<inertia ixx="1"/>')),
        "link 'a': <inertia> has no ixy; the link is taken as massless",
    ),
    "an inertia that is not finite": (
        robot(inertial('<mass value="1"/>', INERTIA.replace('ixx="1"', 'ixx="nan"'))),
        "'nan' is not finite; the link is taken as massless",
    ),
    "a centre of mass that is no number": (
        robot(inertial('<origin xyz="0 0 x"/>', '<mass value="1"/>', INERTIA)),
        "'x' is not a number; the link is taken as massless",
    ),
    "an inertial without a mass": (robot(inertial(INERTIA)), "link 'a': <inertial> has no <mass>"),
    "an inertial without an inertia": (
        robot(inertial('<mass value="1"/>')),
        "link 'a': <inertial> has no <inertia>",
    ),
    "a visual without a shape": (robot(link("a", "<visual/>")), "link 'a', visual: has no shape"),
    "an unknown shape": (robot(shape("<cone/>")), "link 'a', visual: <cone> is not a URDF shape"),
    "a robot without a name": (
        robot(link("a")).replace('name="r"', ""),
        "<robot>: has no name; the robot is named 'robot' (line 1)",
    ),
}


@pytest.mark.parametrize(("text", "words"), WARNINGS.values(), ids=WARNINGS)
def test_each_doubt_is_a_warning_and_pinocchio_reads_the_rest(text: str, words: str) -> None:
    description = urdf.read(text)
    assert [words in warning for warning in description.warnings] == [True]
    pinocchio.buildModelFromXML(description.xml)


SILENT = {
    "controllers and plugins": robot(link("a"), "<transmission/><gazebo><x/></gazebo><my_own_tag/>"),
    "soft limits of 0": pair('<safety_controller soft_lower_limit="0" soft_upper_limit="0" k_velocity="x"/>'),
    "no efforts": pair(limit='<limit lower="-1" upper="1"/>'),
    "empty dynamics": pair("<dynamics/>"),
    "a limit without end on a continuous joint": pair(limit='<limit lower="-inf" upper="inf"/>', kind="continuous"),
    "a tilted plane": pair('<axis xyz="1 0 0"/>', kind="planar", limit=""),
    "an effort beyond reason": pair(limit='<limit lower="-1" upper="1" effort="1e300" velocity="inf"/>'),
    "limits as Gazebo writes none": pair(limit='<limit lower="-1e16" upper="1e16"/>'),
    "an axis of zero on a fixed joint": pair('<axis xyz="0 0 0"/>', kind="fixed"),
    "a mirrored mesh": robot(shape('<mesh filename="m.stl" scale="1 -1 1"/>')),
    "an undefined material": robot(
        link("a", '<visual><geometry><box size="1 1 1"/></geometry><material name="m"/></visual>')
    ),
    "a material twice": robot(link("a"), '<material name="m"/><material name="m"/>'),
    "white space in numbers": pair('<origin xyz=" 1\n2\t3 "/>', limit='<limit lower=" -1 " upper="1 "/>'),
    "an unknown version": robot(link("a")).replace("<robot", '<robot version="7"'),
    "a mimic on a fixed joint": robot(
        *map(link, "abc"), joint("k", "a", "b"), joint("j", "b", "c", '<mimic joint="k"/>', kind="fixed")
    ),
    "a declaration after blank lines": '\n\n<?xml version="1.0"?>' + robot(link("a")),
    "a byte-order mark": "\ufeff" + robot(link("a")),
    "a declared encoding that text cannot have": '<?xml version="1.0" encoding="utf-16"?>' + robot(link("ä")),
}


@pytest.mark.parametrize("text", SILENT.values(), ids=SILENT)
def test_known_noise_is_read_in_silence(text: str) -> None:
    description = urdf.read(text)
    assert description.warnings == ()
    pinocchio.buildModelFromXML(description.xml)


def test_a_joint_is_read_as_it_is_written() -> None:
    text = pair(
        '<origin xyz="1 2.5 -3e-2" rpy="+.1 0 1."/><axis xyz="0 3 4"/><dynamics damping="2" friction="3"/>',
        limit='<limit lower="-1" upper="2" effort="5" velocity="6"/>',
    )
    tag = urdf.read(text).joints[0]
    assert (tag.name, tag.kind, tag.parent, tag.child) == ("j", "revolute", "a", "b")
    assert (tag.xyz, tag.rpy) == ((1.0, 2.5, -0.03), (0.1, 0.0, 1.0))
    assert tag.axis == pytest.approx((0.0, 0.6, 0.8), abs=1e-15)
    assert (tag.lower, tag.upper, tag.effort, tag.velocity, tag.damping, tag.friction) == (-1, 2, 5, 6, 2, 3)


def test_what_a_joint_leaves_open_has_the_defaults_of_urdf() -> None:
    tag = urdf.read(pair(limit="", kind="continuous")).joints[0]
    assert (tag.xyz, tag.rpy, tag.axis) == ((0, 0, 0), (0, 0, 0), (1, 0, 0))
    assert (tag.lower, tag.upper, tag.mimic, tag.effort, tag.velocity) == (None,) * 5


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e308])
def test_an_axis_of_any_length_is_made_one_long(scale: float) -> None:
    axis = urdf.read(pair(f'<axis xyz="{scale!r} {-scale!r} {scale!r}"/>')).joints[0].axis
    assert axis == pytest.approx([math.sqrt(1 / 3), -math.sqrt(1 / 3), math.sqrt(1 / 3)], abs=1e-15)


def test_links_meshes_and_root_are_listed_in_the_files_order() -> None:
    mesh = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    text = robot(
        link("b", mesh.format("package://p/b.stl")),
        link("a", mesh.format("a.dae"), mesh.format("package://p/b.stl").replace("visual", "collision")),
        joint("j", "a", "b"),
    )
    description = urdf.read(text)
    assert (description.name, description.source, description.path) == ("r", "<text>", None)
    assert (description.root, description.links) == ("a", ("b", "a"))
    assert description.meshes == ("package://p/b.stl", "a.dae")


def test_a_chain_of_mimics_names_its_ultimate_leader() -> None:
    text = robot(
        *map(link, "abcd"),
        joint("first", "a", "b", '<mimic joint="second" multiplier="2" offset="1"/>'),
        joint("second", "b", "c", '<mimic joint="third" multiplier="-3" offset="0.5"/>'),
        joint("third", "c", "d"),
    )
    mimics = {tag.name: tag.mimic for tag in urdf.read(text).joints}
    assert mimics == {"first": Mimic("third", -6.0, 2.0), "second": Mimic("third", -3.0, 0.5), "third": None}


@pytest.mark.parametrize("name", ["ü ö", "日本", "a&amp;b", "&lt;x&gt;", "&quot;'", " a ", "a&#10;b", "a&#9;b", "😀"])
def test_any_name_survives_the_way_to_pinocchio(name: str) -> None:
    description = urdf.read(robot(link("a"), link(name), joint(name, "a", name)))
    model = pinocchio.buildModelFromXML(description.xml)
    assert model.names[1] == description.joints[0].name == description.links[1]
    assert model.existFrame(description.links[1], pinocchio.BODY)


def test_links_and_joints_may_share_a_name() -> None:
    model = pinocchio.buildModelFromXML(urdf.read(robot(link("x"), link("y"), joint("x", "x", "y"))).xml)
    assert [frame.name for frame in model.frames] == ["universe", "x", "x", "y"]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_a_file_is_read_in_the_encoding_it_declares(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "robot.urdf"
    declared = encoding.removesuffix("-sig")
    path.write_bytes(f'<?xml version="1.0" encoding="{declared}"?>{robot(link("é"))}'.encode(encoding))
    description = urdf.read(path)
    assert description.links == ("é",)
    assert (description.source, description.path) == (str(path), path)


BAD_FILES = {
    "empty": (b"", "empty"),
    "blank": (b" \n", "empty"),
    "no XML": (b'{"robot": 1}', "not XML"),
    "binary": (bytes(range(256)), "null bytes"),
}


@pytest.mark.parametrize(("content", "cause"), BAD_FILES.values(), ids=BAD_FILES)
def test_a_file_that_is_no_urdf_is_named_with_the_cause(tmp_path: Path, content: bytes, cause: str) -> None:
    path = tmp_path / "robot.urdf"
    path.write_bytes(content)
    with pytest.raises(RobotLoadError, match=cause) as caught:
        urdf.read(str(path))
    assert caught.value.source == str(path)


@pytest.mark.parametrize(
    ("path", "cause"),
    [
        ("/no/such/robot.urdf", "no such file"),
        ("/", "directory"),
        ("", "directory"),
        ("a\0b", "null byte|null character"),  # Python's own words, which changed with 3.13
        ("a" * 5000, "too long"),
        ("robot: arm\nlinks: 3", "no such file"),
        ("/dev/zero", "a pipe or a device"),
    ],
)
def test_a_path_that_is_no_file_is_refused_in_words(path: str, cause: str) -> None:
    with pytest.raises(RobotLoadError, match=cause) as caught:
        urdf.read(path)
    assert len(str(caught.value)) < 300
    assert str(caught.value).isprintable()


def test_a_chain_of_thousands_of_mimics_is_composed_without_recursion() -> None:
    links = [link(f"l{i}") for i in range(5001)]
    joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", f'<mimic joint="j{i + 1}"/>') for i in range(4999)]
    description = urdf.read(robot(*links, *joints, joint("j4999", "l4999", "l5000")))
    assert description.joints[0].mimic == Mimic("j4999", 1.0, 0.0)


def test_a_pipe_that_is_open_already_is_read_like_a_file() -> None:
    ours, theirs = os.pipe()
    os.write(theirs, robot(link("a")).encode())
    os.close(theirs)
    try:
        assert urdf.read(f"/dev/fd/{ours}").links == ("a",)
    finally:
        os.close(ours)


def test_a_named_pipe_is_refused_in_words_and_nobody_waits_for_its_other_end(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.urdf")
    with pytest.raises(RobotLoadError, match="a pipe or a device, not a URDF file"):
        urdf.read(tmp_path / "pipe.urdf")


@pytest.mark.parametrize(
    ("inside", "element"),
    [
        ('<xi:include href="other.urdf"/>', "<xi:include>"),
        ('<x:include xmlns:x="http://www.w3.org/2001/XInclude" href="other.urdf"/>', "<x:include>"),
        ('<include xmlns="http://www.w3.org/2001/XInclude" href="other.urdf"/>', "<include>"),
        ('<link name="b"><x:fallback xmlns:x="http://www.w3.org/2001/XInclude"/></link>', "<x:fallback>"),
    ],
)
def test_xinclude_is_refused_as_an_external_reference(inside: str, element: str) -> None:
    with pytest.raises(RobotLoadError, match=r"external references \(XInclude\) are refused") as caught:
        urdf.read(robot(link("a"), inside))
    assert caught.value.element == element


def test_an_include_of_another_kind_is_none_of_our_business() -> None:
    assert urdf.read(robot(link("a"), '<include xmlns:x="urn:x"/><x:include xmlns:x="urn:x"/>')).links == ("a",)


def test_the_description_keeps_what_was_read(tmp_path: Path) -> None:
    text = robot(link("a", '<visual><geometry><box size="1 1 1"/></geometry></visual>'))
    assert urdf.read(text).document == text.encode()
    (tmp_path / "r.urdf").write_text(text)
    assert urdf.read(tmp_path / "r.urdf").document == text.encode()


SEED = robot(
    link("base", f'<inertial><mass value="1"/>{INERTIA}</inertial>'),
    link(
        "upper",
        '<visual><origin xyz="0 0 1"/><geometry><cylinder radius=".1" length="1"/></geometry></visual>',
    ),
    link("fore", '<collision><geometry><mesh filename="f.stl" scale="1 1 1"/></geometry></collision>'),
    link("hand"),
    joint("shoulder", "base", "upper", '<axis xyz="0 0 1"/><dynamics damping="1"/>'),
    joint("elbow", "upper", "fore", '<origin rpy="0 1 0"/><mimic joint="shoulder" multiplier="2"/>'),
    joint("wrist", "fore", "hand", '<origin xyz="0 0 1"/>', kind="continuous", limit=""),
)
WORDS = [
    "",
    " ",
    "0",
    "-1",
    "1e400",
    "nan",
    "0 0",
    "0 0 0",
    "1 2 3",
    "base",
    "hand",
    "elbow",
    "wrist",
    "ü",
    "\t",
]
KINDS = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]
VALUES = (
    st.sampled_from(WORDS + KINDS)
    | st.floats().map(str)
    | st.tuples(*[st.floats()] * 3).map(lambda xyz: "{} {} {}".format(*xyz))
    | st.text(max_size=6)
)


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """SEED with some elements or attributes deleted, doubled, moved or garbled, sometimes cut short."""
    root = ElementTree.fromstring(SEED)
    for _ in range(draw(st.integers(1, 4))):
        holders = [element for element in root.iter() if len(element)]
        holder = draw(st.sampled_from(holders))
        element = draw(st.sampled_from(list(holder)))
        attribute = draw(st.sampled_from(sorted(element.attrib) or ["name"]))
        match draw(st.sampled_from(["garble", "garble", "strip", "delete", "double", "move", "retag"])):
            case "garble":
                element.set(attribute, draw(VALUES))
            case "strip":
                element.attrib.pop(attribute, None)
            case "delete" if len(root) > 1:
                holder.remove(element)
            case "double":
                holder.append(copy.deepcopy(element))
            case "move":
                draw(st.sampled_from(holders)).append(copy.deepcopy(element))
            case "retag":
                element.tag = draw(st.sampled_from(["link", "joint", "origin", "axis", "limit", "mimic", "box"]))
    text = ElementTree.tostring(root, encoding="unicode")
    return text[: draw(st.integers(1, len(text)))] if draw(st.integers(0, 9)) == 0 else text


@given(mutated())
@settings(max_examples=400)
def test_a_mutilated_urdf_loads_or_is_refused_in_words_and_nothing_else(text: str) -> None:
    with contextlib.suppress(RobotLoadError):
        description = urdf.read(text)
        for root in ("fixed", "free_flyer"):
            model, _ = build_model(description, root=root)
            data = model.createData()
            pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
            assert all(math.isfinite(x) for placement in data.oMf for x in placement.homogeneous.flat)


def test_all_that_read_accepts_pinocchio_accepts() -> None:
    """No "does not contain a valid URDF model" is left for Pinocchio to say, at any joint kind."""
    for kind in ("revolute", "continuous", "prismatic", "fixed", "floating", "planar"):
        accepted = []
        for limit in ("", "<limit/>", LIMIT, '<limit effort="1"/>', '<limit velocity="0" lower="0"/>'):
            with contextlib.suppress(RobotLoadError):
                description = urdf.read(pair('<dynamics friction="0"/>', kind=kind, limit=limit))
                pinocchio.buildModelFromXML(description.xml)
                accepted.append(limit)
        assert LIMIT in accepted


def test_the_longest_admitted_description_is_read() -> None:
    assert len(urdf.read(chain(9_999, "fixed")).links) == 10_000


def test_eight_roots_are_six_and_two_more():
    with pytest.raises(RobotLoadError, match=r"8 root links, .*: 'a', 'b', 'c', 'd', 'e', 'f' and 2 more; connect"):
        urdf.read(robot(*map(link, "abcdefgh")))


@pytest.mark.parametrize(("parent", "words"), [("<parent/>", "no link"), ('<parent link=" "/>', "an empty link")])
def test_a_name_that_is_missing_is_told_from_one_that_is_empty(parent, words):
    with pytest.raises(RobotLoadError, match=f"<parent> has {words}"):
        urdf.read(pair().replace('<parent link="a"/>', parent))
