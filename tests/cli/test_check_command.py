from __future__ import annotations

import pytest

LINKS = '<link name="a"/><link name="b"/>'
JOINT = (
    '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    '<limit lower="{lower}" upper="1" effort="1" velocity="1"/></joint>'
)


@pytest.fixture
def urdf(tmp_path):
    def write(body: str):
        file = tmp_path / "robot.urdf"
        file.write_text(f'<robot name="r">{body}</robot>')
        return file

    return write


def test_a_good_file_loads(run):
    answer = run("check", "lion", "--json")
    assert answer.status == 0
    assert answer.json["loads"]
    assert answer.json["missing_meshes"] == answer.json["mesh_faults"] == answer.json["faults"] == []
    assert answer.json["shapes"] > 0


def test_a_fault_names_element_and_cause_and_is_status_3(run, urdf):
    file = urdf(LINKS + JOINT.format(lower=2))
    answer = run("check", file, "--json")
    assert answer.status == 3
    assert answer.json["loads"] is False
    (fault,) = answer.json["faults"]
    assert fault["element"] == "joint 'j'"
    assert str(file) not in fault["message"]
    person = run("check", file)
    assert person.status == 3
    assert f"fault: joint 'j': {fault['message']}" in person.out.splitlines()


def test_no_such_file_is_a_fault(run, tmp_path):
    result = run("check", tmp_path / "none.urdf")
    assert result.status == 3
    assert "no such file" in result.out


def test_missing_and_unreadable_meshes_are_named(run, urdf, tmp_path):
    (tmp_path / "broken.stl").write_text("no mesh")
    shapes = "".join(
        f'<visual><geometry><mesh filename="{name}"/></geometry></visual>' for name in ("gone.stl", "broken.stl")
    )
    file = urdf(f'<link name="a">{shapes}</link>')
    answer = run("check", file, "--json")
    assert answer.status == 0
    assert answer.json["missing_meshes"] == ["gone.stl"]
    assert len(answer.json["mesh_faults"]) == 1
    assert (answer.json["meshes"], answer.json["shapes"]) == (2, 0)
    assert "missing mesh: gone.stl" in run("check", file).out.splitlines()


def test_package_dirs_are_searched(run, urdf, tmp_path):
    mesh = tmp_path / "elsewhere" / "parts" / "gone.obj"
    mesh.parent.mkdir(parents=True)
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    visual = '<visual><geometry><mesh filename="package://parts/gone.obj"/></geometry></visual>'
    file = urdf(f'<link name="a">{visual}</link>')
    assert run("check", file, "--json").json["missing_meshes"] == ["package://parts/gone.obj"]
    found = run("check", file, "--package-dir", tmp_path / "elsewhere", "--json").json
    assert found["missing_meshes"] == []
    assert found["shapes"] == 1


def test_what_was_mended_is_a_warning(run, urdf):
    body = LINKS + JOINT.format(lower=-1).replace('lower="-1" upper="1"', "")
    answer = run("check", urdf(body), "--json")
    assert answer.status == 0
    assert any("j" in words and "limit" in words for words in answer.json["warnings"])
    assert any(line.startswith("warning: joint 'j'") for line in run("check", urdf(body)).out.splitlines())
