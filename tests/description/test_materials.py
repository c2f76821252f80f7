"""Colours come from the material of a shape, or from the one of its name, wherever it stands; bad ones are left out."""

from __future__ import annotations

import pytest

import pinik
from pinik.description import reader as urdf
from urdf_texts import link, robot

BOX = '<geometry><box size="1 1 1"/></geometry>'


def color(rgba: str, name: str = "m") -> str:
    return f'<material name="{name}"><color rgba="{rgba}"/></material>'


def visual(material: str) -> str:
    return f"<visual>{BOX}{material}</visual>"


def read(*parts: str):
    description = urdf.read(robot(*parts))
    (shape,) = description.link_tags[-1].visuals
    return shape.color, description.warnings


USES = link("last", visual('<material name="m"/>'))
JOINT = '<joint name="k" type="fixed"><parent link="first"/><child link="last"/></joint>'
RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)


def test_a_material_is_known_by_its_name_in_the_whole_robot():
    in_another_link = link("first", visual(color("1 0 0 1")))
    assert read(color("1 0 0 1"), USES) == (RED, ())
    assert read(USES, color("1 0 0 1")) == (RED, ())  # also where it comes later
    assert read(in_another_link, USES, JOINT) == (RED, ())
    assert read(color("0 1 0 1"), in_another_link, USES, JOINT) == (GREEN, ())  # the robot's own come first
    assert read(color("1 0 0 1"), link("last", visual(color("0 1 0 1")))) == (GREEN, ())  # a shape's own before those
    assert read(link("last", visual('<material name="nobody"/>'))) == (None, ())
    assert read(link("last", visual('<material name="m"><texture filename="t.png"/></material>'))) == (None, ())


@pytest.mark.parametrize(
    "rgba", ["", "1 0 0", "1 0 0 1 1", "nan 0 0 1", "red", "-1 0 0 1", "300 0 0 255", "1e308 0 0 1"]
)
def test_a_colour_that_is_none_is_left_out_and_its_material_named(rgba):
    found, warnings = read(color(rgba, "skin"), link("last", visual('<material name="skin"/>')))
    assert found is None
    (flaw,) = warnings
    assert str(flaw).startswith("material 'skin': ")
    assert str(flaw).endswith("; its colour is left out (line 1)")


@pytest.mark.parametrize(
    ("rgba", "meant"),
    [
        ("255 128 0 255", (1.0, 128 / 255, 0.0, 1.0)),
        ("255 0 0 1", RED),
        ("1.02 0 0 1", RED),
        ("1, 0, 0, 1", RED),
        ("1 0 0 1.0f", RED),
    ],
)
def test_a_colour_with_one_reading_is_read_so_with_a_warning(rgba, meant):
    found, warnings = read(color(rgba), USES)
    assert found == pytest.approx(meant)
    (flaw,) = warnings
    assert flaw.element == "material 'm'"


@pytest.mark.parametrize("rgba", ["", "1 0 0 1 1", "nan 0 0 1", "1 0 0", "red"])
def test_a_shape_with_a_bad_colour_is_grey(rgba):
    from pinik.shapes.meshes import GREY, load_shapes

    with pytest.warns(pinik.UrdfWarning, match="r: material 'm': .* its colour is left out"):
        loaded = pinik.load(robot(color(rgba), USES))
    ((shape,), faults) = load_shapes(loaded)
    assert (shape.color, faults) == (GREY, [])


def test_a_robot_with_a_bad_colour_is_drawn():
    with pytest.warns(pinik.UrdfWarning, match="material 'm'"):
        loaded = pinik.load(robot(color("red"), USES))
    assert pinik.draw(loaded, size=(40, 30)).size == (40, 30)
