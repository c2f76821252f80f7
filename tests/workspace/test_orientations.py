"""Approach directions and orientations are even: regions of equal size, each with its own member in the middle."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.workspace.directions import Directions
from pinik.workspace.orientations import Orientations

RNG = np.random.default_rng(7)


def random_directions(count):
    vectors = RNG.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def random_rotations(count):
    """Uniform over SO(3), from uniform quaternions."""
    w, x, y, z = (column / 1 for column in random_quaternions(count).T)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def random_quaternions(count):
    quaternions = RNG.normal(size=(count, 4))
    return quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)


def deviation(counts):
    """Pearson's χ² for equal shares, in standard deviations from its mean."""
    expected = counts.sum() / len(counts)
    freedom = len(counts) - 1
    return (((counts - expected) ** 2 / expected).sum() - freedom) / np.sqrt(2 * max(freedom, 1))


@pytest.mark.parametrize("count", [1, 2, 3, 6, 12, 47, 48, 200])
def test_regions_of_directions_have_equal_areas_and_their_own_middles(count):
    regions = Directions(count)
    assert len(regions) == count
    assert (regions.regions_of(regions.vectors) == np.arange(count)).all()
    np.testing.assert_allclose(np.linalg.norm(regions.vectors, axis=1), 1.0, atol=1e-12)
    found = regions.regions_of(random_directions(100_000))
    assert abs(deviation(np.bincount(found, minlength=count))) < 5


@pytest.mark.parametrize("count", [48, 200])
def test_no_direction_is_far_from_the_middle_of_its_region(count):
    regions, vectors = Directions(count), random_directions(50_000)
    cosines = (vectors * regions.vectors[regions.regions_of(vectors)]).sum(axis=1)
    assert np.arccos(cosines.min()) < 0.85 * np.sqrt(4 * np.pi / count)


def test_six_directions_are_the_axes():
    axes = {tuple(vector) for vector in np.round(Directions(6).vectors, 9) + 0.0}
    assert axes == {(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)}


@pytest.mark.parametrize("axis", ["z", "x", "-z", "-y", (1.0, 2.0, -0.5)])
def test_orientations_lie_in_the_middle_of_regions_of_equal_volume(axis):
    orientations = Orientations(30, 8, axis)
    own = orientations.rotations
    assert own.shape == (240, 3, 3)
    np.testing.assert_allclose(own @ own.transpose(0, 2, 1), np.tile(np.eye(3), (240, 1, 1)), atol=1e-12)
    assert (orientations.regions_of(own) == np.arange(240)).all()
    rotations = random_rotations(100_000)
    found = orientations.regions_of(rotations)
    assert abs(deviation(np.bincount(found, minlength=240))) < 5
    turns = np.einsum("nij,nij->n", rotations, own[found])
    assert np.rad2deg(np.arccos((turns.min() - 1) / 2)) < 45, "a region is long and thin"


@pytest.mark.parametrize("axis", ["z", "-x", (0.0, 3.0, 4.0)])
def test_down_are_those_whose_axis_points_to_minus_z(axis):
    orientations = Orientations(20, 5, axis)
    pointing = orientations.rotations @ orientations.axis
    np.testing.assert_allclose(pointing[orientations.down], np.tile([0.0, 0.0, -1.0], (5, 1)), atol=1e-12)
    assert (np.delete(pointing, orientations.down, axis=0)[:, 2] > -0.99).all()


def test_without_rolls_or_directions_fewer_are_told_apart():
    rotations = random_rotations(1000)
    assert (Orientations(0, 0).regions_of(rotations) == 0).all()
    loose = Orientations(12, 0)
    assert len(loose) == 12
    assert (loose.regions_of(rotations) == Directions(12).regions_of(rotations[:, :, 2])).all()


@pytest.mark.parametrize("numbers", [(-1, 0), (48, -2), (1.5, 0), (10_000, 10_000)])
def test_impossible_numbers_are_refused(numbers):
    with pytest.raises(pinik.InputError, match=r"directions|rolls"):
        Orientations(*numbers)
