"""Mesh files as the world has them, and as attackers make them."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import trimesh

import pinik
from mesh_attacks import collada, gltf, ply, stl, write
from pinik.shapes.meshes import load_shapes

READ_ALL = """
import json, resource, sys
resource.setrlimit(resource.RLIMIT_AS, (2 * 1024**3, 2 * 1024**3))
from pinik.shapes.mesh_checks import MeshError
from pinik.shapes.triangles import read_file
from pathlib import Path
told = {}
for file in sorted(Path(sys.argv[1]).iterdir()):
    try:
        read_file(file)
        told[file.name] = "read"
    except MeshError as fault:
        told[file.name] = str(fault)
print(json.dumps(told))
"""


def test_every_attack_is_refused_in_words_within_two_gigabytes(tmp_path: Path) -> None:
    words = write(tmp_path)
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-c", READ_ALL, tmp_path / "meshes"]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment)
    assert answer.returncode == 0, answer.stderr[-2000:]
    told = json.loads(answer.stdout)
    assert told.keys() == words.keys()
    for name, refusal in words.items():
        assert refusal in told[name], name
        assert len(told[name]) < 300


def shapes_of(folder: Path, name: str, rest: str = "") -> tuple[list, list]:
    shape = f'<visual><geometry><mesh filename="{name}" {rest}/></geometry></visual>'
    (folder / "r.urdf").write_text(f'<robot name="r"><link name="a">{shape}</link></robot>')
    return load_shapes(folder / "r.urdf")


def test_a_fault_of_a_mesh_has_a_code_and_names_file_and_line(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(b"version https://git-lfs.github.com/spec/v1\n")
    shapes, (flaw,) = shapes_of(tmp_path, "a.stl")
    assert shapes == []
    assert flaw.startswith("link 'a': a shape is left out: 'a.stl': this is a Git LFS pointer")
    assert (flaw.code, flaw.line, flaw.mesh) == ("lfs-pointer", 1, None)


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_the_up_axis_of_a_collada_file_turns_nothing(tmp_path: Path, up: str) -> None:
    """As in RViz, Gazebo and MoveIt, for which the robots' files are made."""
    (tmp_path / "a.dae").write_bytes(collada(up=up, numbers="0 0 0 1 0 0 0 2 3"))
    ((shape,), flaws) = shapes_of(tmp_path, "a.dae")
    assert flaws == []
    assert shape.mesh.bounds == pytest.approx(np.array([[0, 0, 0], [1, 2, 3]]))


@pytest.mark.parametrize("unit", ["0.0254", "1e-3", "1"])
def test_the_unit_of_a_collada_file_counts(tmp_path: Path, unit: str) -> None:
    (tmp_path / "a.dae").write_bytes(collada(unit=f'<unit name="u" meter="{unit}"/>'))
    ((shape,), _) = shapes_of(tmp_path, "a.dae")
    assert shape.mesh.extents.max() == pytest.approx(float(unit))


@pytest.mark.parametrize("unit", ["0", "nan", "1e400", "-1", "much"])
def test_a_unit_that_is_none_never_gives_a_shape_that_is_no_shape(tmp_path: Path, unit: str) -> None:
    (tmp_path / "a.dae").write_bytes(collada(unit=f'<unit name="u" meter="{unit}"/>'))
    shapes, flaws = shapes_of(tmp_path, "a.dae")
    assert len(shapes) + len(flaws) == 1
    for shape in shapes:
        assert np.isfinite(shape.mesh.vertices).all()


@pytest.mark.parametrize("number", ["nan", "NaN", "-nan(ind)", "-1.#IND", "inf", "1e400"])
@pytest.mark.parametrize("kind", ["dae", "obj"])
def test_a_corner_that_is_no_finite_number_is_named_and_not_moved_to_0(tmp_path: Path, kind: str, number: str) -> None:
    if kind == "dae":
        (tmp_path / "a.dae").write_bytes(collada(numbers=f"0 0 0 1 0 0 0 {number} 3"))
    else:
        (tmp_path / "a.obj").write_text(f"v 0 0 0\nv 1 0 0\nv 0 {number} 3\nf 1 2 3\n")
    shapes, (flaw,) = shapes_of(tmp_path, f"a.{kind}")
    assert shapes == []
    if kind == "dae" or ("(" not in number and "#" not in number):
        assert (flaw.code, "not finite numbers" in flaw) == ("nan-in-mesh", True)


def test_normals_that_are_no_numbers_leave_a_collada_shape_as_it_is(tmp_path: Path) -> None:
    normals = b"""<source id="m"><float_array id="b" count="9">nan nan nan 0 0 1 0 0 1</float_array><technique_common>
    <accessor source="#b" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source><vertices id"""
    (tmp_path / "a.dae").write_bytes(collada(numbers="0 0 0 1 0 0 0 2 3").replace(b"<vertices id", normals))
    ((shape,), flaws) = shapes_of(tmp_path, "a.dae")
    assert (flaws, shape.mesh.extents.tolist()) == ([], [1, 2, 3])


