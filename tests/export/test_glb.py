"""Files of moving robots, read again by pygltflib and by trimesh, and compared with plain Pinocchio."""

from __future__ import annotations

import io
import struct

import numpy as np
import pygltflib
import pytest
import trimesh

import pinik
from pinik.export.glb import save_glb
from pinik.shapes.meshes import load_shapes
from urdf_texts import chain

UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # from z up to y up


@pytest.fixture(scope="module")
def arm():
    return pinik.load("arm")


@pytest.fixture(scope="module")
def track(arm):
    q = arm.random(2)
    here = arm.placement("tip", q).translation
    places = here + np.array([[0.0, 0.002 * k, 0.0] for k in range(5)])
    return pinik.track(arm, "tip", places, q0=q, times=[0.0, 0.5, 0.75, 1.0, 2.0])


def numbers(document, index):
    """The numbers of an accessor."""
    accessor = document.accessors[index]
    view = document.bufferViews[accessor.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
    begin = view.byteOffset
    content = document.binary_blob()[begin : begin + view.byteLength]
    letter = {5126: "f", 5125: "I"}[accessor.componentType]
    return np.array(struct.unpack(f"<{accessor.count * width}{letter}", content)).reshape(accessor.count, width)


def matrix(x, y, z, w):
    """A rotation from a quaternion, written out."""
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def test_every_key_of_a_track_is_where_pinocchio_puts_the_link(arm, track, tmp_path):
    save_glb(track, tmp_path / "track.glb")
    document = pygltflib.GLTF2().load(str(tmp_path / "track.glb"))
    (animation,) = document.animations
    seen = set()
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        np.testing.assert_allclose(numbers(document, sampler.input).ravel(), track.times)
        link = document.nodes[channel.target.node].name
        for q, row in zip(track.q, numbers(document, sampler.output), strict=True):
            there = arm.placement(link, q)
            if channel.target.path == "translation":
                np.testing.assert_allclose(row, there.translation, atol=1e-6)
            else:
                np.testing.assert_allclose(matrix(*row), there.rotation, atol=1e-6)
        seen.add((link, channel.target.path))
    with_shapes = {link.name for link in arm.description.link_tags if link.visuals}
    assert seen == {(link, path) for link in with_shapes for path in ("translation", "rotation")}


def test_rotations_never_take_the_long_way(arm, tmp_path):
    q = np.array([arm.random(7)] * 200)
    q[:, 0] = np.linspace(arm.lower_q[0], arm.upper_q[0], 200)
    save_glb(arm, tmp_path / "turn.glb", q)
    document = pygltflib.GLTF2().load(str(tmp_path / "turn.glb"))
    (animation,) = document.animations
    for channel in animation.channels:
        if channel.target.path == "rotation":
            turns = numbers(document, animation.samplers[channel.sampler].output)
            assert (np.sum(turns[1:] * turns[:-1], axis=1) > 0.0).all()


def test_trimesh_reads_a_solution_with_every_vertex_where_the_robot_has_it(arm, tmp_path):
    place = arm.placement("tip", arm.random(5)).translation
    solution = arm.solve("tip", position=place)
    save_glb(solution, tmp_path / "solution.glb")
    read = trimesh.load(io.BytesIO((tmp_path / "solution.glb").read_bytes()), file_type="glb").to_geometry()
    corners = []
    for shape in load_shapes(arm)[0]:
        whole = arm.placement(shape.link, solution.q).homogeneous @ shape.placement
        corners.append((shape.mesh.vertices @ whole[:3, :3].T + whole[:3, 3]) @ UP.T)
    whole = np.concatenate(corners)
    np.testing.assert_allclose(read.bounds, [whole.min(axis=0), whole.max(axis=0)], atol=1e-5)
    assert pygltflib.GLTF2().load(str(tmp_path / "solution.glb")).animations == []


def test_what_cannot_be_written_is_refused_in_words(arm, track, tmp_path):
    with pytest.raises(pinik.InputError, match=r"must end with '\.glb'"):
        save_glb(track, tmp_path / "track.gltf")
    with pytest.raises(pinik.InputError, match="must increase"):
        save_glb(track, tmp_path / "a.glb", times=[0, 1, 1, 2, 3])
    with pytest.raises(pinik.InputError, match="q must be left out"):
        save_glb(track, tmp_path / "a.glb", track.q)
    with pytest.raises(pinik.InputError, match="must be a robot, a solution"):
        save_glb("arm", tmp_path / "a.glb")
    with pytest.raises(pinik.InputError, match="no visual shapes"):
        save_glb(pinik.load(chain(3, "revolute")), tmp_path / "a.glb")
    assert list(tmp_path.iterdir()) == []
