"""A shape that cannot be read is left out with a warning, and never stops kinematics."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinik
from pinik.description import reader as urdf
from urdf_texts import joint, link, robot

MESH = '<mesh filename="m.stl"{}/>'

# What the shape is, its origin and geometry, and words of the warning.
DROPPED = {
    "a place that is none": ('<origin xyz="nan 0 0"/>', '<box size="1 1 1"/>', "'nan' is not finite"),
    "a place beyond reason": ('<origin xyz="1e300 0 0"/>', '<box size="1 1 1"/>', "must be at most 1e+12 m"),
    "four angles": ('<origin rpy="0 0 0 1"/>', '<box size="1 1 1"/>', "may be a quaternion"),
    "a flat box": ("", '<box size="1 0 1"/>', "sizes must be positive"),
    "a box of size zero": ("", '<box size="0 0 0"/>', "sizes must be positive"),
    "a box without a size": ("", "<box/>", "<box> has no size"),
    "a sphere inside out": ("", '<sphere radius="-1"/>', "sizes must be positive"),
    "a sphere of radius zero": ("", '<sphere radius="0.0"/>', "sizes must be positive"),
    "a sphere too small": ("", '<sphere radius="1e-159"/>', "sizes must be at least 1e-12 m"),
    "a sphere too large": ("", '<sphere radius="1e308"/>', "must be at most 1e+12 m"),
    "a cylinder without a radius": ("", '<cylinder length="1"/>', "<cylinder> has no radius"),
    "a cylinder without an end": ("", '<cylinder radius="1" length="inf"/>', "'inf' is not finite"),
    "a mesh without a file": ("", "<mesh/>", "<mesh> has no filename"),
    "a mesh scaled to nothing": ("", MESH.format(' scale="1 1 0"'), "must not be zero"),
    "a mesh scaled beyond reason": ("", MESH.format(' scale="1e308 1 1"'), "must be at most 1e+12"),
    "a mesh scaled by two numbers": ("", MESH.format(' scale="1 1"'), "must be one number or 3 numbers or 4 numbers"),
    "a mesh scaled by a word": ("", MESH.format(' scale="big"'), "'big' is not a number"),
    "no geometry": ("", "", "has no shape"),
    "an unknown geometry": ("", "<cone/>", "<cone> is not a URDF shape"),
}


@pytest.mark.parametrize("tag", ["visual", "collision"])
@pytest.mark.parametrize(("origin", "geometry", "words"), DROPPED.values(), ids=DROPPED)
def test_a_bad_shape_is_left_out_and_named_with_its_line(tag, origin, geometry, words):
    good = f'<{tag}><geometry><sphere radius="1"/></geometry></{tag}>'
    bad = f"<{tag}>{origin}<geometry>{geometry}</geometry></{tag}>"
    description = urdf.read(robot(link("a", f"\n{bad}", good)))
    (flaw,) = description.warnings
    assert flaw.startswith(f"link 'a', {tag} 1: ")
    assert words in flaw
    assert flaw.endswith("; the shape is left out (line 2)")
    assert flaw.line == 2
    (left,) = getattr(description.link_tags[0], f"{tag}s")
    assert (left.kind, left.index) == ("sphere", 1)
    assert description.meshes == ()


@pytest.mark.parametrize(
    ("scale", "read_as", "warns"),
    [
        ("1 2 3", (1, 2, 3), None),
        ("1 -1 1", (1, -1, 1), None),
        ("", (1, 1, 1), None),
        ("1 2 3 1", (1, 2, 3), 'has four numbers instead of three; it is read as "1 2 3"'),
        ("0.001", (0.001,) * 3, 'has one number instead of three; it is read as "0.001 0.001 0.001"'),
        ("0.001, 0.001, 0.001", (0.001,) * 3, "has commas between the numbers"),
    ],
)
def test_a_mesh_is_scaled_as_one_would_read_it(scale, read_as, warns):
    mesh = MESH.format(f' scale="{scale}"')
    description = urdf.read(robot(link("a", f"<visual><geometry>{mesh}</geometry></visual>")))
    assert description.link_tags[0].visuals[0].size == read_as
    assert [warns in flaw for flaw in description.warnings] == ([] if warns is None else [True])


def test_what_the_reader_leaves_out_is_not_drawn_and_what_it_reads_is():
    """The mesh loader draws the shapes of the checked description, with numbers as they were read."""
    from pinik.shapes.meshes import load_shapes

    good = '<visual><origin xyz="0, 0, 1" rpy="0 0 90deg"/><geometry><box size="0.2; 0.4; 0.6m"/></geometry></visual>'
    bad = '<visual><geometry><box size="0 0 0"/></geometry></visual>'
    text = robot(link("a", bad, good))
    with pytest.warns(pinik.UrdfWarning):
        loaded = pinik.load(text)
    ((shape,), faults) = load_shapes(loaded)
    assert (shape.name, faults) == ("a/1", [])
    assert shape.mesh.extents == pytest.approx([0.2, 0.4, 0.6])
    turned = [[math.cos(math.pi / 2), -1, 0, 0], [1, math.cos(math.pi / 2), 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]]
    np.testing.assert_allclose(shape.placement, turned, atol=1e-15)
    (again,), warned = load_shapes(text)
    assert again.name == "a/1"
    assert [flaw.code for flaw in warned] == ["dropped-shape"]


def test_a_whole_humanoid_of_bad_shapes_warns_once_with_a_count():
    bad = '<visual><geometry><box size="0 0 0"/></geometry></visual>'
    links = [link(f"l{k}", f"\n{bad}") for k in range(40)]
    joints = [
        f'<joint name="j{k}" type="fixed"><parent link="l{k}"/><child link="l{k + 1}"/></joint>' for k in range(39)
    ]
    with pytest.warns(pinik.UrdfWarning) as caught:
        loaded = pinik.load(robot(*links, *joints))
    (words,) = [str(warning.message) for warning in caught]
    assert words.startswith("r: link 'l0', visual (line 2), link 'l1', visual (line 3)")
    assert "and 34 more, 40 times: a shape that cannot be read is left out" in words
    assert 'the first: <box size="0 0 0">: sizes must be positive; the shape is left out' in words
    assert len(loaded.warnings) == 40


@pytest.mark.parametrize(
    "geometry",
    ['<mesh filename="${d}/a.stl"/>', '<mesh filename="$(find p"/>', '<box size="${a} 1 1"/>'],
)
def test_a_xacro_expression_in_a_shape_leaves_out_the_shape_and_one_in_a_joint_is_an_error(geometry):
    shape = f"<visual><geometry>{geometry}</geometry></visual>"
    description = urdf.read(robot(link("a", shape), link("b"), joint("j", "a", "b", '<origin xyz="0 0 0.25"/>')))
    (flaw,) = description.warnings
    assert (flaw.code, flaw.element) == ("dropped-shape", "link 'a', visual")
    assert "is a xacro expression" in flaw
    assert [tag.visuals for tag in description.link_tags] == [(), ()]
    for part in ('<origin xyz="0 0 ${z}"/>', '<axis xyz="${z} 0 1"/>', '<mimic joint="$(arg j)"/>'):
        with pytest.raises(pinik.RobotLoadError, match="is a xacro expression: this is an unexpanded xacro file"):
            urdf.read(robot(link("a", shape), link("b"), joint("j", "a", "b", part)))
