"""A robot's shapes: where they are, how large, and in which colours."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

import pinik
from pinik.shapes.meshes import load_shapes

URDF = Path(__file__).parents[2] / "urdf"


def urdf_with(*visuals, materials=""):
    return f'<robot name="r">{materials}<link name="base">{"".join(visuals)}</link></robot>'


def visual(geometry, rest=""):
    return f"<visual>{rest}<geometry>{geometry}</geometry></visual>"


def only(urdf, package_dirs=()):
    (shape,), warnings = load_shapes(urdf, package_dirs)
    assert warnings == []
    return shape


@pytest.mark.parametrize(
    ("geometry", "extents", "volume"),
    [
        ('<box size="0.2 0.4 0.6"/>', (0.2, 0.4, 0.6), 0.048),
        ('<sphere radius="0.5"/>', (1, 1, 1), math.pi / 6),
        ('<cylinder radius="0.5" length="2"/>', (1, 1, 2), math.pi / 2),
        ('<capsule radius="0.5" length="2"/>', (1, 1, 3), math.pi / 2 + math.pi / 6),
    ],
)
def test_a_primitive_has_its_size_about_its_own_origin(geometry, extents, volume):
    mesh = only(urdf_with(visual(geometry))).mesh
    assert mesh.extents == pytest.approx(extents, rel=0.01)
    assert mesh.bounds.mean(axis=0) == pytest.approx([0, 0, 0], abs=1e-3)
    assert mesh.volume == pytest.approx(volume, rel=0.03)


@pytest.mark.parametrize(("radius", "length"), [(0.001, 5.0), (2.0, 0.3), (0.5, 1e-9)])
def test_a_capsule_is_closed_and_everywhere_its_radius_from_its_axis(radius, length):
    mesh = only(urdf_with(visual(f'<capsule radius="{radius}" length="{length}"/>'))).mesh
    axis = np.zeros_like(mesh.vertices)
    axis[:, 2] = np.clip(mesh.vertices[:, 2], -0.5 * length, 0.5 * length)
    assert mesh.is_watertight
    assert np.linalg.norm(mesh.vertices - axis, axis=1) == pytest.approx(radius, rel=1e-9)
    assert mesh.volume == pytest.approx(math.pi * radius**2 * (length + 4.0 / 3.0 * radius), rel=0.02)


def test_a_shape_sits_where_its_origin_says():
    origin = '<origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>'
    shape = only(urdf_with(visual('<sphere radius="1"/>', origin)))
    cr, sr, cp, sp, cy, sy = (f(a) for a in (0.1, 0.2, 0.3) for f in (math.cos, math.sin))
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    assert shape.link == "base"
    assert shape.placement[:3, :3] == pytest.approx(about_z @ about_y @ about_x)
    assert shape.placement[:, 3] == pytest.approx([1, 2, 3, 1])


def test_an_edge_stays_sharp_and_a_round_side_smooth():
    mesh = only(urdf_with(visual('<cylinder radius="1" length="1"/>'))).mesh
    upright = np.abs(mesh.vertex_normals[:, 2])
    assert ((upright < 0.01) | (upright > 0.99)).all()


def test_colours_come_from_the_visual_then_the_robot_then_grey():
    ball = '<sphere radius="1"/>'
    named = '<material name="sky"><color rgba="0.1 0.2 0.9 0.5"/></material>'
    urdf = urdf_with(
        visual(ball, '<material name=""><color rgba="1 0 0 1"/></material>'),
        visual(ball, '<material name="sky"/>'),
        visual(ball, '<material name="unheard of"/>'),
        visual(ball),
        materials=named,
    )
    shapes, warnings = load_shapes(urdf)
    assert [s.color for s in shapes] == [(1, 0, 0, 1), (0.1, 0.2, 0.9, 0.5), (0.7, 0.7, 0.7, 1), (0.7, 0.7, 0.7, 1)]
    assert len({s.name for s in shapes}) == 4
    assert warnings == []


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae"])
def test_a_mesh_file_is_found_beside_the_urdf_and_scaled(tmp_path, suffix):
    (tmp_path / "meshes").mkdir()
    trimesh.creation.box((100, 200, 300)).export(tmp_path / "meshes" / f"box.{suffix}")
    (tmp_path / "r.urdf").write_text(
        urdf_with(visual(f'<mesh filename="meshes/box.{suffix}" scale="0.01 0.01 -0.01"/>'))
    )
    mesh = only(tmp_path / "r.urdf").mesh
    assert mesh.extents == pytest.approx([1, 2, 3])
    assert mesh.volume == pytest.approx(6)  # positive: the mirrored faces still look outwards


def test_a_mesh_comes_from_package_dirs(tmp_path):
    (tmp_path / "stuff").mkdir()
    trimesh.creation.box((1, 1, 1)).export(tmp_path / "stuff" / "box.stl")
    urdf = urdf_with(visual('<mesh filename="package://stuff/box.stl"/>'))
    assert only(urdf, [tmp_path]).mesh.volume == pytest.approx(1)


def test_collada_units_are_honoured(tmp_path):
    trimesh.creation.box((10, 20, 30)).export(tmp_path / "box.dae")
    text = (tmp_path / "box.dae").read_text()
    centimetres = text.replace("</asset>", '<unit name="centimeter" meter="0.01"/></asset>')
    assert centimetres != text
    (tmp_path / "box.dae").write_text(centimetres)
    (tmp_path / "r.urdf").write_text(urdf_with(visual('<mesh filename="box.dae"/>')))
    assert only(tmp_path / "r.urdf").mesh.extents == pytest.approx([0.1, 0.2, 0.3])


@pytest.mark.parametrize(
    ("content", "why"),
    [(None, "there is no mesh 'x.stl'"), (b"", "x.stl"), (b"solid nothing\nendsolid\n", "x.stl")],
)
def test_a_missing_or_broken_mesh_is_a_warning_and_the_rest_is_drawn(tmp_path, content, why):
    if content is not None:
        (tmp_path / "x.stl").write_bytes(content)
    path = tmp_path / "r.urdf"
    path.write_text(urdf_with(visual('<mesh filename="x.stl"/>'), visual('<sphere radius="1"/>')))
    shapes, warnings = load_shapes(path)
    assert len(shapes) == 1
    assert len(warnings) == 1
    assert "link 'base'" in warnings[0]
    assert why in warnings[0]


def test_the_texture_of_a_ply_file_that_is_missing_or_no_picture_prints_nothing(tmp_path):
    header, corners = trimesh.creation.box().export(file_type="ply").split(b"end_header\n", 1)
    (tmp_path / "pointer.png").write_text("version https://git-lfs.github.com/spec/v1\n")
    for texture in ("missing", "pointer"):
        comment = f"comment TextureFile {texture}.png\n".encode()
        (tmp_path / f"{texture}.ply").write_bytes(header + comment + b"end_header\n" + corners)
    meshes = [visual(f'<mesh filename="{texture}.ply"/>') for texture in ("missing", "pointer")]
    (tmp_path / "r.urdf").write_text(urdf_with(*meshes))
    # Here pytest listens to every logger; on its own, a process prints what nobody listens to.
    script = "from pinik.shapes.meshes import load_shapes; s, w = load_shapes('r.urdf'); print(len(s), w)"
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("2 []\n", "")


def test_an_unknown_geometry_is_a_warning():
    shapes, warnings = load_shapes(urdf_with(visual("<torus/>")))
    assert shapes == []
    assert "<torus> is not a URDF shape; the shape is left out" in warnings[0]


def test_the_panda_is_shown_in_its_own_colours_and_size():
    robot = pinik.load("panda")
    shapes, warnings = load_shapes(robot.description.path)
    assert warnings == []
    assert {s.link for s in shapes} == {
        *(f"panda_link{i}" for i in range(8)),
        "panda_hand",
        "panda_leftfinger",
        "panda_rightfinger",
    }
    assert len({s.color for s in shapes}) >= 4  # white, dark grey, the lamps
    q = robot.neutral()
    corners = [
        trimesh.transform_points(s.mesh.bounding_box.vertices, robot.placement(s.link, q).homogeneous @ s.placement)
        for s in shapes
    ]
    low, high = np.vstack(corners).min(axis=0), np.vstack(corners).max(axis=0)
    assert low[2] == pytest.approx(0, abs=0.01)
    assert 1.0 < high[2] < 1.2


def test_a_robot_brings_its_file_its_text_and_its_folders(tmp_path):
    (tmp_path / "stuff").mkdir()
    trimesh.creation.box((1, 2, 3)).export(tmp_path / "stuff" / "box.stl")
    text = urdf_with(visual('<mesh filename="package://stuff/box.stl"/>'))
    (tmp_path / "home.urdf").write_text(text)
    for source in (text, tmp_path / "home.urdf"):
        assert only(pinik.load(source, package_dirs=[tmp_path])).mesh.volume == pytest.approx(6)


@pytest.mark.parametrize(
    ("source", "error", "words"),
    [
        ("/no/such.urdf", pinik.RobotLoadError, "no such file"),
        ("/", pinik.RobotLoadError, "directory"),
        ("<sdf/>", pinik.RobotLoadError, "SDF"),
        (3, pinik.InputError, "a robot, a path or URDF text, .*; got 3"),
    ],
)
def test_what_is_no_robot_is_refused_in_words(source, error, words):
    with pytest.raises(error, match=words):
        load_shapes(source)


def test_one_folder_for_a_list_is_refused_in_words():
    with pytest.raises(pinik.InputError, match="a list of folders; got '/tmp'"):
        load_shapes(URDF / "arm.urdf", "/tmp")


@pytest.mark.parametrize("name", ["arm", "lion", "two_link"])
def test_our_own_robots_are_whole(name):
    shapes, warnings = load_shapes(URDF / f"{name}.urdf")
    assert warnings == []
    for shape in shapes:
        assert shape.color != (0.7, 0.7, 0.7, 1.0)
        assert 0.001 < shape.mesh.extents.max() < 1.5
        assert np.isfinite(shape.mesh.vertex_normals).all()
