"""Finished shapes in the user's cache folder: found again when nothing changed, and never worth an error."""

from __future__ import annotations

import ast
import hashlib
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import platformdirs
import pytest
import trimesh

import pinik
from pinik.caches import cache_folder
from pinik.viewer.web import scene, shape_cache
from pinik.viewer.web.scene import Shapes, make_shapes
from pinik.viewer.web.shape_cache import shapes_of
from robots import load_quietly
from urdf_texts import link, robot

BOX = '<visual><geometry><box size="1 2 3"/></geometry></visual>'
MESH = '<visual><geometry><mesh filename="meshes/part.{}"/></geometry></visual>'


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PINIK_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def conversions(monkeypatch):
    """The robots that were converted, in order."""
    converted = []

    def counted(model):
        converted.append(model.name)
        return make_shapes(model)

    monkeypatch.setattr(shape_cache, "make_shapes", counted)
    return converted


def files():
    return sorted(cache_folder("shapes").iterdir()) if cache_folder("shapes").is_dir() else []


def only_file():
    (file,) = files()
    return file


def robot_with_mesh(tmp_path, suffix="stl", size=1.0):
    (tmp_path / "meshes").mkdir(exist_ok=True)
    trimesh.creation.box((size, 1, 1)).export(tmp_path / "meshes" / f"part.{suffix}")
    (tmp_path / "r.urdf").write_text(robot(link("base", MESH.format(suffix))))
    return pinik.load(tmp_path / "r.urdf")


def test_the_second_time_shapes_come_from_the_file_and_are_the_same(conversions):
    lost = load_quietly(robot(link("base", BOX, MESH.format("stl"))))
    first = shapes_of(lost)
    assert first == make_shapes(lost)
    assert len(first.warnings) == len(first.parts) == 1
    assert shapes_of(lost) == first
    assert conversions == ["r"]


