"""What a lint says about names that mean something else in URDF: what to write, and no promise that --fix breaks."""

from __future__ import annotations

import pytest

import pinik
from pinik.description.flaw import Flaw
from pinik.description.lint.front import lint
from pinik.description.lint.mending import mended
from urdf_texts import joint, link, pair, robot


def flaw_in(text: str, code: str) -> Flaw:
    (found,) = [flaw for flaw in lint(text.encode()) if flaw.code == code]
    return found


# What is written in a geometry → what the mend names.
SHAPES = {
    '<mesh file="a.stl"/>': "Write filename= instead",
    '<sphere diameter="1"/>': "Write radius= instead of it, with half of it.",
    '<cylinder radius="1" height="2"/>': "Write length= instead",
    '<box width="1"/>': "Write size= instead of it, with the three lengths",
}


@pytest.mark.parametrize(("shape", "mend"), SHAPES.items())
def test_attributes_of_shapes_that_others_have_are_translated(shape, mend):
    text = robot(link("a", f"<visual><geometry>{shape}</geometry></visual>"))
    assert flaw_in(text, "unknown-attribute").mend.startswith(mend)
    with pytest.warns(pinik.UrdfWarning, match="is unknown to URDF, write"):
        pinik.load(text)


def test_the_name_of_a_parent_is_its_link():
    text = pair().replace('<parent link="a"/>', '<parent name="a"/>')
    assert flaw_in(text, "unknown-attribute").mend == "Write link= instead of it."
    with pytest.raises(pinik.RobotLoadError, match="<parent> has no link; name= is unknown to URDF, write link="):
        pinik.load(text)


def test_a_missing_attribute_is_explained_by_the_slip_in_its_place():
    text = pair().replace('<parent link="a"/>', '<parent order="1" linc="a"/>')
    with pytest.raises(pinik.RobotLoadError, match="<parent> has no link; linc= is unknown to URDF, write link="):
        pinik.load(text)


def test_xyz_and_rpy_of_a_joint_are_those_of_its_origin():
    text = pair().replace('name="j"', 'name="j" xyz="0 0 1" rpy="0 0 0"')
    mends = [flaw.mend for flaw in lint(text.encode()) if flaw.code == "misplaced-attribute"]
    assert mends == ["Write it as <origin xyz=…>.", "Write it as <origin rpy=…>."]


def test_xyz_alone_may_be_that_of_an_origin_or_an_axis():
    text = pair().replace('name="j"', 'name="j" xyz="0 0 1"')
    assert flaw_in(text, "misplaced-attribute").mend == "Write it as <origin xyz=…> or as <axis xyz=…>."


@pytest.mark.parametrize(("lower", "upper", "count"), [("5", "-5", 1), ("-5", "5", 0), ("1", None, 1), ("0", "0", 0)])
def test_soft_limits_the_wrong_way_round_are_a_flaw(lower, upper, count):
    high = "" if upper is None else f'soft_upper_limit="{upper}"'
    text = pair(f'<safety_controller soft_lower_limit="{lower}" {high} k_velocity="1"/>')
    assert [flaw.code for flaw in lint(text.encode())].count("soft-limits") == count


@pytest.mark.parametrize("axis", ["z", "up", "0 0", "0 0 0", ""])
def test_an_axis_that_is_none_is_not_promised_to_be_mended(axis):
    text = pair().replace('name="j"', f'name="j" axis="{axis}"')
    flaw = flaw_in(text, "misplaced-attribute")
    assert flaw.edits == ()
    assert mended(text.encode()).done == ()


def test_a_letter_for_an_axis_is_shown_as_a_vector():
    text = robot(link("a"), link("b"), joint("j", "a", "b")).replace('name="j"', 'name="j" axis="-Z"')
    assert flaw_in(text, "misplaced-attribute").mend == 'Write <axis xyz="0 0 -1"/> inside <joint>.'
