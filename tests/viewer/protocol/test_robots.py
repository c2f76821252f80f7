"""Which robots a page can have: those of the catalogue, and the one that was there first."""

from __future__ import annotations

import pytest

import pinik
from by_hand import two_hinges
from pinik.viewer.protocol.robots import ROOTS, RobotMenu
from robots import load_quietly
from urdf_texts import link, robot


def test_only_names_are_known(arm, tmp_path):
    own = tmp_path / "own.urdf"
    own.write_text(two_hinges(1, 1))
    menu = RobotMenu(arm)
    for name in (str(own), f"file://{own}", "own.urdf", "../arm", "urdf/arm.urdf", "/etc/passwd", "", "Arm", "arm\0"):
        with pytest.raises(pinik.UnknownNameError, match="no robot"):
            menu.check(name, "fixed")
    for root in ("", "Fixed", "floating"):
        with pytest.raises(pinik.UnknownNameError, match="no root"):
            menu.check("arm", root)
    for root in ROOTS:
        menu.check("panda", root)


def test_the_first_robot_is_found_by_its_name_whatever_it_came_from(tmp_path):
    file = tmp_path / "file.urdf"
    file.write_text(robot(link("only")).replace('name="r"', 'name="mine"'))
    first = pinik.load(file)
    menu = RobotMenu(first)
    assert menu.own_names == ["mine"]
    file.unlink()
    for root in ROOTS:
        menu.check("mine", root)
        loaded = menu.load("mine", root)
        assert (loaded.root, loaded.description) == (root, first.description)


def test_a_first_robot_with_a_name_of_the_catalogue_stands_for_it():
    impostor = load_quietly(robot(link("only")).replace('name="r"', 'name="panda"'))
    menu = RobotMenu(impostor)
    assert menu.own_names == []
    assert menu.load("panda", "fixed").joint_names == ()
    assert len(menu.load("arm", "planar").joint_names) == 12


def test_warnings_of_a_robot_do_not_get_out(arm):
    assert RobotMenu(arm).load("quadruped", "free_flyer").warnings
    with pytest.raises(pinik.RobotLoadError):
        RobotMenu(arm).load("ur3_empty", "fixed")
