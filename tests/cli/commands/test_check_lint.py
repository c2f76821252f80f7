"""`pinik check` as a lint: what it says about mistakes, --strict, --fix, and the bounds of its time and output."""

from __future__ import annotations

import os
import time
import warnings

import numpy as np
import pytest

import pinik
from pinik.cli.commands import check as command
from pinik.cli.reports import mended_file
from pinik.cli.terminal.exits import ExitStatus
from pinik.description.reader import read
from urdf_texts import joint, link, pair, robot

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
AXIS_AS_ATTRIBUTE = pair(limit=LIMIT).replace('name="j"', 'name="j" axis="0 1 0"')
# The documents of five people, with the code and the words that each should meet.
MISTAKES = {
    "axis_as_attribute": (AXIS_AS_ATTRIBUTE, "misplaced-attribute", "the axis is taken as 1 0 0", True),
    "limit_in_degrees": (
        pair(limit=LIMIT.replace("1", "90")), "limit-in-degrees", "look like degrees", False
    ),
    "link_upper": (
        robot('<Link name="x"/>', link("a"), joint("k", "a", "x", kind="fixed").replace("joint", "Joint")),
        "unknown-element", "the link is missing from the robot", True,
    ),
    "origin_xyz_typo": (
        pair('<origin xzy="0 0 0.1" rpy="0 0 0"/>', limit=LIMIT), "unknown-attribute", "xyz is taken as 0 0 0", True
    ),
    "two_visual_geoms": (
        robot(link("a", '<visual><geometry><box size="1 1 1"/><sphere radius="1"/></geometry></visual>')),
        "second-shape", "<sphere> dropped", False,
    ),
}  # fmt: skip
SECONDS = 60.0  # against hangs; each takes a few seconds on an idle machine


