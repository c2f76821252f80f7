"""Rerun recordings, read again by Rerun's own reader, and compared with plain Pinocchio."""

from __future__ import annotations

import numpy as np
import pytest

import pinik
import urdf_texts as urdf
from pinik.export.live_recording import LiveRecording, RecordedBall
from pinik.export.rerun import save_rrd


@pytest.fixture(scope="module")
def arm():
    return pinik.load("arm")


@pytest.fixture(scope="module")
def recorded(arm, tmp_path_factory):
    """(configurations, entity → its record batches)."""
    q = np.array([arm.random(k) for k in range(4)])
    path = tmp_path_factory.mktemp("rerun") / "arm.rrd"
    save_rrd(arm, path, q, times=[0.0, 0.5, 0.75, 2.0])
    return q, read(path)


def read(path):
    """Entity → its record batches."""
    from rerun.chunk import RrdReader

    batches: dict[str, list] = {}
    for chunk in RrdReader(str(path)).stream():
        batches.setdefault(str(chunk.entity_path), []).append(chunk.to_record_batch())
    return batches


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


def test_followers_have_angles_too(tmp_path):
    box = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    follower = urdf.joint("follows", "b", "c", '<mimic joint="leads" multiplier="-2" offset="0.5"/>')
    parts = urdf.link("a", box), urdf.link("b"), urdf.link("c")
    machine = pinik.load(urdf.robot(*parts, urdf.joint("leads", "a", "b"), follower))
    save_rrd(machine, tmp_path / "follower.rrd", [machine.configuration({"leads": angle}) for angle in (0.1, 0.4)])
    series = column(read(tmp_path / "follower.rrd")["/angles/follows"], "Scalars:scalars").to_pylist()
    assert [row[0] for row in series] == pytest.approx([0.3, -0.3])


def test_every_shape_is_a_mesh_with_all_its_triangles(arm, recorded):
    from pinik.shapes.meshes import load_shapes

    _, batches = recorded
    for number, shape in enumerate(load_shapes(arm)[0]):
        (faces,) = column(batches[f"/robot/{shape.link}/{number}"], "Mesh3D:triangle_indices").to_pylist()
        assert len(faces) == len(shape.mesh.faces)


def test_a_recording_of_a_live_view_has_every_robot_with_its_ball_and_its_name(arm, tmp_path):
    q = np.array([[arm.random(10 * i + k) for k in range(3)] for i in range(2)])
    positions = np.array([[0.5, 0.1 * k, 0.6] for k in range(3)])
    ball = RecordedBall("tip", positions, np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)), False, True)
    recording = LiveRecording(arm, (pinik.CCD(), pinik.DampedLeastSquares()), np.array([0.0, 0.1, 0.3]), q, (ball,))
    save_rrd(recording, tmp_path / "live.rrd")
    batches = read(tmp_path / "live.rrd")
    apart = []
    for name, title, own in zip(("ccd", "dls"), ("Cyclic coordinate descent", "Damped least squares"), q, strict=True):
        places = [row[0] for row in column(batches[f"/robot/{name}/bone2"], "Transform3D:translation").to_pylist()]
        np.testing.assert_allclose(places, [arm.placement("bone2", one).translation.copy() for one in own], atol=1e-6)
        at = batches[f"/robot/{name}/ball\\ tip"]
        np.testing.assert_allclose(
            [row[0] for row in column(at, "Transform3D:translation").to_pylist()], positions, atol=1e-6
        )
        assert [row.total_seconds() for row in column(at, "time").to_pylist()] == [0.0, 0.1, 0.3]
        assert column(batches[f"/robot/{name}/name"], "Points3D:labels").to_pylist() == [[title]]
        angle = [row[0] for row in column(batches[f"/angles/{name}/bone1_x"], "Scalars:scalars").to_pylist()]
        assert angle == pytest.approx([arm.angles(one)["bone1_x"] for one in own])
        apart.append(column(batches[f"/robot/{name}"], "Transform3D:translation").to_pylist()[0][0][1])
    assert apart[0] == pytest.approx(-apart[1])
    assert apart[0] < -0.1


def test_another_ending_is_refused(arm, tmp_path):
    with pytest.raises(pinik.InputError, match=r"must end with '\.rrd'"):
        save_rrd(arm, tmp_path / "arm.glb")
