from __future__ import annotations

import importlib
import json
import math
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pinocchio
import pytest

import pinik
from pinik.description.catalog import find

ARM = ("solve", "arm", "--frame", "tip")


def placement_by_pinocchio(robot: str, frame: str, angles: dict[str, float]) -> pinocchio.SE3:
    """The frame's placement by Pinocchio alone, from the file and the angles by name."""
    model = pinocchio.buildModelFromUrdf(str(find(robot).urdf))
    q = pinocchio.neutral(model)
    for name, angle in angles.items():
        q[model.joints[model.getJointId(name)].idx_q] = angle
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    return data.oMf[model.getFrameId(frame, pinocchio.BODY)]


def test_the_angles_put_the_frame_at_the_position(run):
    answer = run(*ARM, "--position", 0.3, 0.1, 0.8, "--json").json
    tip = placement_by_pinocchio("arm", "tip", answer["angles"])
    missed = np.linalg.norm(tip.translation - [0.3, 0.1, 0.8])
    assert missed < 1e-4
    assert answer["position_error_m"] == pytest.approx(missed, abs=1e-12)


@pytest.mark.parametrize("method", list(pinik.SOLVERS))
def test_every_method_is_found_by_its_name(run, method):
    answer = run(*ARM, "--position", 0.2, 0.2, 0.7, "--method", method, "--json").json
    assert answer["method"] == method
    assert answer["success"]


def test_negative_numbers_are_values_not_options(run):
    result = run(*ARM, "--position", -0.3, -0.1, 0.8, "--json")
    tip = placement_by_pinocchio("arm", "tip", result.json["angles"])
    assert np.linalg.norm(tip.translation - [-0.3, -0.1, 0.8]) < 1e-4


def test_degrees_and_radians_ask_for_the_same_orientation(run):
    position = ("--position", -0.3, 0.2, 0.5)
    in_degrees = run("solve", "ur5", "--frame", "tool0", *position, "--rpy", 180, 0, 90, "--deg", "--json").json
    half, quarter = math.pi, math.pi / 2
    in_radians = run("solve", "ur5", "--frame", "tool0", *position, "--rpy", half, 0, quarter, "--json").json
    assert in_degrees["angles"] == in_radians["angles"]
    tool = placement_by_pinocchio("ur5", "tool0", in_degrees["angles"])
    wanted = pinocchio.rpy.rpyToMatrix(math.pi, 0.0, math.pi / 2)
    assert np.linalg.norm(pinocchio.log3(wanted @ tool.rotation.T)) < 1e-3


def test_a_quaternion_asks_for_an_orientation(run):
    options = ("--position", 0.4, 0.1, 0.5, "--quat-xyzw", 1, 0, 0, 0)
    answer = run("solve", "panda", "--frame", "panda_hand", *options, "--json").json
    assert answer["success"]
    assert np.allclose(answer["targets"][0]["rotation"], np.diag([1.0, -1.0, -1.0]))


@pytest.mark.parametrize("goal", [("--direction", 1, 0, -0.2), ("--at", 2, 0.5, 0.3)])
def test_an_axis_points_along_a_direction_or_at_a_point(run, goal):
    answer = run("solve", "lion", "--frame", "nose", "--axis", "x", *goal, "--json").json
    nose = placement_by_pinocchio("lion", "nose", answer["angles"])
    direction = np.array(goal[1:]) - (nose.translation if goal[0] == "--at" else 0.0)
    axis = nose.rotation[:, 0]
    assert math.atan2(np.linalg.norm(np.cross(axis, direction)), axis @ direction) < 1e-3
    assert answer["position_error_m"] is None


def test_the_tool_is_the_point_that_arrives(run):
    answer = run(*ARM, "--position", 0.3, 0.1, 0.8, "--tool", 0, 0, 0.1, "--json").json
    tip = placement_by_pinocchio("arm", "tip", answer["angles"])
    assert np.linalg.norm(tip.act(np.array([0.0, 0.0, 0.1])) - [0.3, 0.1, 0.8]) < 1e-4


