"""Looks: switched one by one, told in one order, and refused by name."""

from __future__ import annotations

import pytest

import pinik
from pinik.viewer.simulation.another_robot import with_robot
from pinik.viewer.simulation.looks import LOOKS, Looks
from pinik.viewer.simulation.session import Session
from robots import load_quietly


def test_looks_are_switched_one_by_one_and_told_in_the_order_of_the_menu():
    looks = Looks()
    for name in reversed(LOOKS):
        looks.switch(name, True)
        looks.switch(name, True)
    assert list(looks) == list(LOOKS)
    looks.switch("names", False)
    looks.switch("names", False)
    assert list(looks) == [name for name in LOOKS if name != "names"]
    assert "names" not in looks


def test_an_unknown_look_is_refused_and_changes_nothing():
    looks = Looks()
    with pytest.raises(pinik.UnknownNameError, match="axes"):
        looks.switch("axis", True)
    assert list(looks) == []


def test_another_robot_and_a_reset_keep_the_looks(arm):
    session = Session(arm, ["dls"])
    session.looks.switch("axes", True)
    session.reset()
    assert list(with_robot(session, load_quietly("two_link")).looks) == ["axes"]
