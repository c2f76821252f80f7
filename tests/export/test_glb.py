"""Files of moving robots, played by glTF's rules and read by trimesh, and compared with plain Pinocchio."""

from __future__ import annotations

import io
import itertools

import numpy as np
import pinocchio
import pytest
import trimesh
from PIL import Image

import pinik
from glb_player import FROM_GLTF, Player, matrix
from pinik.export.glb import save_glb
from pinik.export.live_recording import LiveRecording, RecordedBall
from pinik.export.surfaces import cleaned
from pinik.picture.solids import Solid
from pinik.shapes.meshes import load_shapes
from robots import load_quietly
from urdf_texts import chain


@pytest.fixture(scope="module")
def arm():
    return pinik.load("arm")


@pytest.fixture(scope="module")
def track(arm):
    q = arm.random(2)
    here = arm.placement("tip", q).translation
    places = here + np.array([[0.0, 0.002 * k, 0.0] for k in range(5)])
    return pinik.track(arm, "tip", places, q0=q, times=[5.0, 5.5, 5.75, 6.0, 7.0])


def plain(robot, q, link):
    """Where plain Pinocchio puts a link (4, 4)."""
    data = robot.model.createData()
    pinocchio.framesForwardKinematics(robot.model, data, q)
    return data.oMf[robot.model.getFrameId(link)].homogeneous


def test_every_link_is_where_pinocchio_puts_it_at_every_key_of_a_track(arm, track, tmp_path):
    save_glb(track, tmp_path / "track.glb")
    played = Player(tmp_path / "track.glb")
    for q, time in zip(track.q, track.times, strict=True):
        for link in arm.description.links:
            np.testing.assert_allclose(played.place(link, time - 5.0), plain(arm, q, link), atol=1e-6)
    for times, _ in played.tracks.values():
        np.testing.assert_allclose(times, [0.0, 0.5, 0.75, 1.0, 2.0])


def test_joints_move_evenly_between_keys_even_where_they_turn_far(tmp_path):
    panda = pinik.load("panda")
    q = np.array([panda.lower_q, panda.upper_q, panda.poses["default"]])
    assert np.abs(np.diff(q, axis=0)).max() > 5.0
    save_glb(panda, tmp_path / "far.glb", q, times=[1.0, 2.0, 4.0])
    played = Player(tmp_path / "far.glb")
    assert played.duration == pytest.approx(3.0)
    for time in np.linspace(0.0, 3.0, 31):
        now = q[0] + time * (q[1] - q[0]) if time < 1.0 else q[1] + (time - 1.0) / 2.0 * (q[2] - q[1])
        for link in panda.description.links:
            np.testing.assert_allclose(played.place(link, time), plain(panda, now, link), atol=2e-6)


GEARED = """<robot name="geared"><link name="base"/>
<link name="slow"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link><link name="fast"/>
<joint name="leader" type="revolute"><parent link="base"/><child link="slow"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="follower" type="continuous"><parent link="base"/><child link="fast"/><axis xyz="0 0 1"/>
  <mimic joint="leader" multiplier="-4"/></joint></robot>"""


def test_a_follower_that_turns_farther_than_its_leader_goes_the_whole_way(tmp_path):
    robot = pinik.load(GEARED)
    save_glb(robot, tmp_path / "geared.glb", [[0.0], [0.9]], times=[0.0, 1.0])
    played = Player(tmp_path / "geared.glb")
    for time in np.linspace(0.0, 1.0, 11):
        for link in ("slow", "fast"):
            expected = plain(robot, np.array([0.9 * time]), link)
            np.testing.assert_allclose(played.place(link, time), expected, atol=2e-6)


def test_a_free_root_moves_its_first_link(tmp_path):
    lion = load_quietly("lion", root="free_flyer")
    q = np.array([lion.random(k) for k in range(3)])
    save_glb(lion, tmp_path / "lion.glb", q)
    played = Player(tmp_path / "lion.glb")
    for k in range(3):
        for link in lion.description.links:
            np.testing.assert_allclose(played.place(link, k / 30), plain(lion, q[k], link), atol=1e-5)


def test_what_does_not_move_has_no_keys(arm, tmp_path):
    q = np.array([arm.neutral()] * 3)
    last = arm.joint_names[-1]
    q[:, arm.joint(last).idx_q] = [0.0, 0.1, 0.3]
    save_glb(arm, tmp_path / "wrist.glb", q)
    (child,) = [joint.child for joint in arm.description.joints if joint.name == last]
    assert set(Player(tmp_path / "wrist.glb").tracks) == {(child, "rotation")}


def test_rotations_never_take_the_long_way(arm, tmp_path):
    q = np.array([arm.random(7)] * 200)
    q[:, 0] = np.linspace(arm.lower_q[0], arm.upper_q[0], 200)
    save_glb(arm, tmp_path / "turn.glb", q)
    for (_, path), (_, rows) in Player(tmp_path / "turn.glb").tracks.items():
        if path == "rotation":
            assert (np.sum(rows[1:] * rows[:-1], axis=1) > 0.0).all()


