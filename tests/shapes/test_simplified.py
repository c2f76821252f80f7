"""Meshes with few triangles, against the meshes that they stand for."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from pinik.shapes.simplified import simplified


def test_a_ball_of_few_triangles_is_still_a_ball():
    ball = trimesh.creation.icosphere(5, 0.3)
    few = simplified(ball.vertices, ball.faces, 0.05)
    assert 0.03 * len(ball.faces) < len(few.faces) < 0.06 * len(ball.faces)
    np.testing.assert_allclose(np.linalg.norm(few.vertices, axis=1), 0.3, rtol=0.02)
    outwards = few.vertices / np.linalg.norm(few.vertices, axis=1, keepdims=True)
    assert np.einsum("vk,vk->v", few.vertex_normals, outwards).min() > 0.97


def test_a_box_of_many_triangles_keeps_its_corners_edges_and_flat_faces():
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    for _ in range(4):
        box = box.subdivide()
    few = simplified(box.vertices, box.faces, 0.03)
    assert few.volume == pytest.approx(6.0, rel=1e-4)
    np.testing.assert_allclose(few.bounds, [[-0.5, -1.0, -1.5], [0.5, 1.0, 1.5]], atol=1e-4)
    along = np.abs(few.vertex_normals).max(axis=1)
    np.testing.assert_allclose(along, 1.0, atol=1e-3)  # each normal is that of one face: the edges stayed sharp


def test_vertices_at_one_place_are_one_so_that_no_gap_opens():
    ball = trimesh.creation.icosphere(4)
    loose = ball.vertices[ball.faces].reshape(-1, 3), np.arange(3 * len(ball.faces)).reshape(-1, 3)
    few = simplified(*loose, 0.2)
    merged = trimesh.Trimesh(few.vertices, few.faces)
    assert merged.is_watertight


@pytest.mark.parametrize(("count", "share"), [(12, 0.01), (80, 0.1), (1280, 0.7), (1280, 1.0)])
def test_what_has_few_triangles_or_shall_keep_most_of_them_stays(count, share):
    mesh = trimesh.creation.box() if count == 12 else trimesh.creation.icosphere({80: 1, 1280: 3}[count])
    assert len(mesh.faces) == count
    assert simplified(mesh.vertices, mesh.faces, share) is None


def test_triangles_without_area_do_no_harm():
    points = np.zeros((300, 3))
    points[:, 0] = np.linspace(0, 1, 300)
    faces = np.stack([np.arange(298), np.arange(1, 299), np.arange(2, 300)], axis=1)
    few = simplified(points, faces, 0.1)
    assert few is None or np.isfinite(few.vertices).all()


def test_a_part_that_sticks_out_is_not_lost():
    ball, disc = trimesh.creation.icosphere(4, 0.1), trimesh.creation.cylinder(0.004, 0.002, sections=12)
    disc.apply_translation((0.0, 0.0, 0.3))
    both = trimesh.util.concatenate([ball, disc])
    few = simplified(both.vertices, both.faces, 0.02)
    assert few is None or few.bounds[1, 2] > 0.29
