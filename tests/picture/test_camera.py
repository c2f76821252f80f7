"""Where a camera stands, by the geometry of a pinhole."""

from __future__ import annotations

import numpy as np
import pytest

from pinik.picture.camera import Camera, look_from

SIZE = (640, 400)


def pixels(camera, points, size=SIZE):
    x, y, depth = camera.seen(np.asarray(points, dtype=float), size).T
    return np.stack([x / depth, y / depth], axis=-1), depth


def test_a_point_is_seen_where_a_pinhole_shows_it():
    axes = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])  # from +x towards the origin
    camera = Camera(np.array([4.0, 0.0, 1.0]), axes, 0.5)
    found, depth = pixels(camera, [[0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0, 0.0, 3.0], [2.0, -0.5, 1.5]])
    assert found == pytest.approx(np.array([[320, 200], [520, 200], [320, 0], [220, 100]]))
    assert depth == pytest.approx([4.0, 4.0, 4.0, 2.0])


def test_rays_go_where_points_are_seen():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(50, 3))
    camera = look_from(np.array([1.0, -0.7, 0.4]), points, aspect=1.6, lens=0.3, filled=0.9)
    found, depth = pixels(camera, points)
    assert camera.position + camera.rays(*found.T, SIZE) * depth[:, None] == pytest.approx(points)


@pytest.mark.parametrize("direction", [(1.0, -0.7, 0.4), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)])
@pytest.mark.parametrize("spread", [(1.0, 1.0, 1.0), (3.0, 0.1, 0.1), (0.1, 0.1, 3.0)])
def test_points_fill_what_they_may_of_the_picture(direction, spread):
    rng = np.random.default_rng(1)
    points = rng.uniform(-1.0, 1.0, (100, 3)) * spread + [0.3, -0.2, 5.0]
    camera = look_from(np.array(direction), points, aspect=1.6, lens=0.3, filled=0.8)
    found, depth = pixels(camera, points)
    fraction = np.abs(found - np.array(SIZE) / 2) / (0.8 * np.array(SIZE) / 2)
    assert depth.min() > 0.0
    assert fraction.max() == pytest.approx(1.0)
    assert -camera.axes[2] == pytest.approx(np.array(direction) / np.linalg.norm(direction))
    assert camera.axes @ camera.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(camera.axes) == pytest.approx(1.0)
    low, high = found.min(axis=0) - np.array(SIZE) / 2, found.max(axis=0) - np.array(SIZE) / 2
    assert low + high == pytest.approx(np.zeros(2), abs=60.0)  # in the middle, but for the perspective


def test_the_world_stands_upright():
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for azimuth in np.linspace(0.0, 6.0, 9):
        camera = look_from(np.array([np.cos(azimuth), np.sin(azimuth), 0.3]), points, aspect=1.6, lens=0.3, filled=0.8)
        (foot, head), _ = pixels(camera, points)
        assert foot[0] == pytest.approx(head[0])
        assert foot[1] > head[1]


def test_from_above_it_is_a_map():
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    camera = look_from(np.array([0.0, 0.0, 1.0]), points, aspect=1.6, lens=0.3, filled=0.8)
    (origin, x, y), _ = pixels(camera, points)
    assert x[1] == pytest.approx(origin[1])
    assert x[0] > origin[0]
    assert y[0] == pytest.approx(origin[0])
    assert y[1] < origin[1]


def test_a_single_point_is_seen_as_well():
    camera = look_from(np.array([1.0, 0.0, 0.0]), np.array([[1.0, 2.0, 3.0]]), aspect=1.6, lens=0.3, filled=0.8)
    found, depth = pixels(camera, [[1.0, 2.0, 3.0]])
    assert found == pytest.approx(np.array([[320, 200]]))
    assert depth[0] > 0.0