@pytest.fixture
def write(tmp_path):
    def write_to(text: str, name: str = "robot.urdf"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return write_to


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_a_warning_with_line_loss_and_mend(run, write, mistake):
    text, code, words, fixable = MISTAKES[mistake]
    answer = run("check", write(text), "--json")
    assert (answer.status, answer.json["loads"], answer.json["passes"]) == (0, True, True)
    flaw = answer.json["flaws"][0]
    assert (flaw["code"], flaw["line"], flaw["severity"], flaw["fixable"]) == (code, 1, "warning", fixable)
    assert words in flaw["cause"]
    assert flaw["why"]
    assert flaw["mend"]
    assert answer.json["counts"][code] >= 1
    lines = run("check", write(text)).out.splitlines()
    assert any(line.startswith(f"warning: {code}") for line in lines)
    assert any(words in line for line in lines)


@pytest.mark.parametrize("mistake", MISTAKES)
def test_strict_makes_each_warning_status_3(run, write, mistake):
    answer = run("check", write(MISTAKES[mistake][0]), "--strict", "--json")
    assert (answer.status, answer.json["loads"], answer.json["passes"]) == (3, True, False)


def test_strict_passes_what_has_no_warning_and_what_is_only_a_note(run, write):
    assert run("check", "two_link", "--strict").status == 0
    beyond = write(pair(limit=LIMIT.replace('lower="-1"', 'lower="0.5"')))
    answer = run("check", beyond, "--strict", "--json")
    assert (answer.status, answer.json["counts"], answer.json["warnings"]) == (0, {"zero-outside-limits": 1}, [])
    assert "note: zero-outside-limits" in run("check", beyond).out.splitlines()


def test_a_summary_says_that_units_count_and_names_each_place_once(run, write):
    path = write(pair(limit='<limit lower="-90deg" upper="90deg"/>'))
    done = run("check", path)
    assert "joint 'j' (line 1): numbers have units; they are read in SI units" in done.out
    assert read(path).joints[0].upper == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("slip", ["axis_as_attribute", "origin_xyz_typo", "link_upper"])
def test_load_warns_about_what_changes_the_kinematics(slip):
    text, _, words, _ = MISTAKES[slip]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        pinik.load(text)
    assert any(words in str(one.message) and one.category is pinik.UrdfWarning for one in caught)


def test_a_mesh_a_hundred_times_as_large_as_the_robot_is_doubted(run, write, tmp_path):
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 300 0 0\nv 0 300 0\nv 0 0 300\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    mesh = '<visual><geometry><mesh filename="part.obj"{}/></geometry></visual>'
    text = robot(link("a", mesh), link("b"), joint("j", "a", "b", '<origin xyz="1 0 0"/>'))
    found = run("check", write(text.replace("{}", "")), "--json").json
    assert found["counts"] == {"shape-too-large": 1}
    assert "300 times larger" in found["flaws"][0]["cause"]
    assert run("check", write(text.replace("{}", ' scale="0.001 0.001 0.001"')), "--json").json["counts"] == {}
    small = mesh.replace("{}", ' scale="1e-7 1e-7 1e-7"') + "\n" + mesh.replace("{}", ' scale="1e-6 1e-6 1e-6"')
    tiny = run("check", write(text.replace(mesh, small)), "--json").json
    assert tiny["counts"] == {"shape-too-small": 1}
    assert tiny["flaws"][0]["line"] == 2  # of the largest


class TestFix:
    def test_the_copy_is_mended_and_the_file_stays(self, run, write, tmp_path):
        text = MISTAKES["origin_xyz_typo"][0]
        file, target = write(text), tmp_path / "mended.urdf"
        answer = run("check", file, "--fix", target, "--json")
        assert answer.status == 0
        fix = answer.json["fix"]
        assert (fix["written"], fix["fault"], fix["file"]) == (True, None, str(target))
        assert [flaw["code"] for flaw in fix["mended"]] == ["unknown-attribute"]
        assert file.read_text() == text
        assert target.read_text() == text.replace("xzy", "xyz")
        mended = pinik.load(target)
        np.testing.assert_allclose(mended.placement("b", mended.neutral()).translation, [0, 0, 0.1])
        assert run("check", target, "--json").json["counts"] == {}

    def test_what_was_mended_and_what_is_left_is_said(self, run, write, tmp_path):
        text = pair('<origin xzy="0 0 0.1"/>', limit=LIMIT.replace("1", "90"))
        lines = run("check", write(text), "--fix", tmp_path / "out.urdf").out.splitlines()
        assert f"{tmp_path / 'out.urdf'}: written; 1 flaw is mended; 1 flaw is left to you" in lines
        assert "  mended unknown-attribute: joint 'j' (line 1)" in lines
        assert any(line.startswith("  left limit-in-degrees: it has more than one answer") for line in lines)

    def test_slips_in_the_types_of_joints_are_mended(self, run, write, tmp_path):
        joints = [
            joint("j", "a", "b", kind="revolut"),
            joint("k", "b", "c", kind="Continuous"),
            joint("l", "c", "d", kind=" prismatc"),
        ]
        target = tmp_path / "out.urdf"
        file = write(robot(*map(link, "abcd"), *joints))
        answer = run("check", file, "--fix", target, "--json")
        assert [flaw["code"] for flaw in answer.json["fix"]["mended"]] == ["loose-type"] * 3
        kinds = {one.name: one.kind for one in pinik.load(target).description.joints}
        assert kinds == {"j": "revolute", "k": "continuous", "l": "prismatic"}

    def test_a_type_that_is_no_slip_is_left(self, run, write, tmp_path):
        answer = run("check", write(pair(kind="ball")), "--fix", tmp_path / "out.urdf", "--json")
        assert answer.json["fix"]["mended"] == []
        assert answer.json["counts"] == {}

    def test_commas_become_spaces_and_the_copy_loads_strictly(self, run, write, tmp_path):
        loose = pair('<origin xyz="0.1, 0, 0.3" rpy="1.57, 0 0"/>', limit=LIMIT)
        target = tmp_path / "out.urdf"
        assert run("check", write(loose), "--strict").status == 3
        answer = run("check", write(loose), "--fix", target, "--json")
        assert [flaw["code"] for flaw in answer.json["fix"]["mended"]] == ["loose-number"] * 2
        assert target.read_text() == loose.replace(",", "")
        assert run("check", target, "--strict").status == 0
        before, after = pinik.robot.Robot(read(loose)), pinik.load(target, strict=True)
        for angle in (-0.7, 0.0, 0.3):
            q = np.array([angle])
            np.testing.assert_array_equal(before.placement("b", q).homogeneous, after.placement("b", q).homogeneous)

    def test_a_urdf_on_stdin_is_mended_as_one_in_a_file(self, run, write, tmp_path):
        one, other = tmp_path / "one.urdf", tmp_path / "other.urdf"
        from_file = run("check", write(AXIS_AS_ATTRIBUTE), "--fix", one, "--json").json
        from_stdin = run("check", "-", "--fix", other, "--json", stdin=AXIS_AS_ATTRIBUTE).json
        assert one.read_bytes() == other.read_bytes()
        assert (from_stdin.pop("file"), from_file.pop("file")) == ("stdin", str(tmp_path / "robot.urdf"))
        assert (from_stdin["fix"].pop("file"), from_file["fix"].pop("file")) == (str(other), str(one))
        assert from_stdin == from_file

    def test_an_empty_name_is_refused_in_words(self, run, write):
        answer = run("check", write(AXIS_AS_ATTRIBUTE), "--fix", "")
        assert (answer.status, answer.out) == (2, "")
        assert "--fix must be the name of a file; an empty text" in answer.err

    @pytest.mark.parametrize("stdout", ["-", "./-", "/dev/stdout", "/dev/fd/1"])
    def test_stdout_is_refused_in_words_as_the_report_goes_there(self, run, write, tmp_path, monkeypatch, stdout):
        file = write(AXIS_AS_ATTRIBUTE)
        monkeypatch.chdir(tmp_path)
        answer = run("check", file, "--fix", stdout)
        assert (answer.status, answer.out) == (2, "")
        assert "--fix must be the name of a file, as stdout is for the report" in answer.err
        assert sorted(tmp_path.iterdir()) == [file]

    def test_a_file_called_stdin_is_a_file(self, run, tmp_path, monkeypatch):
        """A robot without a name is named after its file, and the file itself is never overwritten."""
        monkeypatch.chdir(tmp_path)
        (tmp_path / "stdin").write_text('<robot><link name="a"/></robot>')
        assert run("check", "./stdin", "--fix", "out.urdf").status == 0
        assert pinik.load(tmp_path / "out.urdf", strict=True).name == "stdin"
        assert run("check", "./stdin", "--fix", "stdin").status == 2
        assert run("check", "-", "--fix", "stdin", stdin='<robot name="other"><link name="a"/></robot>').status == 0
        assert pinik.load(tmp_path / "stdin").name == "other"

    def test_a_xacro_file_is_written_as_the_urdf_that_it_becomes(self, run, write, tmp_path):
        pytest.importorskip("xacrodoc")
        text = pair('<origin xzy="${two} 0, 0"/>', limit=LIMIT)
        text = text.replace('name="r">', f'name="r" {XACRO}><xacro:property name="two" value="2"/>', 1)
        file, target = write(text, "robot.urdf"), tmp_path / "out.urdf"
        answer = run("check", file, "--fix", target)
        assert file.read_text() == text
        assert "it is the URDF that xacro made of the file" in answer.out
        assert "the lines below are those of the URDF that xacro makes of the file" in answer.out
        np.testing.assert_array_equal(pinik.load(target, strict=True).description.joints[0].xyz, [2, 0, 0])
        assert run("check", file, "--fix", target, "--json").json["fix"]["expanded"] is True
        assert run("check", file, "--fix", file).status == 2

    def test_a_xacro_file_whose_urdf_cannot_be_loaded_until_it_is_mended_is_written(self, run, write, tmp_path):
        pytest.importorskip("xacrodoc")
        text = robot(link("a"), '<Link name="x"/>', joint("k", "a", "x", kind="fixed"))
        file, target = write(text, "robot.xacro"), tmp_path / "out.urdf"
        answer = run("check", file, "--fix", target, "--json")
        assert (answer.status, answer.json["fix"]["written"]) == (3, True)
        assert pinik.load(target).description.links == ("a", "x")

    def test_a_good_file_is_copied(self, run, write, tmp_path):
        text = pair('<axis xyz="0 0 1"/>', limit=LIMIT)
        target = tmp_path / "out.urdf"
        answer = run("check", write(text), "--fix", target)
        assert (answer.status, target.read_text()) == (0, text)
        assert f"{target}: written; no flaw is mended" in answer.out.splitlines()

    @pytest.mark.parametrize("way", ["itself", "link", "hard link"])
    def test_the_file_itself_is_never_overwritten(self, run, write, tmp_path, way):
        file, target = write(AXIS_AS_ATTRIBUTE), tmp_path / "other.urdf"
        if way == "itself":
            target = file
        elif way == "link":
            target.symlink_to(file)
        else:
            os.link(file, target)
        answer = run("check", file, "--fix", target)
        assert answer.status == 2
        assert "this is the file itself" in answer.err
        assert file.read_text() == AXIS_AS_ATTRIBUTE

    def test_the_file_of_a_robot_in_the_catalogue_is_never_overwritten(self, run, write, monkeypatch):
        file = write(AXIS_AS_ATTRIBUTE)
        monkeypatch.setattr("pinik.description.catalog._urdf_files", lambda: {"mine": file})
        answer = run("check", "mine", "--fix", file)
        assert (answer.status, "this is the file itself" in answer.err) == (2, True)
        assert file.read_text() == AXIS_AS_ATTRIBUTE

    def test_a_folder_that_is_not_there_is_wrong_usage(self, run, write, tmp_path):
        answer = run("check", write(AXIS_AS_ATTRIBUTE), "--fix", tmp_path / "gone" / "out.urdf")
        assert answer.status == 2
        assert "no such folder" in answer.err
        assert run("check", write(AXIS_AS_ATTRIBUTE), "--fix", tmp_path).status == 2

    def test_a_file_that_cannot_be_loaded_afterwards_is_not_written(self, run, write, tmp_path):
        target = tmp_path / "out.urdf"
        answer = run("check", write(robot(link("a"), link("b"))), "--fix", target, "--json")
        assert (answer.status, answer.json["fix"]["written"], target.exists()) == (3, False, False)
        assert "root links" in answer.json["fix"]["fault"]
        assert "not written" in run("check", write("no XML"), "--fix", target).out
        assert run("check", tmp_path / "none.urdf", "--fix", target, "--json").json["fix"]["written"] is False

    def test_a_write_that_fails_leaves_the_old_file_and_nothing_beside_it(self, run, write, tmp_path, monkeypatch):
        file, target = write(AXIS_AS_ATTRIBUTE), tmp_path / "out.urdf"
        target.write_text("old")

        def full(descriptor: int) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(mended_file.os, "fsync", full)
        answer = run("check", file, "--fix", target)
        assert answer.status == 2
        assert "No space left on device" in answer.err
        assert target.read_text() == "old"
        assert sorted(path.name for path in tmp_path.iterdir()) == ["out.urdf", "robot.urdf"]

    def test_a_copy_in_another_folder_says_that_its_relative_addresses_move(self, run, write, tmp_path):
        text = robot(link("a", '<visual><geometry><mesh filename="part.stl"/></geometry></visual>'))
        (tmp_path / "elsewhere").mkdir()
        there = run("check", write(text), "--fix", tmp_path / "elsewhere" / "out.urdf").out
        assert "it is not beside the original: relative addresses of meshes begin at " in there
        assert "relative addresses" not in run("check", write(text), "--fix", tmp_path / "out.urdf").out


class TestAttackers:
    """Files of a few MB made to hold the check up, or to fill the terminal."""

    def checked(self, run, file):
        begin = time.monotonic()
        person = run("check", file)
        answer = run("check", file, "--json")
        assert time.monotonic() - begin < 2 * SECONDS
        assert len(person.out) < 10_000
        assert len(answer.out) < 3_000_000
        return answer.json

    def test_thousands_of_missing_meshes(self, run, write):
        meshes = "".join(
            f'<visual><geometry><mesh filename="package://nope/m{i}.stl"/></geometry></visual>' for i in range(5000)
        )
        found = self.checked(run, write(robot(link("a", meshes))))
        assert found["counts"] == {"missing-mesh": 5000}
        assert len(found["missing_meshes"]) == len(found["flaws"]) == 1000

    def test_thousands_of_boxes(self, run, write):
        boxes = "".join(f'<visual><geometry><box size="1 1 {1 + i}"/></geometry></visual>' for i in range(5000))
        assert self.checked(run, write(robot(link("a", boxes))))["shapes"] == 5000

    def test_thousands_of_capsules(self, run, write):
        capsule = '<visual><geometry><capsule radius="1" length="{}"/></geometry></visual>'
        capsules = "".join(capsule.format(1 + i) for i in range(5000))
        assert self.checked(run, write(robot(link("a", capsules))))["shapes"] == 5000

    def test_thousands_of_slips(self, run, write):
        slips = "".join(
            f'<visual><orign xyz="{i} 0 0"/></visual><Link{i} a="b"/><visual><Origin/></visual>' for i in range(5000)
        )
        found = self.checked(run, write(robot(link("a", slips))))
        assert found["counts"]["unknown-element"] == 10_000

    def test_names_of_megabytes(self, run, write):
        name = "n" * 1_000_000
        parts = [f'<{name} name="{name}"/>', link(name, f'<visual {name}="1"><{name}/></visual>')]
        self.checked(run, write(robot(*parts, link("b"), joint(name, name, "b", f'<origin {name}="1"/>'))))


def test_the_statuses_are_those_of_the_document():
    assert command.check.__doc__ is not None
    assert "status is 3" in " ".join(command.check.__doc__.split())
    assert ExitStatus.NO_ROBOT == 3