def test_a_kept_robot_is_read_without_trimesh(folder):
    kept = shapes_of(load_quietly("arm"))
    code = (
        "import sys, pinik; from pinik.viewer.web.shape_cache import shapes_of; "
        "print(len(shapes_of(pinik.load('arm')).commands), 'trimesh' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [str(len(kept.commands)), "False"]


def test_the_root_makes_no_difference(conversions):
    shapes_of(pinik.load(robot(link("base", BOX))))
    shapes_of(pinik.load(robot(link("base", BOX)), root="free_flyer"))
    assert len(conversions) == 1


def test_another_description_is_another_robot(conversions):
    shapes_of(pinik.load(robot(link("base", BOX))))
    shapes_of(pinik.load(robot(link("base", BOX, BOX))))
    assert len(conversions) == 2


def test_a_changed_mesh_is_converted_anew(tmp_path, conversions):
    model = robot_with_mesh(tmp_path)
    first, mesh = shapes_of(model), tmp_path / "meshes" / "part.stl"
    before = mesh.stat()
    trimesh.creation.box((4, 1, 1)).export(mesh)
    assert mesh.stat().st_size == before.st_size
    os.utime(mesh, ns=(before.st_atime_ns, before.st_mtime_ns + 1))
    second = shapes_of(model)
    assert second == make_shapes(model) != first
    mesh.unlink()
    assert shapes_of(model).parts == ()
    assert len(conversions) == 3


def test_a_mesh_of_another_size_is_converted_anew_even_with_the_old_time(tmp_path, conversions):
    model = robot_with_mesh(tmp_path)
    shapes_of(model)
    mesh = tmp_path / "meshes" / "part.stl"
    before = mesh.stat()
    trimesh.creation.icosphere(1).export(mesh)
    os.utime(mesh, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert shapes_of(model) == make_shapes(model)
    assert len(conversions) == 2


@pytest.mark.parametrize("place", ["paint.mtl", "deep/below/paint.mtl"])
def test_a_changed_material_file_is_read_anew(tmp_path, place):
    model = robot_with_mesh(tmp_path, "obj")
    mesh, material = tmp_path / "meshes" / "part.obj", tmp_path / "meshes" / place
    material.parent.mkdir(parents=True, exist_ok=True)
    mesh.write_text(f"mtllib {place}\nusemtl paint\n" + mesh.read_text())
    material.write_text("newmtl paint\nKd 1 0 0\n")
    red = shapes_of(model)
    material.write_text("newmtl paint\nKd 0 0 1.00\n")
    blue = shapes_of(model)
    assert blue == make_shapes(model) != red


def test_changed_numbers_of_a_gltf_mesh_are_read_anew(tmp_path):
    (tmp_path / "meshes").mkdir()
    for name, data in trimesh.creation.box((1, 1, 1)).export(file_type="gltf").items():
        (tmp_path / "meshes" / name).write_bytes(data)
    (tmp_path / "meshes" / "model.gltf").rename(tmp_path / "meshes" / "part.gltf")
    (tmp_path / "r.urdf").write_text(robot(link("base", MESH.format("gltf"))))
    model = pinik.load(tmp_path / "r.urdf")
    before = shapes_of(model)
    corners = tmp_path / "meshes" / "gltf_buffer_1.bin"
    corners.write_bytes((np.frombuffer(corners.read_bytes(), "<f4") * 2).tobytes())
    os.utime(corners, ns=(0, 0))
    assert shapes_of(model) == make_shapes(model) != before


def test_a_mesh_among_too_many_files_is_converted_each_time(tmp_path, monkeypatch, conversions):
    model = robot_with_mesh(tmp_path, "obj")
    monkeypatch.setattr("pinik.shapes.referred._MOST", 0)
    assert len(shapes_of(model).parts) == len(shapes_of(model).parts) == 1
    assert len(conversions) == 2


def test_a_mesh_in_another_place_is_another_mesh(tmp_path, conversions):
    for place in ("one", "other"):
        (tmp_path / place / "stuff").mkdir(parents=True)
        size = 1 if place == "one" else 2
        trimesh.creation.box((size, 1, 1)).export(tmp_path / place / "stuff" / "part.stl")
        os.utime(tmp_path / place / "stuff" / "part.stl", ns=(0, 0))
    urdf = robot(link("base", '<visual><geometry><mesh filename="package://stuff/part.stl"/></geometry></visual>'))
    one, other = (shapes_of(pinik.load(urdf, package_dirs=[tmp_path / place])) for place in ("one", "other"))
    assert one != other
    assert len(conversions) == 2


def test_the_code_that_makes_shapes_is_that_of_shapes_and_what_reads_them():
    """Every module of `shapes` that the makers import, directly or not, and those of `description` with the readers."""
    source = Path(pinik.__file__).parent
    pending, found = ["meshes", "simplified"], set()
    while pending:
        name = pending.pop()
        if name not in found:
            found.add(name)
            for node in ast.walk(ast.parse((source / "shapes" / f"{name}.py").read_text("utf-8"))):
                if isinstance(node, ast.ImportFrom) and node.level == 1:
                    pending.extend([node.module] if node.module else [one.name for one in node.names])
    readers = {source / "description" / f"{name}.py" for name in ("materials", "numbers", "part", "shape_tags")}
    shapes = {source / "shapes" / f"{name}.py" for name in found}
    assert set(shape_cache._MAKERS) == shapes | readers | {source / "viewer" / "web" / "scene.py"}


@pytest.mark.parametrize("maker", range(len(shape_cache._MAKERS)))
def test_other_code_that_makes_shapes_makes_them_anew(tmp_path, monkeypatch, conversions, maker):
    model = pinik.load(robot(link("base", BOX)))
    shapes_of(model)
    changed = tmp_path / "changed.py"
    changed.write_bytes(shape_cache._MAKERS[maker].read_bytes() + b"# changed")
    monkeypatch.setattr(
        shape_cache, "_MAKERS", [changed if k == maker else p for k, p in enumerate(shape_cache._MAKERS)]
    )
    shapes_of(model)
    assert len(conversions) == 2


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[:20],
        lambda content: content[:-1],
        lambda content: content + b"\0",
        lambda content: content[:100] + bytes([content[100] ^ 1]) + content[101:],
        lambda content: b"\0" * len(content),
    ],
    ids=["empty", "head only", "cut", "longer", "one bit", "zeros"],
)
def test_a_damaged_file_is_as_good_as_none_and_is_mended(damage, conversions):
    model = pinik.load(robot(link("base", BOX)))
    first = shapes_of(model)
    whole = only_file().read_bytes()
    only_file().write_bytes(damage(whole))
    assert shapes_of(model) == first
    assert only_file().read_bytes() == whole
    assert len(conversions) == 2


def test_a_file_that_cannot_be_read_or_replaced_is_as_good_as_none():
    model = pinik.load(robot(link("base", BOX)))
    first = shapes_of(model)
    file = only_file()
    file.unlink()
    file.mkdir()
    assert shapes_of(model) == first
    assert files() == [file]  # and nothing unfinished beside it


@pytest.mark.parametrize("kind", ["a pipe", "an endless device", "too large"])
def test_an_entry_that_is_no_file_of_a_bounded_size_holds_nothing_up(tmp_path, monkeypatch, kind):
    model = pinik.load(robot(link("base", BOX)))
    first = shapes_of(model)
    file = only_file()
    file.unlink()
    if kind == "a pipe":
        os.mkfifo(file)
    elif kind == "an endless device":
        file.symlink_to("/dev/zero")
    else:
        file.write_bytes(b"\0" * 1_000_001)
        monkeypatch.setattr(shape_cache, "LIMIT", 1_000_000)
    assert shapes_of(model) == first


