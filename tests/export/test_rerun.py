"""Rerun recordings, read again by Rerun's own reader, and compared with plain Pinocchio."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
from pinik.export.rerun import save_rrd


@pytest.fixture(scope="module")
def arm():
    return pinik.load("arm")


@pytest.fixture(scope="module")
def recorded(arm, tmp_path_factory):
    """(configurations, entity → its record batches)."""
    from rerun.chunk import RrdReader

    q = np.array([arm.random(k) for k in range(4)])
    path = tmp_path_factory.mktemp("rerun") / "arm.rrd"
    save_rrd(arm, path, q, times=[0.0, 0.5, 0.75, 2.0])
    batches: dict[str, list] = {}
    for chunk in RrdReader(str(path)).stream():
        batches.setdefault(str(chunk.entity_path), []).append(chunk.to_record_batch())
    return q, batches


def column(batches, name):
    (found,) = (batch[name] for batch in batches if name in batch.schema.names)
    return found


def test_every_link_with_shapes_is_where_pinocchio_puts_it(arm, recorded):
    q, batches = recorded
    links = [link.name for link in arm.description.link_tags if link.visuals]
    assert links
    for link in links:
        own = batches[f"/robot/{link}"]
        places = [row[0] for row in column(own, "Transform3D:translation").to_pylist()]
        there = [arm.placement(link, one).translation.copy() for one in q]
        np.testing.assert_allclose(places, there, atol=1e-6)
        seconds = [row.total_seconds() for row in column(own, "time").to_pylist()]
        assert seconds == [0.0, 0.5, 0.75, 2.0]


def test_the_angles_of_every_joint_are_series(arm, recorded):
    q, batches = recorded
    for name in arm.joint_names:
        values = [row[0] for row in column(batches[f"/angles/{name}"], "Scalars:scalars").to_pylist()]
        assert values == pytest.approx([arm.angles(one)[name] for one in q])


def test_every_shape_is_a_mesh_with_all_its_triangles(arm, recorded):
    from pinik.shapes.meshes import load_shapes

    _, batches = recorded
    for number, shape in enumerate(load_shapes(arm)[0]):
        (faces,) = column(batches[f"/robot/{shape.link}/{number}"], "Mesh3D:triangle_indices").to_pylist()
        assert len(faces) == len(shape.mesh.faces)


def test_another_ending_is_refused(arm, tmp_path):
    with pytest.raises(pinik.InputError, match=r"must end with '\.rrd'"):
        save_rrd(arm, tmp_path / "arm.glb")
