"""A robot's shapes as meshcat commands, against the shapes that were read."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
import trimesh
import umsgpack

import pinik
from pinik.shapes.meshes import load_shapes
from pinik.viewer.protocol.robot_message import robot_message
from pinik.viewer.web.scene import collision_shapes, make_shapes, meshcat_script
from robots import load_quietly
from urdf_texts import joint, link, robot


def decoded(command):
    """A command as three.js would hold it: message, vertices (n, 3), normals (n, 3), faces (m, 3), all in detail."""
    message, vertices, normals, faces = everything(command)
    begins = message["object"]["geometries"][0]["userData"]
    fine, first = begins["fine"] // 3 or len(faces), begins["first"] or len(vertices)
    return message, vertices[:first], normals[:first], faces[:fine]


def everything(command):
    """The same, with the mesh of few triangles that may follow."""
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


@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_a_robot_of_many_triangles_brings_the_same_surface_with_few_of_them(name):
    fine_count = coarse_count = 0
    for command in make_shapes(load_quietly(name)).commands:
        message, vertices, normals, faces = everything(command)
        begins = message["object"]["geometries"][0]["userData"]
        assert faces.max() < len(vertices)
        fine_count += begins["fine"] // 3 or len(faces)
        coarse = faces[begins["fine"] // 3 :]
        coarse_count += len(coarse)
        if not begins["fine"]:
            continue
        assert coarse.min() >= begins["first"] > faces[: begins["fine"] // 3].max()
        np.testing.assert_allclose(np.linalg.norm(normals[begins["first"] :], axis=1), 1.0, atol=1e-5)
        before = vertices[: begins["first"]]
        after = vertices[np.unique(coarse)]
        _, away, _ = trimesh.proximity.closest_point_naive(
            trimesh.Trimesh(before, faces[: begins["fine"] // 3]), after[::7]
        )
        assert away.max() < 0.006  # [m]; both robots are larger than a metre
        least = 0.05 * np.linalg.norm(np.ptp(before, axis=0))
        np.testing.assert_allclose(after.min(axis=0), before.min(axis=0), atol=least)
        np.testing.assert_allclose(after.max(axis=0), before.max(axis=0), atol=least)
    assert fine_count > 80_000
    assert coarse_count < 30_000


def test_a_robot_of_few_triangles_brings_no_others():
    for command in make_shapes(load_quietly("arm")).commands:
        message, *_ = everything(command)
        assert message["object"]["geometries"][0]["userData"] == {"fine": 0, "first": 0}


def test_collision_shapes_are_sent_in_detail_alone():
    shapes = collision_shapes(load_quietly("kinova"))
    assert shapes.commands
    for command in shapes.commands:
        message, *_ = everything(command)
        assert message["object"]["geometries"][0]["userData"] == {"fine": 0, "first": 0}


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
    [("1 0.5 0 1", 0xFF8000, 1.0), ("0.2 0.4 0.6 0.25", 0x336699, 0.25), ("7 -1 0 3", 0xB2B2B2, 1.0)],
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