def test_a_whole_entry_of_the_wrong_form_is_made_anew(conversions):
    model = pinik.load(robot(link("base", BOX)))
    first = shapes_of(model)
    for body in (b"", b"\xc0", b"\x93\x01\x02\x03", b"\xc1", b"\x91" * 10_000):
        only_file().write_bytes(hashlib.sha256(body).digest() + body)
        assert shapes_of(model) == first
    assert len(conversions) == 6


def test_without_a_home_folder_nothing_is_cached_and_nothing_is_lost(tmp_path, monkeypatch):
    monkeypatch.delenv("PINIK_CACHE_DIR")
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda *_, **__: "~/.cache/pinik")  # as without a home folder
    monkeypatch.chdir(tmp_path)
    model = pinik.load(robot(link("base", BOX)))
    assert shapes_of(model) == make_shapes(model)
    assert list(tmp_path.iterdir()) == []


def test_meshes_that_cannot_be_looked_at_cost_only_the_cache(tmp_path, monkeypatch):
    def fail(_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(shape_cache, "_key", fail)
    model = pinik.load(robot(link("base", BOX)))
    assert shapes_of(model) == make_shapes(model)
    assert files() == []


def test_a_folder_that_cannot_be_written_is_no_error(folder):
    folder.write_text("a file where the folder would be")
    model = pinik.load(robot(link("base", BOX)))
    assert shapes_of(model) == make_shapes(model)


def test_a_write_that_fails_midway_leaves_nothing(monkeypatch):
    def full_disk(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full_disk)
    model = pinik.load(robot(link("base", BOX)))
    assert shapes_of(model) == make_shapes(model)
    assert files() == []


@pytest.mark.parametrize("fault", [RuntimeError("no luck"), MemoryError(), ImportError("no trimesh")])
def test_a_conversion_that_fails_gives_no_shapes_a_warning_and_is_tried_again(monkeypatch, fault):
    def fail(_):
        raise fault

    model = pinik.load(robot(link("base", BOX)))
    with monkeypatch.context() as patch:
        patch.setattr(shape_cache, "make_shapes", fail)
        shapes = shapes_of(model)
    assert (shapes.parts, shapes.commands) == ((), ())
    assert (str(fault) or "MemoryError") in shapes.warnings[0]
    assert files() == []
    assert shapes_of(model) == make_shapes(model)


def test_words_that_are_no_unicode_are_kept_from_the_file_only(monkeypatch):
    odd = Shapes((), (), ("'\udcff.stl' cannot be read",))
    monkeypatch.setattr(shape_cache, "make_shapes", lambda _: odd)
    assert shapes_of(pinik.load(robot(link("base", BOX)))) == odd
    assert files() == []


def test_what_was_used_longest_ago_goes_first(monkeypatch, conversions):
    models = [pinik.load(robot(link(f"base{k}", BOX))) for k in range(4)]
    for age, model in enumerate(models[:3]):
        before = set(files())
        shapes_of(model)
        (new,) = set(files()) - before
        os.utime(new, ns=(0, (age + 1) * 10**9))
    size = max(file.stat().st_size for file in files())
    monkeypatch.setattr(shape_cache, "LIMIT", 3 * size + 10)
    shapes_of(models[0])  # used, so that model 1 is the oldest now
    shapes_of(models[3])
    assert len(files()) == 3
    assert sum(file.stat().st_size for file in files()) <= shape_cache.LIMIT
    assert len(conversions) == 4
    for model in (models[0], models[2], models[3]):
        shapes_of(model)
    assert len(conversions) == 4
    shapes_of(models[1])
    assert len(conversions) == 5


def test_shapes_larger_than_all_room_do_not_push_the_others_out(monkeypatch):
    small = pinik.load(robot(link("base", BOX)))
    shapes_of(small)
    monkeypatch.setattr(shape_cache, "LIMIT", only_file().stat().st_size + 10)
    kept = files()
    shapes_of(pinik.load(robot(link("base", '<visual><geometry><sphere radius="1"/></geometry></visual>'))))
    assert files() == kept


def test_two_at_once_get_the_same():
    model, answers = pinik.load(robot(link("base", BOX))), []
    threads = [threading.Thread(target=lambda: answers.append(shapes_of(model))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers == [scene.make_shapes(model)] * 4
    assert len(files()) == 1


def test_without_the_variable_files_are_in_the_users_cache_folder(monkeypatch, tmp_path):
    monkeypatch.delenv("PINIK_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    if sys.platform == "linux":
        assert cache_folder("shapes") == tmp_path / "xdg" / "pinik" / "shapes"
    assert cache_folder("shapes").is_absolute()


@pytest.mark.parametrize("kind", ["pipe", "endless"])
def test_a_cached_file_that_is_no_file_is_made_again(conversions, kind):
    machine = load_quietly(robot(link("base", BOX)))
    whole = shapes_of(machine)
    file = only_file()
    file.unlink()
    if kind == "pipe":
        os.mkfifo(file)
    else:
        file.symlink_to("/dev/zero")
    assert shapes_of(machine) == whole
    assert len(conversions) == 2
