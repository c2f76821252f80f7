"""The closed form: the tip of two hinges with links of 0.5 m and 0.4 m reaches the ring between 0.1 m and 0.9 m."""

from __future__ import annotations

import numpy as np
import pytest

import pinik

L1, L2 = 0.5, 0.4


@pytest.fixture(scope="module")
def solved(two_link):
    return pinik.reach(two_link, "tip", by="solving", cell=0.05)


@pytest.fixture(scope="module")
def sampled(two_link):
    return pinik.reach(two_link, "tip", cell=0.05, samples=400_000)


def distances(found):
    """The distances of the centres from the first hinge, of the grid's shape."""
    x, y, z = found.grid.axes
    assert len(z) == 1, "one layer is enough for an arm in a plane"
    assert abs(z[0]) < 1e-12
    return np.hypot(*np.meshgrid(x, y, indexing="ij"))[:, :, None]


def test_by_solving_a_cell_is_reached_where_its_centre_lies_in_the_ring(solved):
    away = distances(solved)
    clear = (np.abs(away - 0.9) > 1e-4) & (np.abs(away - 0.1) > 1e-4)  # not within the tolerance of an edge
    inside = (away > 0.1) & (away < 0.9)
    np.testing.assert_array_equal(solved.workspace("any")[clear], inside[clear])
    assert clear.mean() > 0.95


def test_by_sampling_a_cell_is_reached_where_it_meets_the_ring(sampled):
    x, y, _ = sampled.grid.axes
    half = 0.5 * sampled.grid.size
    nearest = np.hypot(*np.meshgrid(*((np.abs(a) - half).clip(min=0) for a in (x, y)), indexing="ij"))
    farthest = np.hypot(*np.meshgrid(*(np.abs(a) + half for a in (x, y)), indexing="ij"))
    meets = ((nearest < 0.9) & (farthest > 0.1))[:, :, None]
    found = sampled.workspace("any")
    assert not (found & ~meets).any()
    well = ((nearest < 0.88) & (farthest > 0.12))[:, :, None]  # with more than a sliver in the ring
    assert (found | ~well).all()


def test_the_volume_is_that_of_the_ring(solved):
    area = np.pi * (0.9**2 - 0.1**2)
    # The error of a count of cells is about the square root of the number of those at the edges.
    edge = 2 * np.pi * (0.9 + 0.1) * solved.grid.size
    assert solved.volume() / solved.grid.size == pytest.approx(area, abs=0.3 * edge)
    np.testing.assert_allclose(np.abs(solved.bounds()[:, :2]), 0.9, atol=0.5 * solved.grid.size + 1e-9)


def test_the_manipulability_is_the_closed_form(solved):
    """|det J| = l1 l2 |sin q2|, where the distance gives cos q2."""
    cosine = (distances(solved) ** 2 - L1**2 - L2**2) / (2 * L1 * L2)
    inside = solved.workspace("any") & (np.abs(cosine) < 0.98)  # at the edges the tolerance shows
    expected = L1 * L2 * np.sqrt((1 - cosine**2).clip(min=0))
    np.testing.assert_allclose(solved.manipulability[inside], expected[inside], atol=2e-4)
    assert np.isnan(solved.manipulability[~solved.workspace("any")]).all()


def test_the_room_to_the_limits_is_that_of_the_nearer_joint(two_link):
    found = pinik.reach(two_link, "tip", by="solving", box=[(0.85, -0.005, -0.005), (0.86, 0.005, 0.005)], cell=0.01)
    cosine = (0.855**2 - L1**2 - L2**2) / (2 * L1 * L2)
    elbow = np.arccos(cosine)
    shoulder = np.arctan2(L2 * np.sin(elbow), L1 + L2 * cosine)
    assert found.share.shape == (1, 1, 1)
    assert found.room.item() == pytest.approx(1 - max(elbow, shoulder) / np.pi, abs=1e-3)


def test_two_answers_are_counted_inside_the_ring(two_link):
    box = [(0.3, 0.1, -0.05), (0.6, 0.4, 0.05)]
    found = pinik.reach(two_link, "tip", by="solving", cell=0.1, box=box, branches=True)
    assert found.branches.shape == (3, 3, 1)
    assert (found.branches == 2).all()
    with pytest.raises(pinik.InputError, match="not counted"):
        _ = pinik.reach(two_link, "tip", samples=10).branches


def test_both_ways_agree_away_from_the_edges(solved, sampled):
    agreement = solved.agreement(sampled)
    assert agreement["only_this"] == 0
    edge = 2 * np.pi * (0.9 + 0.1) / solved.grid.size
    assert agreement["only_other"] < edge
    assert agreement["both"] == solved.workspace("any").sum()


def test_limits_and_locked_joints_count(two_link):
    locked = pinik.reach(two_link, "tip", cell=0.05, samples=50_000, locked=["joint1"])
    x, y = (locked.grid.centers(np.flatnonzero(locked.workspace()))[:, k] for k in (0, 1))
    assert np.abs(np.hypot(x - L1, y) - L2).max() < 0.04, "with the first hinge held, the tip is on a circle"