def test_a_target_relative_to_a_moving_frame(run):
    robot = pinik.load("arm")
    there = robot.placement("tip", robot.poses["reach"], "bone3_x").translation
    answer = run(*ARM, "--position", *there, "--relative-to", "bone3_x", "--json").json
    bone = robot.placement("bone3_x", answer["q"])
    tip = placement_by_pinocchio("arm", "tip", answer["angles"])
    assert np.linalg.norm(bone.actInv(tip).translation - there) < 1e-4


def test_several_targets_come_from_a_file(run, tmp_path):
    targets = [
        {"frame": "left_fore_paw", "position": [0.35, 0.15, -0.4]},
        {"frame": "nose", "axis": "x", "at": [2, 0.5, 0.3], "weight": 0.5},
    ]
    robot = pinik.load("lion")
    targets[0]["position"] = (robot.placement("left_fore_paw", robot.poses["relaxed"]).translation + 0.02).tolist()
    file = tmp_path / "targets.json"
    file.write_text(json.dumps(targets))
    from_file = run("solve", "lion", "--targets", file, "--json")
    from_stdin = run("solve", "lion", "--targets", "-", "--json", stdin=json.dumps({"targets": targets}))
    assert from_file.status == 0
    assert from_file.json["angles"] == from_stdin.json["angles"]
    assert [target["frame"] for target in from_file.json["targets"]] == ["left_fore_paw", "nose"]


def test_a_start_and_locked_joints_are_kept(run):
    options = ("--start", "bone1_x=20", "--start", "bone2_z=-10", "--deg", "--lock", "bone1_x", "--lock", "bone2_z")
    angles = run(*ARM, "--position", 0.1, -0.2, 0.9, *options, "--json").json["angles"]
    assert angles["bone1_x"] == pytest.approx(math.radians(20), abs=1e-15)
    assert angles["bone2_z"] == pytest.approx(math.radians(-10), abs=1e-15)


def test_a_sliding_joint_starts_in_metres_also_with_degrees(run):
    options = ("--position", 0.4, 0.1, 0.5, "--start", "panda_finger_joint1=0.02", "--deg", "--json")
    angles = run("solve", "panda", "--frame", "panda_hand", *options).json["angles"]
    assert angles["panda_finger_joint1"] == 0.02
    assert angles["panda_finger_joint2"] == 0.02


def test_a_named_pose_is_the_start_and_start_options_go_on_top(run):
    there = pinik.load("arm")
    reached = there.placement("tip", there.poses["reach"]).translation
    answer = run(*ARM, "--position", *reached, "--pose", "reach", "--json").json
    assert answer["iterations"] == 0
    assert answer["q"] == pytest.approx(there.poses["reach"], abs=1e-12)
    moved = run(*ARM, "--position", *reached, "--pose", "reach", "--start", "bone1_x=0", "--json").json
    assert moved["iterations"] > 0


def test_a_start_keeps_the_turns_of_a_continuous_joint(run, tmp_path):
    file = tmp_path / "wheel.urdf"
    file.write_text(
        '<robot name="wheel"><link name="a"/><link name="b"/><link name="c"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint><joint name="k" type="fixed">'
        '<parent link="b"/><child link="c"/><origin xyz="1 0 0"/></joint></robot>'
    )
    place = ("--position", math.cos(3.35), math.sin(3.35), 0)
    for start, expected in ((3.3, 3.35), (3.3 - 4 * math.pi, 3.35 - 4 * math.pi)):
        answer = run("solve", file, "--frame", "c", *place, "--start", f"j={start}", "--json").json
        assert answer["angles"]["j"] == pytest.approx(expected, abs=1e-6)
    turns = run("solve", file, "--frame", "c", *place, "--start", "j=520", "--deg", "--json").json["angles"]["j"]
    assert turns == pytest.approx(3.35 + 2 * math.pi, abs=1e-6)


