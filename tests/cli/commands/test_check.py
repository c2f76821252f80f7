from __future__ import annotations

import pytest

import pinik
from pinik.shapes import second_opinion
from pinik.shapes.second_opinion import ask_yourdfpy

XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="a" value="1"/></robot>'
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


def test_a_urdf_on_stdin_is_checked_as_one_in_a_file(run, urdf):
    for text in (LINKS + JOINT.format(lower=-1), LINKS + JOINT.format(lower=2)):
        file = urdf(text)
        from_file, from_stdin = run("check", file, "--json"), run("check", "-", "--json", stdin=file.read_text())
        assert from_stdin.status == from_file.status
        assert from_stdin.json == from_file.json | {"file": "stdin"}


def test_what_is_no_urdf_on_stdin_is_said_in_words(run):
    for text, words in (("", "empty"), ("lion", "not XML"), (XACRO, "unexpanded xacro file")):
        answer = run("check", "-", stdin=text)
        assert (answer.status, answer.out.splitlines()[0]) == (3, "stdin: cannot be loaded")
        assert words in answer.out


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


def test_all_faulty_joints_are_named_and_loading_raises_the_first(run, urdf):
    links = "".join(f'<link name="{name}"/>' for name in "abcd")
    ends = '<parent link="a"/><child link="{}"/>'
    file = urdf(
        f'{links}<joint name="i" type="fixed">{ends.format("lost")}</joint>\n'
        f'<joint name="j" type="prismatc">{ends.format("b")}</joint>\n'
        f'<joint name="k" type="revolut">{ends.format("c")}</joint>\n'
        f'<joint name="l" type="fixed">{ends.format("d")}</joint>'
    )
    faults = run("check", file, "--json").json["faults"]
    assert {(fault["element"], fault["message"].partition(";")[0]) for fault in faults} == {
        ("joint 'j'", "unknown type 'prismatc'"),
        ("joint 'k'", "unknown type 'revolut'"),
        ("joint 'i'", "its child link 'lost' is not defined (line 1)"),
    }
    with pytest.raises(pinik.RobotLoadError) as error:
        pinik.load(file)
    assert [(one.element, one.cause) for one in (error.value, *error.value.others)] == [
        (fault["element"], fault["message"]) for fault in faults
    ]
    assert sum(line.startswith("fault: ") for line in run("check", file).out.splitlines()) == 3


def test_many_faulty_joints_are_counted_in_a_terminal(run, urdf):
    joints = "".join(f'<joint name="j{number}" type="fix"/>' for number in range(1100))
    lines = run("check", urdf(LINKS + joints)).out.splitlines()
    assert sum(line.startswith("fault: ") for line in lines) == 20
    assert "and 1,080 more faults" in lines
    assert len(run("check", urdf(LINKS + joints), "--json").json["faults"]) == 1000


def test_one_of_a_kind_is_singular(run, urdf):
    assert run("check", urdf('<link name="a"/>')).out.splitlines()[-1] == "1 link, 0 joints, 0 meshes, 0 shapes"


def test_a_file_that_is_a_robot_of_the_catalogue_suggests_it(run):
    result = run("check", "somewhere/panda.urdf")
    assert result.status == 3
    assert "the catalogue has a robot 'panda'" in result.out


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
    lines = run("check", file).out.splitlines()
    assert "warning: missing-mesh" in lines
    assert any("'gone.stl'" in line for line in lines)


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
    lines = run("check", urdf(body)).out.splitlines()
    assert "warning: absent-limit" in lines
    assert any(line.startswith("  joint 'j' (line 1): <limit> has no lower") for line in lines)


def test_yourdfpy_gives_a_second_opinion(run):
    person = run("check", "lion")
    (line,) = [line for line in person.out.splitlines() if "yourdfpy" in line]
    assert line.startswith("yourdfpy agrees: 54 links at 3 configurations, at most ")
    opinion = run("check", "lion", "--json").json["second_opinion"]
    assert opinion["agrees"]
    assert (opinion["links"], opinion["disagreeing"], opinion["unread"]) == (54, [], None)


def test_what_yourdfpy_cannot_read_is_a_warning_and_no_failure(run, urdf):
    file = urdf(LINKS + JOINT.format(lower=-1))
    file.write_text(file.read_text().replace(' name="r"', ""))
    person = run("check", file)
    assert (person.status, person.err) == (0, "")
    assert any(line.startswith("warning: yourdfpy gives no second opinion: ") for line in person.out.splitlines())
    opinion = run("check", file, "--json").json["second_opinion"]
    assert opinion["agrees"] is False
    assert "KeyError" in opinion["unread"]


