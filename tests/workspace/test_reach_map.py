"""Questions about a map, answered from the map itself, and wrong questions refused in words."""

from __future__ import annotations

import numpy as np
import pinocchio
import pytest

import pinik
from pinik.workspace.grid import Grid, readable_size


@pytest.fixture(scope="module")
def ring(two_link):
    return pinik.reach(two_link, "tip", by="solving", cell=0.1)


@pytest.fixture(scope="module")
def posed(panda):
    return pinik.reach(panda, "panda_hand_tcp", cell=0.1, samples=60_000, directions=24, rolls=8)


def test_at_a_position(ring):
    inside = ring.at([0.52, 0.31, 0.0])
    assert inside.reached
    assert inside.share == 1.0
    np.testing.assert_allclose(inside.center, [0.5, 0.3, 0.0], atol=1e-9)
    cosine = (0.34 - 0.41) / 0.4
    assert inside.manipulability == pytest.approx(0.2 * np.sqrt(1 - cosine**2), abs=2e-4)
    assert np.isnan(inside.branches)
    for place in ([0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [5.0, 0.0, 0.0]):
        outside = ring.at(place)
        assert (outside.reached, outside.share) == (False, 0.0)
        assert np.isnan(outside.manipulability)


def test_at_a_pose_says_whether_its_own_orientation_is_reached(posed):
    row = int(np.argmax(posed.counts.reached.sum(axis=1)))
    reached = posed.counts.reached[row]
    assert 0 < reached.sum() < len(reached)
    center = posed.grid.centers(posed.counts.cells[[row]])[0]
    for k in (int(np.argmax(reached)), int(np.argmin(reached))):
        place = pinocchio.SE3(posed.orientations.rotations[k], center)
        assert posed.at(place).reached == reached[k] == posed.at(place.homogeneous).reached
        assert posed.at(place).share == pytest.approx(reached.mean())


def test_filter_takes_positions_matrices_and_placements(posed):
    row = int(np.argmax(posed.counts.found))
    center = posed.grid.centers(posed.counts.cells[[row]])[0]
    assert posed.filter([center, [9.0, 0.0, 0.0]]).tolist() == [True, False]
    places = [pinocchio.SE3(R, center) for R in posed.orientations.rotations]
    np.testing.assert_array_equal(posed.filter(places), posed.counts.reached[row])
    matrices = np.array([place.homogeneous for place in places])
    np.testing.assert_array_equal(posed.filter(matrices), posed.counts.reached[row])
    assert not posed.filter(matrices, "dexterous").any()


def test_the_nearest_reachable_place(ring, posed):
    assert ring.nearest_reachable([0.5, 0.3, 0.0]) == ([0.5, 0.3, 0.0], 0.0)
    nearest, distance = ring.nearest_reachable([2.0, 0.04, 0.0])
    np.testing.assert_allclose(nearest, [0.9, 0.0, 0.0], atol=1e-9)
    assert distance == pytest.approx(np.hypot(1.1, 0.04))
    far = pinocchio.SE3(posed.orientations.rotations[7], np.array([3.0, 0.0, 0.5]))
    place, distance = posed.nearest_reachable(far)
    assert posed.at(place).reached
    np.testing.assert_array_equal(place.rotation, far.rotation)
    cells = posed.counts.cells[posed.counts.reached[:, posed.orientations.regions_of(far.rotation[None])[0]]]
    assert distance == pytest.approx(np.linalg.norm(posed.grid.centers(cells) - far.translation, axis=1).min())
    assert posed.nearest_reachable([0.0, 0.0, 0.0], "dexterous") == (None, np.inf)


def test_workspaces_and_their_volumes_are_nested(posed):
    shares = [0.05, 0.2, 0.5, 0.9]
    volumes = [posed.volume("any"), *map(posed.volume, shares), posed.volume("dexterous")]
    assert volumes == sorted(volumes, reverse=True)
    assert volumes[0] == pytest.approx(0.1**3 * (posed.share > 0).sum())
    assert np.isnan(posed.bounds("dexterous")).all()
    low, high = posed.bounds()
    assert ((high - low) / 0.1 == pytest.approx(np.rint((high - low) / 0.1))) is True


@pytest.mark.parametrize("workspace", ["all", 0.0, 1.5, "Any"])
def test_a_wrong_workspace_is_refused(posed, workspace):
    with pytest.raises((pinik.UnknownNameError, pinik.InputError), match="workspace"):
        posed.workspace(workspace)


def test_down_needs_directions(ring):
    with pytest.raises(pinik.InputError, match=r"directions=48 \(--directions 48\)"):
        ring.workspace("down")
    told_apart = pinik.reach(ring.machine, ring.frame, cell=0.3, samples=1000, directions=48)
    assert told_apart.volume("down") == 0.0  # its tip lies in the plane


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"by": "guessing"}, "sampling"),
        ({"cell": -0.1}, "cell"),
        ({"cell": 1e-6}, "cells"),
        ({"samples": 0}, "samples"),
        ({"by": "solving", "samples": 10}, "samples"),
        ({"box": [(0, 0, 0), (0, 1, 1)]}, "box"),
        ({"cell": 0.005, "directions": 1000, "rolls": 50}, "too many"),
        ({"axis": "w"}, "axis"),
        ({"branches": True}, "branches"),
        ({"resume": True}, "output"),
        ({"output": "map.txt"}, "npz"),
        ({"colour": "red"}, "colour"),
        ({"cell": 1e300}, "cell must be at most 1e\\+09 m"),
    ],
)
def test_wrong_arguments_are_refused_in_words(two_link, options, words):
    with pytest.raises(pinik.PinikError, match=words):
        pinik.reach(two_link, "tip", **options)


def test_a_frame_that_nothing_moves_has_no_map(two_link):
    with pytest.raises(pinik.InputError, match="frame must be one that joints move; none moves 'base'"):
        pinik.reach(two_link, "base")
    with pytest.raises(pinik.UnknownNameError, match="tip"):
        pinik.reach(two_link, "tipp")


def test_branches_of_infinitely_many_answers_are_refused(panda):
    with pytest.raises(pinik.InputError, match="infinitely many"):
        pinik.reach(panda, "panda_hand_tcp", by="solving", branches=True)


def test_a_point_lies_in_the_cell_whose_centre_is_nearest():
    grid = Grid.around(np.array([0.1, -0.2, 0.3]), np.array([0.5, 0.3, 0.21]), 0.1)
    rng = np.random.default_rng(1)
    low, high = (np.array(grid.origin) + grid.size * (np.array(k) - 0.5) for k in ([0] * 3, grid.shape))
    points = rng.uniform(low, high, (500, 3))
    centers = grid.centers(np.arange(len(grid)))
    nearest = np.argmin(np.linalg.norm(points[:, None] - centers, axis=2), axis=1)
    np.testing.assert_array_equal(grid.cells_at(points), nearest)
    np.testing.assert_array_equal(grid.cells_at(centers), np.arange(len(grid)))
    assert (grid.cells_at(np.array([low - 0.01, high + 0.01])) == -1).all()
    assert (np.abs(grid.centers(np.array([0, len(grid) - 1])).mean(axis=0) - [0.1, -0.2, 0.3]) < 1e-12).all()


@pytest.mark.parametrize(("length", "size"), [(0.079, 0.1), (0.06, 0.05), (0.03, 0.02), (1.3, 1.0), (700.0, 500.0)])
def test_sizes_are_readable(length, size):
    assert readable_size(length) == pytest.approx(size)
