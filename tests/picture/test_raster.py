"""The z-buffer against a ray cast through every pixel at every triangle."""

from __future__ import annotations

import numpy as np
import pytest

from pinik.picture.raster import rasterize


def at_pixels(corners, depth):
    """A triangle's corners given in pixels, as the raster wants them."""
    depths = np.broadcast_to(np.asarray(depth, dtype=float), 3)[:, None]
    return np.hstack([np.asarray(corners, dtype=float) * depths, depths])


def rectangle(left, top, right, bottom, depth):
    a, b, c, d = (left, top), (right, top), (right, bottom), (left, bottom)
    return np.array([at_pixels([a, b, c], depth), at_pixels([a, c, d], depth)])


def cast(corners, size):
    """The nearest triangle, its depth, and how clear that is (h, w), by a linear system for each pixel and triangle."""
    width, height = size
    nearest, depth, clear = np.full((height, width), -1), np.full((height, width), np.inf), np.ones((height, width))
    for row in range(height):
        for column in range(width):
            for k, triangle in enumerate(corners):
                u = np.linalg.solve(triangle.T, [column + 0.5, row + 0.5, 1.0])
                here = 1.0 / u.sum()
                clear[row, column] = min(clear[row, column], abs(u * here).min())
                if (u >= 0.0).all() and here < depth[row, column]:
                    nearest[row, column], depth[row, column] = k, here
    return nearest, depth, clear


def test_it_shows_what_rays_through_the_pixels_meet():
    rng = np.random.default_rng(0)
    size = (24, 17)
    corners = np.array(
        [at_pixels(rng.uniform(-8, 30, (3, 2)), rng.uniform(1.0, 5.0, 3)) for _ in range(40)]
        + [at_pixels(rng.uniform(5, 15) + rng.uniform(0, 2, (3, 2)), rng.uniform(0.5, 1.0, 3)) for _ in range(20)]
    )
    nearest, depth, clear = cast(corners, size)
    raster = rasterize(corners, size)
    rows, columns = np.nonzero(raster.covered)
    found = np.full(nearest.shape, -1)
    found[rows, columns] = raster.triangles(rows, columns)
    sure = clear > 1e-6  # on an edge either answer is right
    assert sure.mean() > 0.99
    assert len(np.unique(nearest)) > 15
    assert (found == nearest)[sure].all()
    seen = sure & np.isfinite(depth)
    assert raster.depth[seen] == pytest.approx(depth[seen], rel=1e-6)


def test_the_nearer_of_two_wins_whatever_their_order():
    near, far = rectangle(0, 0, 10, 10, 1.0), rectangle(5, 0, 15, 10, 2.0)
    for corners, of_the_near in ((np.vstack([near, far]), (0, 1)), (np.vstack([far, near]), (2, 3))):
        raster = rasterize(corners, (16, 10))
        rows, columns = np.nonzero(raster.covered)
        shown = np.isin(raster.triangles(rows, columns), of_the_near)
        assert (shown == (columns < 10)).all()
        assert len(columns) == 150


def test_triangles_that_cross_change_places_where_they_cross():
    flat = rectangle(0, 0, 20, 4, 2.0)
    left, right = np.array([[0.0, 0.0], [0.0, 4.0]]), np.array([[20.0, 0.0], [20.0, 4.0]])
    slanted = np.array(
        [
            at_pixels([left[0], right[0], right[1]], [1.0, 4.0, 4.0]),
            at_pixels([left[0], right[1], left[1]], [1.0, 4.0, 1.0]),
        ]
    )
    raster = rasterize(np.vstack([flat, slanted]), (20, 4))
    rows, columns = np.nonzero(raster.covered)
    in_front = raster.triangles(rows, columns) >= 2
    # 1/depth is linear along a row: 1 − 0.75 x/20 is over 1/2 where x is under 40/3.
    assert (in_front == (columns + 0.5 < 40 / 3)).all()


def test_a_rectangle_covers_its_pixels_and_no_other():
    raster = rasterize(rectangle(3, 2, 9, 7, 1.0), (12, 10))
    expected = np.zeros((10, 12), bool)
    expected[2:7, 3:9] = True
    assert (raster.covered == expected).all()
    assert np.isinf(raster.depth[~expected]).all()


def test_nothing_shows_through_between_triangles_that_share_edges():
    rng = np.random.default_rng(1)
    across, down = np.meshgrid(np.linspace(-5, 105, 41), np.linspace(-5, 85, 37))
    places = np.stack([across, down], axis=2) + rng.uniform(-1.0, 1.0, (37, 41, 2))
    a, b, c, d = places[:-1, :-1], places[:-1, 1:], places[1:, 1:], places[1:, :-1]
    corners = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 2)
    depths = rng.uniform(1.0, 1.2, len(corners))
    raster = rasterize(np.array([at_pixels(one, depth) for one, depth in zip(corners, depths, strict=True)]), (100, 80))
    assert raster.covered.all()


def test_weights_are_those_of_the_point_and_not_of_the_pixel():
    corners = np.array([at_pixels([(0, 0), (40, 0), (0, 40)], [1.0, 5.0, 2.0])])
    raster = rasterize(corners, (40, 40))
    rows, columns = np.nonzero(raster.covered)
    weights = raster.weights(rows, columns)
    points = weights @ corners[0]
    assert weights.sum(axis=1) == pytest.approx(np.ones(len(rows)))
    assert points[:, 0] / points[:, 2] == pytest.approx(columns + 0.5)
    assert points[:, 1] / points[:, 2] == pytest.approx(rows + 0.5)
    assert points[:, 2] == pytest.approx(raster.depth[rows, columns], rel=1e-6)


@pytest.mark.parametrize(
    "corners",
    [
        np.zeros((0, 3, 3)),
        rectangle(0, 0, 10, 10, -1.0),
        np.array([at_pixels([(1, 1), (9, 1), (1, 9)], [1.0, 1.0, -1.0])]),
        np.array([at_pixels([(1, 1), (5, 5), (9, 9)], 1.0)]),
        rectangle(50, 0, 60, 10, 1.0),
        rectangle(4.6, 4.6, 5.4, 5.4, 1.0),
    ],
    ids=["none", "behind", "half behind", "without an area", "beside", "between the middles of pixels"],
)
def test_what_is_not_seen_leaves_the_picture_empty(corners):
    assert not rasterize(corners, (10, 10)).covered.any()


def test_it_does_not_matter_how_many_are_drawn_at_once(monkeypatch):
    rng = np.random.default_rng(2)
    corners = np.array([at_pixels(rng.uniform(-5, 45, (3, 2)), rng.uniform(1.0, 5.0, 3)) for _ in range(200)])
    at_once = rasterize(corners, (40, 40))
    monkeypatch.setattr("pinik.picture.raster._AT_ONCE", 100)
    bit_by_bit = rasterize(corners, (40, 40))
    assert (bit_by_bit.number == at_once.number).all()
    assert (bit_by_bit.depth == at_once.depth).all()
