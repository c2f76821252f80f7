"""The Panda: against plain forward kinematics at random angles, and between the two ways."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from judge import plain_placement

FRAME = "panda_hand_tcp"
BOX = [(0.3, -0.2, 0.2), (0.7, 0.2, 0.6)]


@pytest.fixture(scope="module")
def solved(panda):
    return pinik.reach(panda, FRAME, by="solving", cell=0.1, box=BOX, directions=12, rolls=4)


@pytest.fixture(scope="module")
def sampled(panda):
    return pinik.reach(panda, FRAME, cell=0.1, samples=600_000, box=BOX, directions=12, rolls=4)


def test_plain_forward_kinematics_finds_nothing_outside_the_map(panda):
    """Monte Carlo: 2,000 random configurations that pinik's sampler did not draw."""
    found = pinik.reach(panda, FRAME, cell=0.15, samples=300_000, directions=6, rolls=0)
    rng = np.random.default_rng(11)
    places = np.array([plain_placement(panda, FRAME, panda.random(rng)).homogeneous for _ in range(2000)])
    assert found.filter(places[:, :3, 3]).mean() > 0.998
    assert found.filter(places).mean() > 0.97
    low, high = found.bounds()
    assert (places[:, :3, 3] >= low).all()
    assert (places[:, :3, 3] <= high).all()


def test_the_density_of_samples_is_that_of_plain_forward_kinematics(panda):
    """The share of random configurations in each of eight octants about the shoulder."""
    found = pinik.reach(panda, FRAME, cell=0.1, samples=200_000, directions=0)
    rng = np.random.default_rng(5)
    places = np.array([plain_placement(panda, FRAME, panda.random(rng)).translation for _ in range(4000)])
    middle = np.array([0.05, 0.05, 0.333 + 0.05])  # between cells

    def octants(points, weights):
        numbers = ((points > middle) * (1, 2, 4)).sum(axis=1)
        return np.bincount(numbers, weights, minlength=8) / weights.sum()

    drawn = octants(found.grid.centers(found.counts.cells), found.counts.found.astype(float))
    expected = octants(places, np.ones(len(places)))
    assert np.abs(drawn - expected).max() < 4 * np.sqrt(0.15 * 0.85 / 4000)


def test_what_is_solved_is_reached_by_plain_forward_kinematics_and_nothing_else(panda, solved):
    """pinik.solve with all its restarts, judged by plain Pinocchio, says of random poses the same as the map."""
    rng = np.random.default_rng(3)
    centers = solved.grid.centers(solved.counts.cells)
    missed = 0
    for _ in range(150):
        row, k = rng.integers(len(centers)), rng.integers(len(solved.orientations))
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = solved.orientations.rotations[k], centers[row]
        answer = panda.solve(FRAME, placement=place)
        assert solved.filter(place[None])[0] == solved.counts.reached[row, k]
        if solved.counts.reached[row, k]:
            error = plain_placement(panda, FRAME, answer.q).inverse().homogeneous @ place
            assert np.abs(error - np.eye(4)).max() < 2e-3
        else:
            missed += answer.success
    assert missed <= 2, "poses that the map says are not reached, and are"


def test_both_ways_agree(solved, sampled):
    """Each orientation whose region is full of samples is solved; what only samples reach lies at an edge."""
    agreement = solved.agreement(sampled)
    assert agreement["both"] / (agreement["both"] + agreement["only_this"]) > 0.97
    assert agreement["share"] > 0.8
    assert agreement["cells"] == 1.0
    more = sampled.share - solved.share
    assert -0.05 <= more.min() <= more.max() < 0.3
    assert more.mean() < 0.15


def test_down_is_one_direction_of_all(solved):
    down = solved.workspace("down")
    assert down.any()
    assert (solved.workspace("any") | ~down).all()
    assert not (solved.workspace("dexterous") & ~down).any()


def test_the_robot_itself_and_a_world_are_avoided(panda):
    wall = pinik.World()
    wall.add_box("wall", (0.02, 4.0, 4.0), np.block([[np.eye(3), np.array([[0.47], [0], [0]])], [np.zeros(3), 1.0]]))
    options = {"cell": 0.1, "samples": 20_000, "directions": 0}
    free = pinik.reach(panda, FRAME, **options)
    kept = pinik.reach(panda, FRAME, avoid=["self", wall], **options)
    assert kept.bounds()[1, 0] < 0.5 < free.bounds()[1, 0]
    assert (free.workspace() | ~kept.workspace()).all()
    alone = pinik.reach(panda, FRAME, avoid="self", **options)
    share = alone.counts.found.sum() / free.counts.found.sum()
    rng = np.random.default_rng(2)
    touching = np.mean([bool(panda.collisions(panda.random(rng))) for _ in range(2000)])
    assert 1 - share == pytest.approx(touching, abs=4 * np.sqrt(touching / 2000))


def test_a_tool_and_a_reference_move_the_map(panda):
    base = np.array(panda.placement("panda_hand_tcp", panda.neutral(), "panda_hand").homogeneous)
    options = {"cell": 0.2, "samples": 20_000, "directions": 6, "rolls": 3}
    frame = pinik.reach(panda, "panda_hand_tcp", **options)
    tool = pinik.reach(panda, "panda_hand", tool=base, **options)
    assert frame.grid.shape == tool.grid.shape
    np.testing.assert_allclose(frame.grid.origin, tool.grid.origin, atol=1e-9)
    np.testing.assert_array_equal(frame.counts.reached, tool.counts.reached)
    np.testing.assert_allclose(frame.counts.manipulability, tool.counts.manipulability, atol=20)
    from_link = pinik.reach(panda, "panda_hand_tcp", relative_to="panda_link1", **options)
    assert from_link.bounds()[1, 2] == pytest.approx(frame.bounds()[1, 2] - 0.333, abs=0.2)
