"""`pinik track`: paths read from CSV and JSON Lines, joint angles written as either."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pinocchio
import pytest

import pinik
from judge import judge
from pinik import Target
from robots import load_quietly

EXAMPLES = Path(__file__).parents[3] / "examples"
CIRCLE = EXAMPLES / "circle.csv"
PANDA = ("track", "panda", CIRCLE, "--frame", "panda_hand_tcp", "--pose", "default")
JUMP = (
    "track",
    "two_link",
    EXAMPLES / "jump.csv",
    "--frame",
    "tip",
    "--start",
    "joint1=-2.64",
    "--start",
    "joint2=1.5",
)


def table(text):
    """(titles, numbers (N, columns)) of CSV."""
    rows = list(csv.reader(io.StringIO(text)))
    return rows[0], np.array(rows[1:], dtype=float)


def targets_in(path):
    """The targets of a file with positions and quaternions, read here by hand."""
    _, numbers = table(path.read_text())
    return [Target("panda_hand_tcp", row[:3], quat_xyzw=row[3:7]) for row in numbers]


def test_the_angles_of_every_line_put_the_frame_there(run):
    result = run(*PANDA)
    assert result.status == 0
    assert "101 of 101 points reached" in result.err
    titles, numbers = table(result.out)
    robot = load_quietly("panda")
    assert titles == ["t", *robot.joint_names]
    assert numbers[:, 0] == pytest.approx(0.04 * np.arange(101))
    for row, target in zip(numbers, targets_in(CIRCLE), strict=True):
        q = robot.configuration(dict(zip(titles[1:], row[1:], strict=True)))
        assert judge(robot, target, q).are_within()


def test_degrees_are_read_and_written_with_deg(run):
    line = "x,y,z,roll,pitch,yaw\n0.307,0,0.487,{},0,0\n"
    common = ("--frame", "panda_hand_tcp", "--pose", "default")
    degrees = run("track", "panda", "-", *common, "--deg", stdin=line.format(180))
    radians = run("track", "panda", "-", *common, stdin=line.format(np.pi))
    assert degrees.status == radians.status == 0
    _, in_degrees = table(degrees.out)
    _, in_radians = table(radians.out)
    assert np.radians(in_degrees[0, :7]) == pytest.approx(in_radians[0, :7])
    assert in_degrees[0, 7] == in_radians[0, 7]  # a finger slides


def test_a_jump_is_told_on_stderr_and_by_the_status(run):
    result = run(*JUMP)
    assert result.status == 1
    assert "41 of 41 points reached" in result.err
    assert "joint1 came to its lower limit" in result.err
    titles, numbers = table(result.out)
    assert titles == ["t", "joint1", "joint2"]
    assert len(numbers) == 41


def test_a_miss_has_status_1_and_can_end_the_path(run):
    path = "x,y,z\n0.5,0.2,0\n0.6,0.2,0\n5,5,0\n0.5,0.2,0\n"
    held = run("track", "two_link", "-", "--frame", "tip", "--start", "joint2=1", stdin=path)
    assert held.status == 1
    assert len(table(held.out)[1]) == 4
    stopped = run("track", "two_link", "-", "--frame", "tip", "--start", "joint2=1", "--on-miss", "stop", stdin=path)
    assert stopped.status == 1
    assert len(table(stopped.out)[1]) == 3
    assert "the miss is at 2" in stopped.err


def test_json_lines_are_read_and_written(run, tmp_path):
    robot = load_quietly("arm")
    rng = np.random.default_rng(1)
    q = robot.random(rng)
    step = 0.02 * rng.normal(size=robot.model.nv)
    places = [robot.placement("tip", pinocchio.integrate(robot.model, q, k * step)) for k in range(5)]
    lines = [
        json.dumps({"frame": "tip", "placement": places[0].homogeneous.tolist(), "t": 0}),
        json.dumps({"placement": places[1].homogeneous.tolist(), "t": 0.5}),
        json.dumps({"targets": [{"placement": places[2].homogeneous.tolist()}], "t": 1}),
    ]
    target = tmp_path / "angles.jsonl"
    starts = [word for name, angle in robot.angles(q).items() for word in ("--start", f"{name}={angle}")]
    result = run("track", "arm", "-", "--frame", "tip", *starts, "--output", target, stdin="\n".join(lines))
    assert result.status == 0, result.err
    assert result.out == ""
    answers = [json.loads(line) for line in target.read_text().splitlines()]
    assert [answer["t"] for answer in answers] == [0.0, 0.5, 1.0]
    for place, answer in zip(places, answers, strict=False):
        assert answer["status"] == "CONVERGED"
        assert judge(robot, Target("tip", placement=place), robot.configuration(answer["angles"])).are_within()


def test_bare_positions_and_placements_are_places_for_the_frame(run):
    result = run(
        "track", "two_link", "-", "--frame", "tip", "--start", "joint2=1", stdin="[0.5, 0.2, 0]\n[0.52, 0.2, 0]\n"
    )
    assert result.status == 0
    assert len(table(result.out)[1]) == 2


def test_json_prints_one_document_and_output_takes_the_angles(run, tmp_path):
    file = tmp_path / "angles.csv"
    result = run(*PANDA, "--json", "--output", file)
    assert result.json["reached"] == 101
    assert result.json["frames"] == ["panda_hand_tcp"]
    _, numbers = table(file.read_text())
    assert numbers[:, 1:] == pytest.approx(np.array(result.json["angles"]))


def test_a_free_root_needs_json_lines(run):
    path = "x,y,z\n0.4,0,0.5\n"
    assert run("track", "arm", "-", "--frame", "tip", "--root", "planar", stdin=path).status == 2
    result = run("track", "arm", "-", "--frame", "tip", "--root", "planar", "--format", "jsonl", stdin=path)
    assert result.status == 0
    assert list(json.loads(result.out)["joint_placements"]) == ["root_joint"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "stdin: there are no points"),
        ("x,y,z\n", "stdin: there are no points after the header"),
        ("x,y\n1,2\n", "stdin: line 1: the header must be x,y,z"),
        ("x,y,z,qx\n1,2,3,4\n", "stdin: line 1: the header must be x,y,z"),
        ("x,y,z,r,p,y\n1,2,3,4,5,6\n", "stdin: line 1: the header must be x,y,z"),
        ("x,y,z\n0.5,0.2,0\n\n0.5,0.2\n", "stdin: line 4: there must be 3 numbers, as in the header; got 2"),
        ("x,y,z\n0.5,a,0\n", "stdin: line 2: y must be a number; got 'a'"),
        ("x,y,z\n0.5,nan,0\n", "stdin: line 2: target 'tip': position"),
        ("x,y,z,t\n0.5,0.2,0,1\n0.5,0.2,0,1\n", "stdin: line 3: the times must increase; got 1 and then 1"),
        ("x,y,z,qx,qy,qz,qw\n0.5,0.2,0,0,0,0,0\n", "stdin: line 2: target 'tip': a quaternion must not be zero"),
        ('{"position": [0.5, 0.2, 0]}\n{"position": 3}\n', "stdin: line 2: target 'tip': position"),
        ('{"position": [0.5, 0.2, 0]}\n{"pos": 3}\n', "stdin: line 2: no target keyword 'pos'"),
        ('{"position": [0.5, 0.2, 0]}\n{nonsense\n', "stdin: line 2: not JSON"),
        ('{"position": [0.5, 0.2, 0]}\n{"frame": "base"}\n', "stdin: line 2"),
        ('{"position": [0.5, 0.2, 0], "t": "now"}\n', 'stdin: line 1: t must be a finite number of seconds; got "now"'),
        ('{"position": [0.5, 0.2, 0], "t": 1e400}\n', "stdin: line 1: t must be a finite number of seconds; got inf"),
        ('{"position": [0.5, 0.2, 0], "t": NaN}\n', "stdin: line 1: t must be a finite number of seconds; got nan"),
        (
            '{"position": [0.5, 0.2, 0], "t": 1' + "0" * 400 + "}\n",
            "stdin: line 1: t must be a finite number of seconds",
        ),
        ("x,y,z,t\n0.5,0.2,0,inf\n", "stdin: line 2: t must be a finite number of seconds; got inf"),
        ("x,y,z,t\n0.5,0.2,0,\n", "stdin: line 2: t must be a number; only x, y and z may be empty"),
        ("x,y,z\n,,\n", "stdin: line 2: target 'tip': position must have a coordinate that is not None"),
        (
            "x,y,z\n,,0\n0.1,,0\n",
            "stdin: line 3: every line must ask for the same frames and the same kinds of targets",
        ),
        ('{"position": [0.5, 0.2, 0], "t": 1}\n{"position": [0.5, 0.2, 0]}\n', "line 2: give the time t in every line"),
        ('{"position": [0.5, 0.2, 0], "frame": "tpi"}\n', "stdin: line 1: no frame 'tpi'"),
    ],
)
def test_bad_input_is_told_with_its_line(run, text, message):
    result = run("track", "two_link", "-", "--frame", "tip", stdin=text)
    assert result.status == 2
    assert result.out == ""
    assert message in result.err


def test_places_need_a_frame(run):
    result = run("track", "two_link", "-", stdin="x,y,z\n0.5,0.2,0\n")
    assert result.status == 2
    assert "give --frame F" in result.err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--format", "xml"), "--format must be csv or jsonl; got 'xml'"),
        (("--output", "/nowhere/angles.csv"), "no such folder"),
        (("--on-miss", "skip"), "no on_miss 'skip'"),
        (("--output", "angles.json"), "--output angles.json must end in .csv, .jsonl or .ndjson; or give --format"),
        (("--time-limit", "-1"), "--time-limit must be"),
        (("--tolerance-box", "-1", "1", "1"), "--tolerance"),
    ],
)
def test_options_that_cannot_be_are_refused(run, words, message):
    result = run(*PANDA, *words)
    assert result.status == 2
    assert message in result.err


def test_the_same_path_in_python_gives_the_same_angles(run):
    robot = load_quietly("panda")
    track = pinik.track(robot, targets_in(CIRCLE), q0=robot.poses["default"])
    _, numbers = table(run(*PANDA).out)
    assert numbers[:, 1:] == pytest.approx(track.angles, abs=1e-12)


def test_the_turns_of_a_start_are_kept(run):
    robot = load_quietly("kinova")
    wheel, frame = "j2s6s200_joint_1", "j2s6s200_end_effector"
    others = {"j2s6s200_joint_2": 3.0, "j2s6s200_joint_3": 1.5, "j2s6s200_joint_5": 1.0}
    x, y, z = robot.placement(frame, robot.configuration({wheel: 9.7} | others)).translation
    words = [f"{name}={angle}" for name, angle in ({wheel: 9.6} | others).items()]
    starts = [word for text in words for word in ("--start", text)]
    result = run("track", "kinova", "-", "--frame", frame, *starts, stdin=f"x,y,z\n{x},{y},{z}\n")
    titles, numbers = table(result.out)
    assert numbers[0, titles.index(wheel)] == pytest.approx(9.65, abs=0.1)


def test_an_empty_cell_leaves_an_axis_free(run):
    robot = load_quietly("two_link")
    result = run("track", "two_link", "-", "--frame", "tip", "--start", "joint2=1", stdin="x,y,z\n0.5,,\n0.51,,\n")
    assert result.status == 0
    titles, numbers = table(result.out)
    found = [robot.placement("tip", robot.configuration(dict(zip(titles, row, strict=True)))) for row in numbers]
    assert [place.translation[0] for place in found] == pytest.approx([0.5, 0.51], abs=1e-4)


@pytest.mark.parametrize(("option", "value"), [("--tool", ("0", "0", "0.1")), ("--relative-to", ("upper",))])
def test_a_target_that_names_its_frame_is_not_changed_by_options(run, option, value):
    line = '{"frame": "tip", "position": [0.5, 0.2, 0]}\n'
    result = run("track", "two_link", "-", "--frame", "tip", option, *value, stdin=line)
    assert result.status == 2
    assert f"stdin: line 1: the target names its frame; put {option} into it" in result.err


def test_a_rounded_rotation_is_told_with_its_line(run):
    turned = pinocchio.exp3(np.array([0.0, 0.0, 0.3])).round(4).tolist()
    line = json.dumps({"position": [0.5, 0.2, 0.0], "rotation": turned})
    result = run("track", "two_link", "-", "--frame", "tip", stdin=line + "\n")
    assert "warning: stdin: line 1: target 'tip': rotation is replaced by the nearest rotation matrix" in result.err
    assert ".py" not in result.err


def test_the_tolerance_may_be_a_box_and_polish_may_be_left_out(run):
    robot = load_quietly("panda")
    exact = run(*PANDA)
    rough = run(*PANDA, "--no-polish", "--tolerance-box", "0.002", "0.002", "0.002", "--time-limit", "10")
    assert rough.status == 0

    def errors(result):
        titles, numbers = table(result.out)
        ways = [robot.configuration(dict(zip(titles[1:], row[1:], strict=True))) for row in numbers]
        return [judge(robot, target, q).position for target, q in zip(targets_in(CIRCLE), ways, strict=True)]

    assert max(errors(exact)) < 1e-7
    assert 1e-5 < max(errors(rough)) < 0.0035
