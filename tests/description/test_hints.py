"""Errors that show what was probably meant: numbers with thousands, units that do not fit, types and tags."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.description.numbers import NumberError, read_numbers
from urdf_texts import link, pair, robot


@pytest.mark.parametrize("text", ["1,000.5 0 0", "1.000,5 0 0"])
def test_numbers_with_thousands_and_decimals_are_refused_with_the_likely_reading(text):
    with pytest.raises(NumberError, match=r'if "1000.5 0 0" is meant'):
        read_numbers(text, (3,), "length")


@pytest.mark.parametrize("text", ["1,2 3 4", "1.5,2 0 0", "0,000.5 0 0", "1,00.5 0 0"])
def test_no_thousands_are_seen_where_there_are_none(text):
    with pytest.raises(NumberError) as caught:
        read_numbers(text, (2,), "length")
    assert "is meant" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "quantity", "advice"),
    [
        ("1kg", "length", "in m"),
        ("1in", "length", "in m"),
        ("-90deg", "length", "in m"),
        ("1 kg", "length", "in m"),
        ("5mm", "angle", "in rad"),
        ("5mm", "number", "alone"),
    ],
)
def test_a_unit_of_another_quantity_is_called_one(text, quantity, advice):
    with pytest.raises(NumberError, match=f"does not fit here; write the number {advice}$"):
        read_numbers(text, (1,), quantity)


@pytest.mark.parametrize(
    ("kind", "near"),
    [("Revolute", "revolute"), ("revolut", "revolute"), (" Fixed", "fixed"), ("prismatik", "prismatic")],
)
def test_a_misspelt_type_is_answered_with_the_near_one(kind, near):
    with pytest.raises(pinik.RobotLoadError, match=f"did you mean '{near}'"):
        pinik.load(pair(kind=kind))


def test_a_type_that_resembles_none_is_answered_with_all():
    with pytest.raises(pinik.RobotLoadError, match="it must be one of revolute, continuous, prismatic, fixed"):
        pinik.load(pair(kind="ball"))


def test_white_space_around_a_type_means_nothing():
    with pytest.warns(pinik.UrdfWarning, match="read as 'revolute'"):
        loose = pinik.load(pair(kind=" revolute "))
    plain = pinik.load(pair(kind="revolute"))
    assert [flaw.code for flaw in loose.warnings] == ["loose-type"]
    np.testing.assert_array_equal((loose.lower, loose.upper), (plain.lower, plain.upper))
    assert loose.description.joints == plain.description.joints


def test_a_broken_tree_names_the_tags_that_were_misspelt():
    with pytest.raises(pinik.RobotLoadError, match=r"2 root links.*does not know <Joint> on line 1"):
        pinik.load(pair().replace("joint name", "Joint name").replace("</joint>", "</Joint>"))
    with pytest.raises(pinik.RobotLoadError, match=r"'b' is not defined.*does not know <Link> on line 1"):
        pinik.load(pair().replace(link("b"), '<Link name="b"/>'))
    with pytest.raises(pinik.RobotLoadError) as caught:
        pinik.load(robot(link("a"), link("b"), "<lamp/>"))
    assert "does not know" not in str(caught.value)
