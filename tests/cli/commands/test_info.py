from __future__ import annotations

import pinocchio
import pytest

import pinik
from urdf_texts import joint, link, robot


def test_joints_with_kind_unit_limits_and_leader(run):
    answer = run("info", "panda", "--json").json
    joints = {joint["name"]: joint for joint in answer["joints"]}
    assert joints["panda_joint1"] == {
        "name": "panda_joint1",
        "kind": "revolute",
        "unit": "rad",
        "lower": -2.8973,
        "upper": 2.8973,
        "axis": [0.0, 0.0, 1.0],
        "mimics": None,
    }
    assert joints["panda_finger_joint2"]["unit"] == "m"
    assert joints["panda_finger_joint2"]["mimics"] == "panda_finger_joint1"
    assert joints["panda_finger_joint2"]["upper"] == 0.04
    assert answer["mimics"]["panda_finger_joint2"] == {
        "leader": "panda_finger_joint1",
        "multiplier": 1.0,
        "offset": 0.0,
    }


def test_a_joint_without_limits_has_null(run):
    joints = run("info", "double_pendulum_continuous", "--json").json["joints"]
    assert {(joint["kind"], joint["lower"], joint["upper"]) for joint in joints} == {("continuous", None, None)}
    assert "∞" in run("info", "double_pendulum_continuous").out


def test_a_follower_with_multiplier_0_has_its_offset_for_both_limits(run, tmp_path):
    text = robot(
        *map(link, "abc"),
        joint("lead", "a", "b", kind="continuous", limit=""),
        joint("tail", "b", "c", '<mimic joint="lead" multiplier="0" offset="0.25"/>'),
    )
    file = tmp_path / "still.urdf"
    file.write_text(text)
    joints = {fields["name"]: fields for fields in run("info", file, "--json").json["joints"]}
    assert (joints["lead"]["lower"], joints["lead"]["upper"]) == (None, None)
    assert (joints["tail"]["lower"], joints["tail"]["upper"]) == (0.25, 0.25)


def test_a_floating_root_has_neither_unit_nor_limits(run):
    root = run("info", "lion", "--root", "free_flyer", "--json").json["joints"][0]
    assert (root["name"], root["kind"], root["unit"], root["lower"]) == ("root_joint", "floating", None, None)


def test_frames_poses_and_versions(run):
    answer = run("info", "arm", "--json").json
    robot = pinik.load("arm")
    assert answer["frames"] == list(robot.frame_names)
    assert set(answer["poses"]) == set(robot.poses)
    assert answer["poses"]["reach"]["angles"] == pytest.approx(robot.angles(robot.poses["reach"]))
    assert (answer["version"], answer["pinocchio"]) == (pinik.__version__, pinocchio.__version__)
    assert (answer["nq"], answer["nv"]) == (robot.model.nq, robot.model.nv)


def test_like_warnings_are_one_line_on_stderr_and_all_in_the_json(run):
    assert run("info", "romeo", "--json").json["warnings"] == []
    quadruped = run("info", "quadruped", "--json")
    (line,) = quadruped.err.splitlines()
    assert [line.count(f"joint '{leg}_KFE' (line ") for leg in ("FL", "FR", "BL", "BR")] == [1, 1, 1, 1]
    assert len(quadruped.json["warnings"]) == 4


def test_a_robot_comes_from_stdin(run):
    text = pinik.load("two_link").description.path.read_text()
    assert run("info", "-", "--json", stdin=text).json["joints"] == run("info", "two_link", "--json").json["joints"]
    refused = run("info", "-", stdin="<sdf/>")
    assert (refused.status, refused.out) == (3, "")
    assert "error: stdin: <sdf>: the root element is <sdf>: this is an SDF file" in refused.err


def test_it_calls_stdin_as_check_does(run):
    text = '<robot name="r"><link name="a"/></robot>'
    info, check = (run(command, "-", "--json", stdin=text).json for command in ("info", "check"))
    assert info["source"] == check["file"] == "stdin"
    assert run("info", "-", stdin=text).out.startswith("r  stdin\n")


def test_a_bad_pose_is_a_warning_and_all_the_rest_is_shown(run, tmp_path):
    arm = pinik.load("arm").description.path
    (tmp_path / "mine.urdf").write_bytes(arm.read_bytes())
    pose = '<group_state name="home" group="g"><joint name="bone1_x" value="nan"/></group_state>'
    (tmp_path / "mine.srdf").write_text(f'<robot name="arm">{pose}</robot>')
    for options in ([], ["--json"]):
        shown = run("info", tmp_path / "mine.urdf", *options)
        assert shown.status == 0
        assert "pose 'home', joint 'bone1_x': its value must be a number" in shown.err
    assert shown.json["poses"] == {}


def test_the_tables_name_everything(run):
    text = run("info", "arm").out
    robot = pinik.load("arm")
    for name in (*robot.joint_names, *robot.frame_names, *robot.poses):
        assert name in text
    assert "0.78540" in text
    assert "45.000" in run("info", "arm", "--deg").out
    assert pinocchio.__version__ in text


def test_a_robot_without_joints(run):
    assert run("info", "hector").status == 0
    assert run("info", "hector", "--json").json["joints"] == []