def test_a_disagreement_is_a_warning_and_no_failure(run, urdf, monkeypatch):
    file = urdf(LINKS + JOINT.format(lower=-1))
    other = file.with_name("other.urdf")
    other.write_text(file.read_text().replace("<axis", '<origin xyz="0 0 nan"/><axis'))
    monkeypatch.setattr(second_opinion, "ask_yourdfpy", lambda robot, path: ask_yourdfpy(robot, other))
    person = run("check", file)
    assert person.status == 0
    assert any(line.startswith("warning: yourdfpy disagrees about 'b': ") for line in person.out.splitlines())
    opinion = run("check", file, "--json").json["second_opinion"]
    assert opinion["disagreeing"] == ["b"]
    assert opinion["position_difference_m"] is None


def test_there_is_no_second_opinion_on_what_cannot_be_loaded(run, urdf):
    file = urdf(LINKS + JOINT.format(lower=2))
    assert run("check", file, "--json").json["second_opinion"] is None
    assert "yourdfpy" not in run("check", file).out


def test_a_shape_s_fault_stays_though_it_contains_the_address_of_a_missing_mesh(run, urdf, tmp_path):
    """The address of the missing mesh, "a", is a part of nearly any sentence."""
    (tmp_path / "bad.stl").write_text("nothing")
    meshes = "".join(f'<visual><geometry><mesh filename="{name}"/></geometry></visual>' for name in ("a", "bad.stl"))
    answer = run("check", urdf(f'<link name="base">{meshes}</link>'), "--json").json
    assert answer["missing_meshes"] == ["a"]
    assert len(answer["mesh_faults"]) == 1
    assert "a shape is left out" in answer["mesh_faults"][0]


def test_joints_with_the_same_flaw_share_a_line_whatever_their_names(run, urdf):
    joints = "".join(
        f'<link name="l{k}"/><joint name="j\'{k}" type="continuous"><parent link="base"/><child link="l{k}"/>'
        f'<mimic joint="gone{k}"/></joint>'
        for k in (1, 2)
    )
    lines = run("check", urdf(f'<link name="base"/>{joints}')).out.splitlines()
    (line,) = [line for line in lines if line.endswith(": it mimics a joint that does not exist; it is left free")]
    assert "j'1" in line
    assert "j'2" in line


class TestFollowers:
    """Two joints beside each other; the first by name follows the second, or has it hang from itself."""

    LINKS = '<link name="a"/><link name="b"/><link name="c"/>'
    JOINTS = (
        '<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="two" multiplier="{multiplier}"/></joint>'
        '<joint name="two" type="revolute"><parent link="{parent}"/><child link="c"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    )

    def test_whose_leader_comes_later_by_name_agree_with_yourdfpy(self, run, urdf):
        answer = run("check", urdf(self.LINKS + self.JOINTS.format(parent="a", multiplier=0.5)), "--json").json
        assert answer["second_opinion"]["agrees"]
        assert (answer["warnings"], answer["second_opinion"]["links"]) == ([], 3)

    def test_that_are_left_free_are_a_disagreement(self, run, urdf):
        answer = run("check", urdf(self.LINKS + self.JOINTS.format(parent="b", multiplier=0)), "--json").json
        assert "it is left free" in answer["warnings"][0]
        assert answer["second_opinion"]["disagreeing"] == ["b", "c"]


POSES = '<robot name="r"><group_state name="home" group="g"><joint name="j" value="{}"/></group_state></robot>'


@pytest.mark.parametrize(
    ("value", "code", "words"),
    [("99", "pose-outside-limits", "the pose is left out"), ("abc", "bad-srdf", "no pose can be read from robot.srdf")],
)
def test_a_pose_that_cannot_be_taken_is_a_warning(run, urdf, value, code, words):
    file = urdf(LINKS + JOINT.format(lower=-1))
    file.with_suffix(".srdf").write_text(POSES.format("0.5"))
    before = run("check", file, "--json").json["counts"]
    file.with_suffix(".srdf").write_text(POSES.format(value))
    answer = run("check", file, "--json")
    assert (answer.status, answer.json["counts"]) == (0, before | {code: 1})
    (flaw,) = [flaw for flaw in answer.json["flaws"] if flaw["code"] == code]
    assert flaw["element"] == "pose 'home', joint 'j'"
    assert words in flaw["cause"]
    assert run("check", file, "--strict").status == 3


def test_an_empty_name_is_wrong_usage_and_not_the_working_folder(run):
    result = run("check", "")
    assert result.status == 2
    assert "FILE.urdf must be a file, the name of a robot, or -; got an empty text" in result.err