def corners(robot, q):
    """Every vertex of a robot's shapes (n, 3), in the world."""
    found = []
    for shape in load_shapes(robot)[0]:
        whole = plain(robot, q, shape.link) @ shape.placement
        found.append(shape.mesh.vertices @ whole[:3, :3].T + whole[:3, 3])
    return np.vstack(found)


def test_trimesh_reads_a_solution_with_every_vertex_where_the_robot_has_it(arm, tmp_path):
    place = arm.placement("tip", arm.random(5)).translation
    solution = arm.solve("tip", position=place)
    save_glb(solution, tmp_path / "solution.glb")
    read = trimesh.load(io.BytesIO((tmp_path / "solution.glb").read_bytes()), file_type="glb").to_geometry()
    there = corners(arm, solution.q) @ FROM_GLTF[:3, :3]
    np.testing.assert_allclose(read.bounds, [there.min(axis=0), there.max(axis=0)], atol=1e-5)
    assert Player(tmp_path / "solution.glb").document.animations == []


def test_colours_are_those_of_the_file_once_light_is_sRGB_again(tmp_path):
    panda = pinik.load("panda")
    save_glb(panda, tmp_path / "panda.glb")
    document = Player(tmp_path / "panda.glb").document
    by_name = {mesh.name: document.materials[mesh.primitives[0].material] for mesh in document.meshes}
    for shape in load_shapes(panda)[0]:
        material = by_name[shape.name.replace("/", " ")]
        linear = np.array(material.pbrMetallicRoughness.baseColorFactor)
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
        np.testing.assert_allclose(srgb[:3], shape.color[:3], atol=1e-6)
        assert linear[3] == pytest.approx(shape.color[3])
        assert material.name == "#" + bytes(round(255 * part) for part in shape.color[:3]).hex()


def test_every_corner_is_used_and_has_a_unit_normal_as_the_specification_demands(arm, tmp_path):
    """Though the arm's own meshes have triangles without area."""
    assert any((np.linalg.norm(shape.mesh.vertex_normals, axis=1) < 0.5).any() for shape in load_shapes(arm)[0])
    save_glb(arm, tmp_path / "arm.glb")
    read = Player(tmp_path / "arm.glb")
    for mesh in read.document.meshes:
        for primitive in mesh.primitives:
            normals = read.numbers(primitive.attributes.NORMAL)
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)
            faces = read.numbers(primitive.indices).ravel()
            assert set(faces) == set(range(len(normals)))


