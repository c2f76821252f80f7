"""Loading a robot in another thread: the newest request wins, and a failure is an error in words."""

from __future__ import annotations

import pytest

import pinik
from pinik.viewer.protocol.robots import RobotMenu
from pinik.viewer.web.robot_loader import RobotLoader
from stand_ins import Later


@pytest.fixture
def later():
    return Later()


@pytest.fixture
def loader(two_link, later):
    return RobotLoader(RobotMenu(two_link), later)


def test_a_robot_arrives_with_its_root(loader, later):
    arrived = []
    loader.load("arm", "planar", arrived.append)
    assert (loader.loading, arrived) == ("arm", [])
    later.do_all()
    (robot,) = arrived
    assert (loader.loading, robot.name, robot.root) == (None, "arm", "planar")


@pytest.mark.parametrize("order", [(0, 0), (1, 0)], ids=["older first", "newer first"])
def test_the_newest_request_wins(loader, later, order):
    arrived = []
    for root in ("fixed", "planar"):
        loader.load("arm", root, arrived.append)
    for index in order:
        later.do(index)
    assert [robot.root for robot in arrived] == ["planar"]
    assert loader.loading is None


def test_a_robot_that_is_no_longer_wanted_does_not_arrive(loader, later):
    loader.load("arm", "fixed", pytest.fail)
    loader.cancel()
    assert loader.loading is None
    later.do_all()


def test_an_unknown_robot_is_refused_before_anything_is_loaded(loader, later):
    with pytest.raises(pinik.UnknownNameError):
        loader.load("armm", "fixed", pytest.fail)
    assert (loader.loading, later.waiting) == (None, [])


def test_a_robot_that_cannot_be_loaded_arrives_as_an_error(loader, later):
    arrived = []
    loader.load("ur3_empty", "fixed", arrived.append)
    later.do_all()
    (error,) = arrived
    assert isinstance(error, pinik.InputError)
    assert str(error).startswith("ur3_empty cannot be loaded: ")
    assert loader.loading is None
