"""The balls: where they are, what they ask for."""

from __future__ import annotations

import math

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