def test_choose_takes_the_nearest_answer_and_says_of_how_many(run):
    there = pinik.load("two_link")
    position = there.placement("tip", there.configuration({"joint1": 0.5, "joint2": 1.2})).translation
    place = ("solve", "two_link", "--frame", "tip", "--position", *position, "--choose", "nearest")
    first, other = "joint1", "joint2"
    changes = {}
    for heavy in (first, other):
        answer = run(*place, "--choose-weight", f"{heavy}=100", "--json").json
        assert answer["success"]
        assert answer["chosen_from"] == 2
        changes[heavy] = {name: abs(answer["angles"][name]) for name in (first, other)}
    assert changes[first][first] <= changes[other][first] + 1e-6
    assert changes[other][other] <= changes[first][other] + 1e-6
    assert run(*place, "--choose-weight", "joint3=2").err.startswith("error: no joint 'joint3'")
    assert run(*place, "--choose-weight", "joint2=x").status == 2
    assert run(*place, "--choose-weight", "joint2=-1").status == 2


def test_no_polish_stops_at_the_tolerance(run):
    place = ("solve", "panda", "--frame", "panda_hand_tcp", "--position", 0.4, 0.1, 0.5, "--json")
    polished, plain = run(*place).json, run(*place, "--no-polish").json
    assert polished["position_error_m"] < 1e-8 < plain["position_error_m"]
    assert plain["iterations"] < polished["iterations"]


def test_solver_parameters_are_json_or_words(run):
    options = ("--method", "ccd", "--param", 'stiffness={"bone1_x": 0.2}', "--param", "scaling=printed")
    parameters = run(*ARM, "--position", 0.3, 0.1, 0.8, *options, "--json").json["parameters"]
    assert parameters["stiffness"] == {"bone1_x": 0.2}
    assert parameters["scaling"] == "printed"


def test_loop_options_arrive(run):
    options = ("--max-iterations", 1, "--restarts", 0, "--tolerance", 1e-9, 1e-9, "--seed", 7, "--time-limit", 5)
    answer = run(*ARM, "--position", 0.3, 0.1, 0.8, *options, "--engine", "python", "--json").json
    assert (answer["iterations"], answer["restarts"], answer["status"]) == (1, 0, "MAX_ITERATIONS")


def test_limits_can_be_left(run):
    far = ("solve", "two_link", "--frame", "tip", "--json")
    robot = pinik.load("two_link")
    beyond = robot.placement("tip", robot.configuration(dict(zip(robot.joint_names, robot.upper + 0.3, strict=True))))
    answer = run(*far, "--position", *beyond.translation, "--no-limits").json
    assert answer["success"]
    assert answer["active_limits"] == []


def test_a_free_root_is_part_of_the_answer(run):
    answer = run(*ARM, "--position", 3, 3, 3, "--root", "free_flyer", "--json").json
    assert answer["success"]
    assert np.shape(answer["joint_placements"]["root_joint"]) == (4, 4)


def test_a_missed_target_still_has_its_best_answer_and_says_why(run):
    machine = run(*ARM, "--position", 0, 0, 3, "--json")
    assert machine.status == 1
    assert machine.json["status"] == "UNREACHABLE"
    assert len(machine.json["angles"]) == 12
    person = run(*ARM, "--position", 0, 0, 3)
    assert person.status == 1
    assert person.out.splitlines()[0] == machine.json["message"]


def test_the_json_is_the_solution(run):
    robot = pinik.load("arm")
    expected = robot.solve("tip", [0.3, 0.1, 0.8]).to_dict()
    answer = run(*ARM, "--position", 0.3, 0.1, 0.8, "--json").json
    assert list(answer) == list(expected)
    assert answer | {"time_s": 0} == expected | {"time_s": 0}


def test_the_table_shows_the_angles_of_the_json(run):
    options = (*ARM, "--position", 0.3, 0.1, 0.8)
    angles = run(*options, "--json").json["angles"]
    for in_degrees, digits in ((False, 5), (True, 3)):
        lines = run(*options, *(["--deg"] if in_degrees else [])).out.splitlines()
        cells = {line.split()[0]: line.split()[1:3] for line in lines if line.startswith("bone")}
        assert set(cells) == set(angles)
        for name, (value, unit) in cells.items():
            expected = math.degrees(angles[name]) if in_degrees else angles[name]
            assert float(value) == pytest.approx(expected, abs=0.51 * 10**-digits)
            assert unit == ("deg" if in_degrees else "rad")


