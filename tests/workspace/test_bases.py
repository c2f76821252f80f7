"""Where to put the base: for targets that were made at a known base, that one is as good as any."""

from __future__ import annotations

import numpy as np
import pytest

import pinik


def base_at(x, y, yaw):
    place = np.eye(4)
    place[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    place[:2, 3] = x, y
    return place


@pytest.fixture(scope="module")
def found(ur5):
    return pinik.reach(ur5, "tool0", cell=0.1, samples=400_000, directions=12, rolls=4)


@pytest.fixture(scope="module")
def targets(ur5):
    rng = np.random.default_rng(4)
    return np.array([base_at(1.0, 2.0, 0.5) @ ur5.placement("tool0", ur5.random(rng)).homogeneous for _ in range(12)])


def test_the_best_base_reaches_all_that_a_known_base_reaches(ur5, found, targets):
    bases = found.bases(targets, yaws=12, step=0.2, most=5)
    assert len(bases) == 5
    assert (np.diff(bases.solved) <= 0).all()
    local = np.linalg.inv(bases.placements[0]) @ targets
    assert pinik.solve_many(ur5, "tool0", local).success.sum() == bases.solved[0]
    assert bases.solved[0] >= 10
    assert np.abs(bases.placements[:, :2, 3] - [1.0, 2.0]).max() < 1.0
    np.testing.assert_array_equal(bases.placements[:, 2], np.tile([0.0, 0.0, 1.0, 0.0], (5, 1)))


def test_the_map_says_of_a_base_what_it_says_of_each_target(found, targets):
    bases = found.bases(targets, yaws=6, step=0.25, most=4)
    for place, reached in zip(bases.placements, bases.reached, strict=True):
        assert found.filter(np.linalg.inv(place) @ targets).sum() == reached


def test_positions_heights_and_maps_without_a_robot(found, tmp_path):
    found.save(tmp_path / "map.npz")
    loose = pinik.ReachMap.load(tmp_path / "map.npz")
    points = np.array([[0.0, 0.0, 2.5], [0.2, 0.1, 2.6]])
    assert len(loose.bases(points)) == 0
    raised = loose.bases(points, heights=[0.0, 2.0], yaws=1)
    assert raised.solved is None
    assert raised.reached[0] == 2
    assert (raised.placements[:, 2, 3] == 2.0).all()
    assert "2 of 2" in str(raised)
    with pytest.raises(pinik.InputError, match="yaws"):
        loose.bases(points, yaws=0)


def test_targets_too_far_apart_are_refused_instead_of_tried_for_hours(found):
    with pytest.raises(pinik.InputError, match="they are too far apart, or the step is too small"):
        found.bases([[0.0, 0.0, 0.4], [1e6, 0.0, 0.4]])
    with pytest.raises(pinik.InputError, match="the step is too small"):
        found.bases([[0.0, 0.0, 0.4]], step=1e-6)


def test_bases_are_solved_for_with_the_options_of_the_map(found, targets):
    stiff = {"locked": ("wrist_1_joint", "wrist_2_joint")}
    bases = found.bases(targets, yaws=6, step=0.25, most=2, **stiff)
    local = np.linalg.inv(bases.placements[0]) @ targets
    assert pinik.solve_many(found.machine, "tool0", local, **stiff).success.sum() == bases.solved[0] < 6
