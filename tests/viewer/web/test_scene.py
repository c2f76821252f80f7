"""What the page gets of a robot: its message, its shapes as meshcat commands, and frames."""

from __future__ import annotations

import json
import math
import struct
import subprocess
import sys

import numpy as np
import pinocchio
import pytest
import trimesh
import umsgpack

import by_hand
import pinik
from pinik.shapes.meshes import load_shapes
from pinik.viewer.web.scene import (
    InstanceBlock,
    JointPlacements,
    make_shapes,
    meshcat_script,
    pack_frame,
    robot_message,
)
from robots import load_quietly
from urdf_texts import joint, link, robot

ROBOTS = [
    ("panda", "fixed"),  # two fingers, one of which mimics the other
    ("lion", "free_flyer"),
    ("tiago", "planar"),  # continuous joints
    ("hector", "fixed"),  # nothing moves: nq = 0
    (by_hand.ZOO, "fixed"),
]


def matrix(seven):
    """4×4 from x, y, z, qx, qy, qz, qw, written out."""
    x, y, z, i, j, k, r = seven
    rotation = [
        [1 - 2 * (j * j + k * k), 2 * (i * j - k * r), 2 * (i * k + j * r)],
        [2 * (i * j + k * r), 1 - 2 * (i * i + k * k), 2 * (j * k - i * r)],
        [2 * (i * k - j * r), 2 * (j * k + i * r), 1 - 2 * (i * i + j * j)],
    ]
    return by_hand.homogeneous(np.array(rotation), (x, y, z))


def decoded(command):
    """A command as three.js would hold it: message, vertices (n, 3), normals (n, 3), faces (m, 3)."""
    message = umsgpack.unpackb(command)
    (geometry,) = message["object"]["geometries"]
    assert geometry["type"] == "BufferGeometry"
    arrays = []
    for attribute, name, code, kind in (
        (geometry["data"]["attributes"]["position"], "Float32Array", 0x17, "<f4"),
        (geometry["data"]["attributes"]["normal"], "Float32Array", 0x17, "<f4"),
        (geometry["data"]["index"], "Uint32Array", 0x16, "<u4"),
    ):
        assert (attribute["type"], attribute["itemSize"], attribute["array"].type) == (name, 3, code)
        arrays.append(np.frombuffer(attribute["array"].data, kind).reshape(-1, 3))
    return message, *arrays


def hex_color(color):
    return int("".join(f"{round(255 * channel):02x}" for channel in color[:3]), 16)


@pytest.mark.parametrize("name", ["panda", "arm", "lion"])
def test_every_triangle_arrives_in_its_links_frame_and_colour(name):
    wanted = {}
    for shape in load_shapes(load_quietly(name))[0]:
        corners = trimesh.transform_points(shape.mesh.vertices, shape.placement)[shape.mesh.faces]
        normals = (shape.mesh.vertex_normals @ shape.placement[:3, :3].T)[shape.mesh.faces]
        wanted.setdefault((shape.link, hex_color(shape.color), shape.color[3]), []).append((corners, normals))
    shapes = make_shapes(load_quietly(name))
    links = [found["name"] for found in robot_message(load_quietly(name), 1)["links"]]
    assert len(shapes.parts) == len(shapes.commands) == len(wanted)
    for (index, path), command in zip(shapes.parts, shapes.commands, strict=True):
        message, vertices, normals, faces = decoded(command)
        (material,) = message["object"]["materials"]
        corners, wanted_normals = map(
            np.concatenate, zip(*wanted.pop((links[index], material["color"], material["opacity"])), strict=True)
        )
        assert message["path"] == path
        np.testing.assert_allclose(vertices[faces], corners, atol=1e-6)
        np.testing.assert_allclose(normals[faces], wanted_normals, atol=1e-6)
    assert wanted == {}


def boxes(*visuals):
    return load_quietly(robot(link("base"), link("box", *visuals), joint("hinge", "base", "box")))


def box(color, xyz="0 0 0", size="2 2 2"):
    return (
        f'<visual><origin xyz="{xyz}"/><geometry><box size="{size}"/></geometry>'
        f'<material name=""><color rgba="{color}"/></material></visual>'
    )


