"""What `benchmarks/peers.py` says about a peer's answer."""

from __future__ import annotations

import math

import numpy as np
import pytest
from comparison.arms import ARMS, Arm, write_arm
from comparison.verdicts import Verdict, verdict_on, verdict_on_placement

from by_hand import homogeneous, rotation_about
from pinik.description.catalog import find
from plain_robot import PlainRobot


@pytest.fixture(scope="module", params=["ur5", "talos"])
def arm(request, tmp_path_factory) -> Arm:
    return write_arm(request.param, tmp_path_factory.mktemp("arms"))


def moved(target, metres, radians):
    """The target moved along y and turned about its x axis."""
    turn = rotation_about(np.array([1.0, 0.0, 0.0]), radians)
    return type(target)(target.homogeneous @ homogeneous(turn, (0.0, metres, 0.0)))


@pytest.mark.parametrize(
    ("metres", "radians", "verdict"),
    [
        (0.9e-4, 0.9e-3, Verdict.STRICTLY_SOLVED),
        (1.1e-4, 0.0, Verdict.SOLVED),
        (0.0, 1.1e-3, Verdict.SOLVED),
        (0.9e-3, 0.9e-2, Verdict.SOLVED),
        (1.1e-3, 0.0, Verdict.MISSED),
        (0.0, 1.1e-2, Verdict.MISSED),
    ],
)
def test_an_answer_is_as_good_as_its_worse_error(arm, metres, radians, verdict):
    q = arm.random(np.random.default_rng(0))
    assert verdict_on(arm, moved(arm.placement(q), metres, radians), q.tolist()) is verdict


def test_an_answer_outside_a_limit_is_not_solved_however_near(arm):
    for k in range(len(arm.joints)):
        q = 0.5 * (arm.lower + arm.upper)
        q[k] = arm.upper[k] + 1e-10
        assert verdict_on(arm, arm.placement(q), q) is Verdict.STRICTLY_SOLVED
        q[k] = arm.upper[k] + 1e-6
        assert verdict_on(arm, arm.placement(q), q) is Verdict.OUTSIDE_LIMITS
        assert verdict_on(arm, moved(arm.placement(q), 2e-3, 0.0), q) is Verdict.MISSED


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8])
def test_strict_means_the_tolerance_that_was_asked_for(arm, tolerance):
    q = arm.random(np.random.default_rng(3))
    asked = (tolerance, 10 * tolerance)
    assert verdict_on(arm, moved(arm.placement(q), 0.9 * tolerance, 9 * tolerance), q, asked) is Verdict.STRICTLY_SOLVED
    assert verdict_on(arm, moved(arm.placement(q), 1.1 * tolerance, 0.0), q, asked) is Verdict.SOLVED
    assert verdict_on(arm, moved(arm.placement(q), 0.0, 11 * tolerance), q, asked) is Verdict.SOLVED


def test_an_answer_with_no_number_in_it_is_missed(arm):
    q = arm.random(np.random.default_rng(1))
    target = arm.placement(q)
    q[0] = math.nan
    assert verdict_on(arm, target, q) is Verdict.MISSED


def test_a_placement_counts_only_where_it_is_the_one_of_the_joint_values(arm):
    placement = arm.placement(arm.random(np.random.default_rng(4)))
    assert verdict_on_placement(placement, placement.homogeneous) is Verdict.STRICTLY_SOLVED
    assert verdict_on_placement(placement, moved(placement, 1e-8, 0.0).homogeneous) is Verdict.MISSED
    assert verdict_on_placement(placement, np.full((4, 4), np.nan)) is Verdict.MISSED


def test_the_peers_file_places_the_tip_where_the_robots_own_file_does(arm):
    source = ARMS[arm.name]
    whole = PlainRobot(find(source.robot).urdf.read_bytes())
    q = arm.random(np.random.default_rng(2))
    base, tip = whole.placements([source.base, source.tip], dict(zip(arm.joints, q, strict=True)))
    assert np.allclose(arm.placement(q).homogeneous, np.linalg.inv(base) @ tip, atol=1e-12)


def test_the_file_of_the_chain_alone_places_the_tip_as_the_peers_file_does(arm):
    alone = PlainRobot(arm.chain.read_bytes())
    q = arm.random(np.random.default_rng(5))
    base, tip = alone.placements([arm.base, arm.tip], dict(zip(arm.joints, q, strict=True)))
    assert np.allclose(arm.placement(q).homogeneous, np.linalg.inv(base) @ tip, atol=1e-12)
    assert b"<inertial" not in arm.chain.read_bytes()
