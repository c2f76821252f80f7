"""The balls: where they are, what they ask for."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pinocchio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinik
from by_hand import homogeneous, random_placement, rotation_about, rotation_from_rpy
from pinik.viewer.simulation.ball import Ball

ANGLES = st.tuples(*[st.floats(-3.1, 3.1)] * 3)


def ball(mode="on"):
    return Ball("tip", pinocchio.SE3(random_placement(np.random.default_rng(3))), mode)


def rotation_of(quaternion):
    x, y, z, w = quaternion
    length = math.hypot(x, y, z)
    return rotation_about(np.array([x, y, z]) / (length or 1.0), 2 * math.atan2(length, w))


@given(ANGLES)
def test_a_placement_is_the_position_and_the_rotation_of_roll_pitch_yaw(rpy):
    here = ball()
    here.put([1, 2, 3])
    here.orient(True, rpy)
    assert here.placement[:3].tolist() == [1, 2, 3]
    assert np.linalg.norm(here.placement[3:]) == pytest.approx(1.0)
    assert np.allclose(rotation_of(here.placement[3:]), rotation_from_rpy(*rpy), atol=1e-9)
    assert np.allclose(here.target.rotation, rotation_from_rpy(*rpy), atol=1e-9)


def test_a_ball_begins_at_its_frame_and_returns_there():
    home = random_placement(np.random.default_rng(3))
    here = ball()
    for _ in range(2):
        assert here.position.tolist() == home[:3, 3].tolist()
        assert np.allclose(homogeneous(rotation_of(here.placement[3:]), here.position), home)
        here.put([0, 0, 1])
        here.orient(True, [1, 1, 1])
        here.go_home()


def test_a_target_is_the_same_object_until_something_changed():
    here = ball()
    first = here.target
    assert here.target is first
    assert first.rotation is None
    assert first.position.tolist() == here.position.tolist()
    here.put([0, 0, 1])
    second = here.target
    assert second is not first
    assert second.position.tolist() == [0, 0, 1]
    here.orient(True, [0, 0, 0])
    assert here.target is not second
    assert here.target.rotation is not None
    here.orient(False, [0, 0, 0])
    assert here.target.rotation is None


@pytest.mark.parametrize("wrong", [[1, 2], [1, 2, math.nan], [1, 2, math.inf], "abc", None, [1, 2, True], 5])
def test_a_wrong_place_or_orientation_changes_nothing(wrong):
    here = ball()
    before = here.placement.tolist()
    with pytest.raises(pinik.InputError, match="position of ball 'tip'"):
        here.put(wrong)
    with pytest.raises(pinik.InputError, match="orientation of ball 'tip'"):
        here.orient(True, wrong)
    assert here.placement.tolist() == before
    assert not here.oriented


def test_a_position_is_free_along_some_axes_wherever_the_ball_is_put():
    here = ball()
    here.put([1, 2, 3])
    here.release("xz")
    assert here.target.to_dict()["position"] == [None, 2.0, None]
    here.put([4, 5, 6])
    assert here.target.to_dict()["position"] == [None, 5.0, None]
    assert here.placement[:3].tolist() == [4, 5, 6]
    here.release("")
    assert here.target.position.tolist() == [4, 5, 6]


def test_something_is_always_asked_for():
    here = ball()
    here.release("xy")
    with pytest.raises(pinik.InputError, match="ball 'tip' must ask for the position along at least one axis"):
        here.release("xyz")
    assert here.free == "xy"
    here.orient(True, [0, 0, 1])
    here.release("xyz")
    assert here.target.position is None
    with pytest.raises(pinik.InputError, match="ball 'tip' must ask for the position along at least one axis"):
        here.orient(False, [0, 0, 2])
    assert (here.oriented, here.rpy.tolist()) == (True, [0, 0, 1])


@pytest.mark.parametrize("wrong", ["yx", "xx", "w", "x y", "X"])
def test_axes_are_letters_in_order(wrong):
    with pytest.raises(pinik.InputError, match=r'letters of "xyz" in order; got'):
        ball().release(wrong)


def test_a_balls_own_tolerance_is_its_targets():
    here = ball()
    assert here.target.tolerance is None
    here.tolerate(pinik.Tolerance((0.01, 0.02, 0.03), 0.1))
    assert here.target.tolerance == pinik.Tolerance((0.01, 0.02, 0.03), 0.1)
    here.tolerate(None)
    assert here.target.tolerance is None


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="this system does not tell a process's size so")
def test_asking_where_a_ball_is_leaves_no_memory_behind():
    placed = ball()

    def pages():
        """The resident size, in pages."""
        for _ in range(20_000):
            assert len(placed.placement) == 7
        return int(Path("/proc/self/statm").read_text().split()[1])

    before = pages()
    assert pages() - before < 100  # a leak of 80 bytes each would take 390