def test_one_link_gets_one_part_a_colour():
    shapes = make_shapes(boxes(box("1 0 0 1"), box("0 1 0 1", "5 0 0"), box("1 0 0 1", "0 0 3", "2 4 6")))
    assert shapes.parts == ((1, "/pinik/shapes/1/0"), (1, "/pinik/shapes/1/1"))
    _, red, _, faces = decoded(shapes.commands[0])
    assert len(faces) == 24
    np.testing.assert_allclose([red.min(axis=0), red.max(axis=0)], [[-1, -2, -1], [1, 2, 6]], atol=1e-6)
    _, green, _, _ = decoded(shapes.commands[1])
    np.testing.assert_allclose([green.min(axis=0), green.max(axis=0)], [[4, -1, -1], [6, 1, 1]], atol=1e-6)


def test_vertices_with_the_same_place_and_normal_are_one(tmp_path):
    # A square of two triangles that share nothing, as many exporters write it.
    (tmp_path / "square.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn -0.0 0 1\n"
        "f 1//1 2//1 3//1\nf 4//2 5//2 6//2\n"
    )
    square = '<visual><geometry><mesh filename="square.obj"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(robot(link("base", square)))
    _, vertices, normals, faces = decoded(make_shapes(pinik.load(tmp_path / "r.urdf")).commands[0])
    assert sorted(vertices.tolist()) == [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]
    assert normals.tolist() == [[0, 0, 1]] * 4
    assert vertices[faces].tolist() == [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]]
    _, corners, _, _ = decoded(make_shapes(boxes(box("1 1 1 1"))).commands[0])
    assert len(corners) == 24  # an edge stays sharp: eight corners with three normals each


@pytest.mark.parametrize(
    ("rgba", "color", "opacity"),
    [("1 0.5 0 1", 0xFF8000, 1.0), ("0.2 0.4 0.6 0.25", 0x336699, 0.25), ("7 -1 0 3", 0xFF0000, 1.0)],
)
def test_a_part_has_its_colour_and_lets_light_through_where_it_should(rgba, color, opacity):
    message, *_ = decoded(make_shapes(boxes(box(rgba))).commands[0])
    (material,) = message["object"]["materials"]
    assert material["type"] == "MeshStandardMaterial"
    assert (material["color"], material["opacity"]) == (color, opacity)
    assert material["transparent"] is (opacity < 1)


def test_a_command_is_a_whole_object_of_three_js_and_the_same_each_time():
    shapes = make_shapes(boxes(box("1 0 0 1")))
    message, *_ = decoded(shapes.commands[0])
    (geometry,), (material,), mesh = (message["object"][key] for key in ("geometries", "materials", "object"))
    assert message["type"] == "set_object"
    assert message["object"]["metadata"] == {"version": 4.5, "type": "Object"}
    assert (mesh["type"], mesh["geometry"], mesh["material"]) == ("Mesh", geometry["uuid"], material["uuid"])
    assert len({geometry["uuid"], material["uuid"], mesh["uuid"]}) == 3
    assert shapes == make_shapes(boxes(box("1 0 0 1")))
    # The page tells commands from frames by the first byte; 0x80 to 0x8f begin a small map.
    assert 0x80 <= shapes.commands[0][0] <= 0x8F


def test_what_cannot_be_read_is_told_and_the_rest_is_there():
    lost = '<visual><geometry><mesh filename="lost.stl"/></geometry></visual>'
    shapes = make_shapes(boxes(lost, box("1 0 0 1")))
    assert len(shapes.parts) == 1
    message = json.loads(json.dumps(shapes.message(7)))
    assert message["parts"] == [{"link": 1, "path": "/pinik/shapes/1/0"}]
    assert (message["type"], message["generation"]) == ("shapes", 7)
    assert "lost.stl" in message["warnings"][0]


