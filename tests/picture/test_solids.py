"""Balls and rods by what is known of spheres and cones."""

from __future__ import annotations

import numpy as np
import pytest

from pinik.picture.solids import ball, rod


def enclosed(solid):
    """The volume within, by Gauss; positive where the faces look outwards."""
    a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
    return np.einsum("kc,kc->", a, np.cross(b, c)) / 6.0


def test_a_ball_is_round_and_looks_outwards():
    center = np.array([1.0, -2.0, 0.5])
    solid = ball(center, 0.3)
    assert np.linalg.norm(solid.vertices - center, axis=1) == pytest.approx(np.full(len(solid.vertices), 0.3))
    assert solid.normals == pytest.approx((solid.vertices - center) / 0.3)
    assert enclosed(solid) == pytest.approx(4 / 3 * np.pi * 0.3**3, rel=0.01)


@pytest.mark.parametrize("along", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.3, -0.5, 0.2)])
def test_a_rod_goes_from_one_point_to_the_other(along):
    start = np.array([0.2, 0.1, -0.4])
    end = start + along
    solid = rod(start, end, 0.05, 0.02)
    axis = (end - start) / np.linalg.norm(end - start)
    height = (solid.vertices - start) @ axis
    away = np.linalg.norm(solid.vertices - start - height[:, None] * axis, axis=1)
    first = height < np.linalg.norm(along) / 2
    assert height[first] == pytest.approx(np.zeros(first.sum()), abs=1e-12)
    assert height[~first] == pytest.approx(np.full((~first).sum(), np.linalg.norm(along)))
    assert away == pytest.approx(np.where(first, 0.05, 0.02))
    outwards = np.einsum("kc,kc->k", solid.normals, solid.vertices - start - height[:, None] * axis)
    assert (outwards > 0.0).all()
    assert np.linalg.norm(solid.normals, axis=1) == pytest.approx(np.ones(len(solid.normals)))
    a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
    assert (np.einsum("kc,kc->k", np.cross(b - a, c - a), solid.normals[solid.faces[:, 0]]) > 0.0).all()