def test_a_corner_without_a_normal_gets_that_of_its_face():
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [9.0, 9.0, 9.0], [2.0, 0.0, 0.0]])
    normals = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    clean = cleaned(Solid(corners, normals, np.array([[0, 1, 2], [0, 1, 4]])))
    np.testing.assert_array_equal(clean.vertices, corners[:3])
    np.testing.assert_array_equal(clean.normals, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_array_equal(clean.faces, [[0, 1, 2]])


# Recordings of a live view


@pytest.fixture(scope="module")
def recorded(arm):
    """Two arms with one method each, and a third with the first one's again; one ball asks for an orientation."""
    q = np.array([[arm.random(10 * i + k) for k in range(4)] for i in range(3)])
    turns = np.array([pinocchio.Quaternion(pinocchio.rpy.rpyToMatrix(0.0, 0.3 * k, 0.0)).coeffs() for k in range(4)])
    balls = (
        RecordedBall("tip", np.array([[0.5, 0.1 * k, 0.6] for k in range(4)]), turns, False, True),
        RecordedBall("elbow", np.tile([0.2, 0.3, 0.4], (4, 1)), np.tile([0.0, 0.0, 0.0, 1.0], (4, 1)), True, False),
    )
    solvers = (pinik.CCD(), pinik.DampedLeastSquares(), pinik.CCD(relaxation=0.5))
    return LiveRecording(arm, solvers, np.array([0.0, 0.1, 0.2, 0.4]), q, balls)


@pytest.fixture(scope="module")
def stage(recorded, tmp_path_factory):
    path = tmp_path_factory.mktemp("stage") / "stage.glb"
    save_glb(recorded, path)
    return Player(path)


def test_every_robot_of_a_recording_moves_below_the_name_of_its_method(arm, recorded, stage):
    assert recorded.names == ["ccd", "dls", "ccd 2"]
    assert {name for name in stage.names if stage.names.count(name) > 1} == set()
    for name, q in zip(recorded.names, recorded.q, strict=True):
        for time, now in zip(recorded.times, q, strict=True):
            for link in arm.description.links:
                found = stage.place(f"{name} {link}", time, above=name)
                np.testing.assert_allclose(found, plain(arm, now, link), atol=1e-6)
    assert stage.duration == pytest.approx(0.4)


def test_robots_stand_side_by_side_and_never_touch_their_neighbours(arm, recorded, stage):
    ends = []
    for name, q in zip(recorded.names, recorded.q, strict=True):
        at = stage.place(name, 0.0)
        np.testing.assert_allclose(at[:3, :3], np.eye(3), atol=1e-7)
        across = np.concatenate([corners(arm, one)[:, 1] for one in q]) + at[1, 3]
        ends.append((across.min(), across.max()))
    assert ends == sorted(ends)
    assert all(before[1] < after[0] for before, after in itertools.pairwise(ends))
    to_the_right = np.array([0.0, 1.0, 0.0]) @ FROM_GLTF[:3, :3]  # for somebody who looks at them along glTF's -z
    np.testing.assert_allclose(to_the_right, [1.0, 0.0, 0.0])


def test_each_robot_has_its_balls_that_move(recorded, stage):
    for name in recorded.names:
        for ball in recorded.balls:
            for time, position, turn in zip(recorded.times, ball.positions, ball.quat_xyzw, strict=True):
                found = stage.place(f"{name} ball {ball.frame}", time, above=name)
                np.testing.assert_allclose(found[:3, 3], position, atol=1e-6)
                np.testing.assert_allclose(found[:3, :3], matrix(*turn), atol=1e-6)
    meshes = {node.name: stage.document.meshes[node.mesh] for node in stage.document.nodes if node.mesh is not None}
    colors = {
        name: [stage.document.materials[one.material].name for one in meshes[f"dls ball {name}"].primitives]
        for name in ("tip", "elbow")
    }
    assert colors == {"tip": ["#d81f2f", "#e5484d", "#3d9a50", "#3b7ddd"], "elbow": ["#3c4654"]}


def test_a_plate_in_front_of_each_robot_says_its_method(arm, recorded, stage):
    document = stage.document
    lowest = min(corners(arm, q[0])[:, 2].min() for q in recorded.q)
    for k, name in enumerate(recorded.names):
        (node,) = [node for node in document.nodes if node.name == f"{name} name"]
        mesh = document.meshes[node.mesh]
        assert mesh.name == ("ccd, ω = automatic", "Damped least squares", "ccd, ω = 0.5")[k]
        vertices = stage.numbers(mesh.primitives[0].attributes.POSITION)
        faces = stage.numbers(mesh.primitives[0].indices).reshape(-1, 3)
        outward = np.cross(vertices[faces[0, 1]] - vertices[faces[0, 0]], vertices[faces[0, 2]] - vertices[faces[0, 0]])
        assert outward[0] > 0.0  # it faces forward
        assert outward[2] > 0.0  # and leans back
        own = vertices + node.translation
        assert own[:, 2].min() == pytest.approx(lowest, abs=1e-5)
        assert own[:, 0].min() > max(corners(arm, q)[:, 0].max() for q in recorded.q[k])
        texture = document.materials[mesh.primitives[0].material].pbrMetallicRoughness.baseColorTexture
        image = Image.open(io.BytesIO(stage.bytes(document.images[document.textures[texture.index].source].bufferView)))
        color = ("#1f6fc4", "#d97a00", "#0c9a72")[k]
        assert image.getpixel((0, 0)) == tuple(bytes.fromhex(color[1:]))
        wide, high = np.ptp(own[:, 1]), np.linalg.norm(own[3] - own[0])
        assert wide / high == pytest.approx(image.width / image.height, rel=1e-4)
        # The corner of the vertices that is left and low for somebody in front of it is left and low in the picture.
        low_left = np.argmin(own[:, 1] + own[:, 2])
        assert stage.numbers(mesh.primitives[0].attributes.TEXCOORD_0)[low_left].tolist() == [0.0, 1.0]


@pytest.fixture
def arm_on_show(arm):
    with pinik.live(arm, port=0) as view:
        yield view


def test_what_cannot_be_written_is_refused_in_words(arm, arm_on_show, track, tmp_path):
    with pytest.raises(pinik.InputError, match=r"must end with '\.glb'"):
        save_glb(track, tmp_path / "track.gltf")
    for wrong in (5, None, b"a.glb"):
        with pytest.raises(pinik.InputError, match=r"path must be the name of a file, such as 'robot\.glb'; got"):
            save_glb(track, wrong)
    with pytest.raises(pinik.InputError, match="must increase"):
        save_glb(track, tmp_path / "a.glb", times=[0, 1, 1, 2, 3])
    with pytest.raises(pinik.InputError, match="q must be left out"):
        save_glb(track, tmp_path / "a.glb", track.q)
    with pytest.raises(pinik.InputError, match="must be a robot, a solution"):
        save_glb("arm", tmp_path / "a.glb")
    with pytest.raises(pinik.InputError, match=r"must be .* the recording\(\) of a live view; got .* 'LiveView'"):
        save_glb(arm_on_show, tmp_path / "a.glb")
    with pytest.raises(pinik.InputError, match="got an object of type 'Branches'"):
        save_glb(arm.solve_all("tip", position=arm.placement("tip", arm.random(2)).translation), tmp_path / "a.glb")
    with pytest.raises(pinik.InputError, match="no visual shapes"):
        save_glb(pinik.load(chain(3, "revolute")), tmp_path / "a.glb")
    assert list(tmp_path.iterdir()) == []