def test_meshcats_viewer_is_found_without_importing_meshcat():
    code = (
        "import sys; from pinik.viewer.web import scene; scene.meshcat_script(); "
        "print(*{'meshcat', 'zmq', 'IPython', 'trimesh', 'scipy'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
    assert "MeshCat" in meshcat_script().read_text()


def test_a_missing_viewer_is_an_error_that_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    monkeypatch.delitem(sys.modules, "meshcat", raising=False)
    with pytest.raises(pinik.PinikError, match="pip install 'meshcat"):
        meshcat_script()
    (tmp_path / "meshcat").mkdir()
    (tmp_path / "meshcat" / "__init__.py").touch()
    with pytest.raises(pinik.PinikError, match="pip install 'meshcat"):
        meshcat_script()


@pytest.mark.parametrize(("source", "root"), ROBOTS)
def test_each_link_is_at_its_joint_in_the_frame_and_its_place_in_the_message(source, root):
    model = load_quietly(source, root=root)
    message = json.loads(json.dumps(robot_message(model, 3), allow_nan=False))
    placements = JointPlacements(model)
    assert [found["name"] for found in message["links"]] == list(model.description.links)
    for seed in range(5):
        q = model.random(seed)
        joints = placements.at(q)
        assert joints.shape == (len(message["joints"]), 7)
        assert joints[0].tolist() == [0, 0, 0, 0, 0, 0, 1]
        for found in message["links"]:
            placed = matrix(joints[found["joint"]]) @ matrix(found["placement"])
            np.testing.assert_allclose(placed, model.placement(found["name"], q).homogeneous, atol=1e-9)


def test_all_kinds_of_joints_are_where_matrices_by_hand_put_them():
    model = load_quietly(by_hand.ZOO)
    message = robot_message(model, 1)
    angles = {"k_turn": 4.0, "l_hinge": -0.7, "m_slide": 0.3}
    rng = np.random.default_rng(0)
    loose = {"drift": by_hand.random_placement(rng), "s_plane": by_hand.random_placement(rng, "planar")}
    joints = JointPlacements(model).at(model.configuration(angles, loose))
    wanted = by_hand.link_placements(by_hand.ZOO, angles, loose)
    for found in message["links"]:
        placed = matrix(joints[found["joint"]]) @ matrix(found["placement"])
        np.testing.assert_allclose(placed, wanted[found["name"]], atol=1e-9)
    kinds = {found["name"]: found["kind"] for found in message["joints"]}
    assert kinds == {
        "universe": "fixed", "drift": "floating", "k_turn": "continuous", "l_hinge": "revolute",
        "m_slide": "prismatic", "s_plane": "planar", "t_hinge": "revolute", "u_slide": "prismatic",
        "v_turn": "continuous", "w_hinge": "revolute",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["panda", "lion", "hector"])
def test_with_every_angle_zero_joints_hang_together_by_their_placements(name):
    model = load_quietly(name)
    found = robot_message(model, 1)["joints"]
    at_zero = JointPlacements(model).at(model.neutral())
    for index, each in enumerate(found[1:], start=1):
        placed = matrix(at_zero[each["parent"]]) @ matrix(each["placement"])
        np.testing.assert_allclose(placed, matrix(at_zero[index]), atol=1e-9)
        assert each["parent"] < index


def test_two_of_one_robot_do_not_disturb_each_other(panda):
    one, other = JointPlacements(panda), JointPlacements(panda)
    frames = [panda.frame_id("panda_hand_tcp"), panda.frame_id("panda_link3")]
    q, q2 = panda.random(1), panda.random(2)
    first = one.at(q)
    kept = first.copy()
    other.at(q2)
    pinocchio.forwardKinematics(panda.model, panda.data, q2)
    points = one.points(frames)
    np.testing.assert_array_equal(first, kept)
    np.testing.assert_allclose(points[0], panda.placement("panda_hand_tcp", q).translation, atol=1e-12)
    np.testing.assert_allclose(points[1], panda.placement("panda_link3", q).translation, atol=1e-12)
    kept = points.copy()
    one.at(q2)
    one.points(frames)
    np.testing.assert_array_equal(points, kept)
    assert one.points([]).shape == (0, 3)


def test_the_message_of_a_small_robot():
    message = robot_message(pinik.load("two_link"), 4)
    assert message == {
        "type": "robot",
        "generation": 4,
        "name": "two_link",
        "root": "fixed",
        "joints": [
            {"name": "universe", "parent": 0, "kind": "fixed", "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "joint1", "parent": 0, "kind": "revolute", "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "joint2", "parent": 1, "kind": "revolute", "placement": [0.5, 0, 0, 0, 0, 0, 1]},
        ],
        "links": [
            {"name": "base", "joint": 0, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "link1", "joint": 1, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "link2", "joint": 2, "placement": [0, 0, 0, 0, 0, 0, 1]},
            {"name": "tip", "joint": 2, "placement": [0.4, 0, 0, 0, 0, 0, 1]},
        ],
        "frames": ["tip", "link1", "link2"],
        "size": 0.9,
        "warnings": [],
    }


def test_size_is_the_longest_way_along_the_joints():
    crane = robot(
        *(link(name) for name in ("base", "mast", "trolley", "hook", "stub")),
        joint("turn", "base", "mast", by_hand.origin((0, 3, 4))),
        joint("ride", "mast", "trolley", by_hand.origin((1, 0, 0)), kind="prismatic", limit=by_hand.limit(-0.5, 2)),
        joint("rope", "trolley", "hook", by_hand.origin((0, 0, -6)), kind="fixed", limit=""),
        joint("side", "base", "stub", by_hand.origin((0, 0, 1))),
    )
    assert robot_message(pinik.load(crane), 1)["size"] == pytest.approx(5 + 1 + 2 + 6)
    assert robot_message(load_quietly("arm"), 1)["size"] == pytest.approx(1.32)
    assert robot_message(pinik.load(robot(link("alone"))), 1)["size"] == 1


def test_frames_are_what_moves_with_the_ends_first(panda):
    frames = robot_message(panda, 1)["frames"]
    assert frames[:3] == ["panda_hand_tcp", "panda_leftfinger", "panda_rightfinger"]
    assert set(frames) == {link for link in panda.description.links if link != "panda_link0"}
    assert len(frames) == len(set(frames))
    assert set(frames) <= set(panda.frame_names)
    assert "panda_link0" in robot_message(load_quietly("panda", root="free_flyer"), 1)["frames"]
    assert robot_message(pinik.load(robot(link("alone"))), 1)["frames"] == ["alone"]


def test_warnings_of_loading_are_passed_on():
    urdf = robot(link("a"), link("b"), joint("j", "a", "b", by_hand.mimic("nobody")))
    with pytest.warns(pinik.UrdfWarning):
        model = pinik.load(urdf)
    assert robot_message(model, 1)["warnings"] == list(model.warnings) != []


def test_a_frame_is_laid_out_as_the_protocol_says():
    balls = np.arange(14.0).reshape(2, 7)
    blocks = [
        InstanceBlock(
            figures=[1, 0.5, math.nan, 0.001, 3, 21, 0.25, 1],
            joints=np.full((3, 7), 10.0) + np.arange(3)[:, None],
            sides=np.array([0, -1, 2]),
            points=np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]),
        ),
        InstanceBlock(np.zeros(8), np.zeros((3, 7)), np.zeros(3), np.zeros((2, 3))),
    ]
    frame = pack_frame(7, 1234, balls, blocks)
    assert frame[:4] == b"PNKF"
    numbers = struct.unpack(f"<{(len(frame) - 4) // 4}f", frame[4:])
    assert numbers[:5] == (7, 1234, 2, 3, 2)
    assert numbers[5:19] == tuple(range(14))
    block = numbers[19 : 19 + 8 + 21 + 3 + 6]
    assert block[:2] == (1, 0.5)
    assert math.isnan(block[2])
    assert block[3:8] == pytest.approx((0.001, 3, 21, 0.25, 1))
    assert block[8:29] == (10,) * 7 + (11,) * 7 + (12,) * 7
    assert block[29:32] == (0, -1, 2)
    assert block[32:] == pytest.approx((0.1, 0.2, 0.3, 0.4, 0.5, 0.6))
    assert numbers[19 + 38 :] == (0,) * 38


def test_a_frame_without_instances_or_balls_is_only_its_header():
    assert pack_frame(1, 2, np.zeros((0, 7)), []) == b"PNKF" + struct.pack("<5f", 1, 2, 0, 0, 0)


@pytest.mark.parametrize(
    ("figures", "joints", "points"), [(7, 3, 1), (8, 4, 1), (8, 3, 2)], ids=["figures", "joints", "points"]
)
def test_instances_that_do_not_fit_together_are_refused(figures, joints, points):
    good = InstanceBlock(np.zeros(8), np.zeros((3, 7)), np.zeros(3), np.zeros((1, 3)))
    bad = InstanceBlock(np.zeros(figures), np.zeros((joints, 7)), np.zeros(joints), np.zeros((points, 3)))
    with pytest.raises(ValueError, match="alike"):
        pack_frame(1, 1, np.zeros((1, 7)), [good, bad])