def test_a_joint_at_its_limit_is_marked(run):
    result = run("solve", "two_link", "--frame", "tip", "--position", 0.05, 0, 0, "--restarts", 0)
    answer = run("solve", "two_link", "--frame", "tip", "--position", 0.05, 0, 0, "--restarts", 0, "--json").json
    marked = [line.split()[0] for line in result.out.splitlines() if line.endswith(("lower limit", "upper limit"))]
    assert [name for name in marked if name in answer["angles"]] == answer["active_limits"]


WRONG = {
    "nothing asked for": ((*ARM,), "no target; give --position, --rpy"),
    "no frame": (("solve", "arm", "--position", 0, 0, 1), "--frame"),
    "unknown frame": (
        ("solve", "arm", "--frame", "tipp", "--position", 0, 0, 1),
        "no frame 'tipp'; did you mean 'tip'",
    ),
    "NaN": ((*ARM, "--position", "nan", 0, 1), "finite"),
    "infinity": ((*ARM, "--position", "inf", 0, 1), "error: --position must be 3 finite numbers"),
    "a word": ((*ARM, "--position", "a", 0, 1), "with - for an axis that is free; got a 0 1; see 'pinik solve --help'"),
    "two numbers": ((*ARM, "--position", 0, 1), "'--position' requires 3 arguments; see 'pinik solve --help'"),
    "a zero direction": ((*ARM, "--axis", "x", "--direction", 0, 0, 0), "direction"),
    "an unknown axis": ((*ARM, "--axis", "w", "--direction", 0, 0, 1), "axis"),
    "an axis without direction": ((*ARM, "--axis", "x"), "--axis needs --direction or --at"),
    "a direction without axis": ((*ARM, "--direction", 0, 0, 1), "--axis needs --direction or --at"),
    "two directions": ((*ARM, "--axis", "x", "--direction", 0, 0, 1, "--at", 0, 0, 1), "--direction or --at, not both"),
    "half a seed": ((*ARM, "--position", 0, 0, 1, "--seed", "0.5"), "'0.5' is not a whole number"),
    "no such folder": (
        (*ARM, "--position", 0, 0, 1, "--package-dir", "/no/such"),
        "--package-dir /no/such: no such folder",
    ),
    "two orientations": ((*ARM, "--rpy", 0, 0, 0, "--quat-xyzw", 0, 0, 0, 1), "got --rpy and --quat-xyzw"),
    "an unknown method": ((*ARM, "--position", 0, 0, 1, "--method", "dsl"), "no method 'dsl'; did you mean 'dls'"),
    "an unknown parameter": ((*ARM, "--position", 0, 0, 1, "--param", "dampin=1"), "did you mean 'damping'"),
    "a parameter out of range": ((*ARM, "--position", 0, 0, 1, "--param", "damping=-1"), "damping"),
    "a parameter that is no number": ((*ARM, "--position", 0, 0, 1, "--param", "damping=nan"), "damping"),
    "a parameter without value": ((*ARM, "--position", 0, 0, 1, "--param", "damping"), "NAME=VALUE"),
    "a parameter named as a keyword": ((*ARM, "--position", 0, 0, 1, "--param", "method=dls"), "no parameter"),
    "a stiffness of no joint": (
        (*ARM, "--position", 0, 0, 1, "--method", "ccd", "--param", 'stiffness={"bone9": 1}'),
        "no joint 'bone9'",
    ),
    "a start of no joint": ((*ARM, "--position", 0, 0, 1, "--start", "bone=1"), "no joint 'bone'"),
    "a start that is NaN": ((*ARM, "--position", 0, 0, 1, "--start", "bone1_x=nan"), "finite"),
    "a start given twice": (
        (*ARM, "--position", 0, 0, 1, "--start", "bone1_x=1", "--start", "bone1_x=2"),
        "given twice",
    ),
    "a lock of no joint": ((*ARM, "--position", 0, 0, 1, "--lock", "bone"), "no joint 'bone'"),
    "an unknown pose": ((*ARM, "--position", 0, 0, 1, "--pose", "relax"), "did you mean 'relaxed'"),
    "an unknown root": ((*ARM, "--position", 0, 0, 1, "--root", "free"), "root"),
    "an unknown engine": ((*ARM, "--position", 0, 0, 1, "--engine", "nativ"), "no engine 'nativ'"),
    "a negative tolerance": ((*ARM, "--position", 0, 0, 1, "--tolerance", -1, 1), "tolerance"),
    "no iterations": (
        (*ARM, "--position", 0, 0, 1, "--max-iterations", 0),
        "--max-iterations must be a whole number of at least 1; got 0",
    ),
    "negative restarts": (
        (*ARM, "--position", 0, 0, 1, "--restarts", -1),
        "--restarts must be a whole number of at least 0; got -1",
    ),
    "no time": ((*ARM, "--position", 0, 0, 1, "--time-limit", 0), "--time-limit must be a positive number of seconds"),
    "NaN seconds": ((*ARM, "--position", 0, 0, 1, "--time-limit", "nan"), "--time-limit must be a finite number"),
    "an unknown option": ((*ARM, "--postion", 0, 0, 1), "--position"),
    "a file and a target": ((*ARM, "--targets", "-"), "put --frame into it"),
    "no robot": (("solve",), "ROBOT"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input_is_one_line_on_stderr_and_status_2(run, case):
    arguments, words = WRONG[case]
    result = run(*arguments)
    assert (result.status, result.out) == (2, "")
    assert result.err.startswith("error: ")
    assert result.err.count("\n") == 1
    assert words in result.err


BAD_TARGETS = {
    "a key twice": ('[{"frame": "tip", "frame": "base", "position": [0, 0, 1]}]', "duplicate key 'frame'"),
    "hundreds": ("[" + ", ".join(['{"frame": "tip", "position": [0, 0, 1]}'] * 101) + "]", "at most 100 targets"),
    "a truth value": ('[{"frame": "tip", "position": [0, 0, true]}]', "target 0: target 'tip': position"),
    "no JSON": ("[", "not JSON"),
    "empty": ("", "not JSON"),
    "too deep": ("[" * 100_000, "not JSON"),
    "no targets": ("[]", "there are no targets"),
    "another object": ('{"frame": "tip"}', "'frame'"),
    "no list": ('{"targets": 3}', "got 3"),
    "no object": ("[1]", "target 0: "),
    "no frame": ('[{"position": [0, 0, 1]}]', "target 0: a target must name its frame"),
    "a misspelt key": ('[{"frame": "tip", "postion": [0, 0, 1]}]', "target 0: no target keyword 'postion'"),
    "NaN": ('[{"frame": "tip", "position": [0, 0, NaN]}]', "target 0: target 'tip': position"),
    "a word": ('[{"frame": "tip", "position": "x"}]', "target 0: target 'tip': position"),
    "an unknown frame": (
        '[{"frame": "tip", "position": [0, 0, 1]}, {"frame": "tipp", "position": [0, 0, 1]}]',
        "target 1: frame: no frame 'tipp'; did you mean 'tip'",
    ),
    "an unknown reference": (
        '[{"frame": "tip", "position": [0, 0, 1], "relative_to": "bas"}]',
        "target 0: relative_to: no frame 'bas'",
    ),
}


@pytest.mark.parametrize("case", BAD_TARGETS)
def test_a_bad_target_is_named_by_file_index_and_key(run, tmp_path, case):
    text, words = BAD_TARGETS[case]
    file = tmp_path / "targets.json"
    file.write_text(text)
    result = run("solve", "arm", "--targets", file)
    assert (result.status, result.out) == (2, "")
    assert result.err.startswith(f"error: {file}: {words}" if words.startswith("target") else f"error: {file}: ")
    assert words in result.err
    assert result.err.count("\n") == 1


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="needs /dev/zero")
def test_an_endless_targets_file_is_refused_in_words(run):
    result = run("solve", "arm", "--targets", "/dev/zero")
    assert (result.status, result.out) == (2, "")
    assert result.err == "error: /dev/zero: a file of targets must not be larger than 16 MB\n"


def test_a_start_outside_the_limits_is_said_and_moved_inside(run):
    options = ("--position", 0.3, 0.1, 0.8, "--start", "bone1_x=90", "--deg")
    inside = run(*ARM, *options, "--json")
    assert inside.err == "note: --start bone1_x=90 is outside the limits -45.000 … 45.000 deg; moved inside\n"
    assert inside.status == 0
    assert run(*ARM, *options, "--no-limits").err == ""


def write_solver(folder: Path, body: str, before: str = "") -> None:
    """my_solver.py, whose class has this in `direction`."""
    (folder / "my_solver.py").write_text(
        f"{before}\nfrom dataclasses import dataclass\nimport pinik\n\n"
        "@dataclass(frozen=True, kw_only=True)\nclass Mine(pinik.JacobianSolver):\n"
        f"    name = 'mine'\n    def direction(self, J, e):\n        {body}\n"
    )


@pytest.mark.parametrize("command", [["pinik"], [sys.executable, "-m", "pinik"]], ids=["script", "module"])
def test_a_method_is_found_in_the_current_directory(environment, tmp_path, command):
    write_solver(tmp_path, "return 0.5 * J.T @ e")
    program = shutil.which(command[0], path=sysconfig.get_path("scripts")) or command[0]
    done = subprocess.run(
        [program, *command[1:], *ARM, "--position", "0.2", "0.1", "1.0", "--method", "my_solver:Mine", "--json"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert done.stderr == b""
    assert json.loads(done.stdout)["method"] == "mine"


@pytest.mark.parametrize(
    ("body", "before", "words"),
    [
        ("return 1 / 0", "", "the solver failed: ZeroDivisionError: division by zero"),
        ("raise SystemExit(0)", "", "the solver failed: SystemExit: 0"),
        ("return 0", "raise OSError('no\\nlicence')", "cannot import its module: OSError: no licence"),
        ("return 0", "raise SystemExit(0)", "cannot import its module: SystemExit: 0"),
        ("return 0 +", "", "cannot import its module: SyntaxError: "),
    ],
)
def test_whatever_a_users_solver_raises_is_one_sentence(run, tmp_path, monkeypatch, body, before, words):
    write_solver(tmp_path, body, before)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    importlib.invalidate_caches()
    result = run(*ARM, "--position", 0.3, 0.1, 0.8, "--method", "my_solver:Mine")
    sys.modules.pop("my_solver", None)
    assert (result.status, result.out) == (2, "")
    assert result.err.startswith(f"error: --method my_solver:Mine: {words}")
    assert result.err.count("\n") == 1


def test_what_nobody_foresaw_is_one_sentence_too(run, monkeypatch):
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError("oh\nno")

    monkeypatch.setattr(sys.modules["pinik.cli.commands.solve"], "solve_targets", fail)
    result = run(*ARM, "--position", 0.3, 0.1, 0.8)
    assert result == (2, "", "error: unexpected, please report it: ZeroDivisionError: oh no\n")


def test_a_missing_targets_file_is_bad_input(run, tmp_path):
    result = run("solve", "arm", "--targets", tmp_path / "none.json")
    assert (result.status, result.out) == (2, "")
    assert "No such file" in result.err


@pytest.mark.parametrize("source", ["armm", "none.urdf", str(Path(sys.executable))])
def test_a_robot_that_cannot_be_loaded_is_status_3(run, source):
    result = run("solve", source, "--frame", "tip", "--position", 0, 0, 1)
    assert (result.status, result.out) == (3, "")
    assert result.err.startswith("error: ")
    assert "Traceback" not in result.err


def test_a_rounded_rotation_in_a_file_is_a_warning_in_one_line_on_stderr(run, tmp_path):
    turn = [[0.86603, -0.5, 0.0], [0.5, 0.86603, 0.0], [0.0, 0.0, 1.0]]
    file = tmp_path / "targets.json"
    file.write_text(json.dumps([{"frame": "tip", "rotation": turn}]))
    answer = run("solve", "arm", "--targets", file, "--json")
    (line,) = answer.err.splitlines()
    where = f"warning: {file}: target 0: target 'tip': rotation is replaced by the nearest rotation matrix"
    assert line == f"{where}; the largest change of an entry is 3e-06"  # 0.86603 · (1 − 1 / √(0.86603² + 0.25))
    expected = [[3**0.5 / 2, -0.5, 0.0], [0.5, 3**0.5 / 2, 0.0], [0.0, 0.0, 1.0]]
    np.testing.assert_allclose(answer.json["targets"][0]["rotation"], expected, atol=2e-6)