def test_what_follows_the_triangles_of_a_binary_stl_is_ignored(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(stl(2) + b"\0\0 rest")
    ((shape,), flaws) = shapes_of(tmp_path, "a.stl")
    assert flaws == []
    assert len(shape.mesh.faces) == 2


def test_a_binary_stl_may_begin_as_a_text_does(tmp_path: Path) -> None:
    (tmp_path / "a.STL").write_bytes(b"solid exported by hand".ljust(80) + stl(2)[80:])
    ((shape,), _) = shapes_of(tmp_path, "a.STL")
    assert len(shape.mesh.faces) == 2


def test_a_material_file_gives_colours_from_the_mesh_s_own_folder_alone(tmp_path: Path) -> None:
    red = "newmtl red\nKd 1 0 0\nmap_Kd wood.png\n"
    body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "inside.mtl").write_text(red)
    (tmp_path / "outside.mtl").write_text(red)
    (tmp_path / "meshes" / "link.mtl").symlink_to(tmp_path / "outside.mtl")
    os.mkfifo(tmp_path / "meshes" / "pipe.mtl")
    colours = {}
    for library in ("inside.mtl", "../outside.mtl", str(tmp_path / "outside.mtl"), "link.mtl", "pipe.mtl"):
        (tmp_path / "meshes" / "a.obj").write_text(f"mtllib {library}\n{body}")
        ((shape,), _) = shapes_of(tmp_path, "meshes/a.obj")
        colours[library] = shape.color
    assert colours.pop("inside.mtl") == (1, 0, 0, 1)
    assert set(colours.values()) == {(0.7, 0.7, 0.7, 1.0)}


def test_a_mesh_of_many_copies_is_counted_before_it_is_copied(tmp_path: Path) -> None:
    file = trimesh.creation.icosphere(6).export(file_type="glb")
    scene = json.loads(file[20 : 20 + int.from_bytes(file[12:16], "little")])
    scene["nodes"] = [{"mesh": 0, "name": f"n{i}"} for i in range(62)]
    scene["scenes"] = [{"nodes": list(range(62))}]
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    rest = file[20 + int.from_bytes(file[12:16], "little") :]
    whole = b"glTF" + (2).to_bytes(4, "little") + (20 + len(text) + len(rest)).to_bytes(4, "little")
    (tmp_path / "a.glb").write_bytes(whole + len(text).to_bytes(4, "little") + b"JSON" + text + rest)
    shapes, (flaw,) = shapes_of(tmp_path, "a.glb")
    assert shapes == []
    assert "triangles, and pinik draws at most" in flaw


def test_all_shapes_of_a_robot_together_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinik.shapes.mesh_files.MOST_TRIANGLES", 500)
    trimesh.creation.icosphere(2).export(tmp_path / "a.stl")  # 320 triangles
    shape = '<visual><geometry><mesh filename="a.stl" scale="{0} {0} {0}"/></geometry></visual>'
    ball, box = (
        f"<visual><geometry><{kind}/></geometry></visual>" for kind in ('sphere radius="1"', 'box size="1 1 1"')
    )
    visuals = shape.format(1) + shape.format(2) + ball + box
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="a">{visuals}</link></robot>')
    shapes, flaws = load_shapes(tmp_path / "r.urdf")
    assert [shape.name for shape in shapes] == ["a/0", "a/3"]
    assert [flaw.code for flaw in flaws] == ["mesh-too-large"] * 2


def test_a_texture_that_is_missing_says_nothing(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    cube = trimesh.creation.box((1, 1, 1)).export(file_type="ply", encoding="ascii")
    (tmp_path / "a.ply").write_bytes(cube.replace(b"comment", b"comment TextureFile no.png\ncomment", 1))
    assert b"TextureFile" in (tmp_path / "a.ply").read_bytes()
    with warnings.catch_warnings(), caplog.at_level(logging.DEBUG):
        warnings.simplefilter("error")
        ((shape,), flaws) = shapes_of(tmp_path, "a.ply")
    assert flaws == []
    assert caplog.records == []
    assert shape.mesh.extents == pytest.approx([1, 1, 1])


@pytest.mark.parametrize("kind", ["stl", "obj", "dae", "ply", "glb", "gltf", "off"])
def test_each_listed_format_is_read(tmp_path: Path, kind: str) -> None:
    box = trimesh.creation.box((1, 2, 3))
    if kind == "gltf":
        for name, data in box.export(file_type="gltf").items():
            (tmp_path / name).write_bytes(data)
        name = "model.gltf"
    else:
        name = f"a.{kind}"
        box.export(tmp_path / name)
    ((shape,), flaws) = shapes_of(tmp_path, name)
    assert flaws == []
    assert shape.mesh.extents == pytest.approx([1, 2, 3])
    assert len(shape.mesh.faces) == 12


def test_a_draw_of_a_robot_with_a_broken_mesh_warns_and_draws(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_bytes(ply(10**9, 1, b"\0" * 100))
    (tmp_path / "b.gltf").write_bytes(gltf([{"componentType": 5126, "type": "MAT4", "count": 10**9}]))
    shapes = (
        "".join(f'<visual><geometry><mesh filename="{name}"/></geometry></visual>' for name in ("a.ply", "b.gltf"))
        + "<visual><geometry><box size='1 1 1'/></geometry></visual>"
    )
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    robot = pinik.load(tmp_path / "r.urdf")
    with pytest.warns(pinik.UrdfWarning, match="a shape is left out"):
        picture = pinik.draw(robot, size=(40, 30), ground=False, background=None)
    assert (picture.pixels[..., 3] > 0).any()
