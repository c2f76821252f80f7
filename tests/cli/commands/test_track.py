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
        ("x,y,z\n0.5,a,0\n", "stdin: line 2: 'a' is not a number"),
        ("x,y,z\n0.5,nan,0\n", "stdin: line 2: target 'tip': position"),
        ("x,y,z,t\n0.5,0.2,0,1\n0.5,0.2,0,1\n", "stdin: line 3: the times must increase; got 1 and then 1"),
        ("x,y,z,qx,qy,qz,qw\n0.5,0.2,0,0,0,0,0\n", "stdin: line 2: target 'tip': a quaternion must not be zero"),
        ('{"position": [0.5, 0.2, 0]}\n{"position": 3}\n', "stdin: line 2: target 'tip': position"),
        ('{"position": [0.5, 0.2, 0]}\n{"pos": 3}\n', "stdin: line 2: no target keyword 'pos'"),
        ('{"position": [0.5, 0.2, 0]}\n{nonsense\n', "stdin: line 2: not JSON"),
        ('{"position": [0.5, 0.2, 0]}\n{"frame": "base"}\n', "stdin: line 2"),
        ('{"position": [0.5, 0.2, 0], "t": "now"}\n', "stdin: line 1: t must be a number of seconds"),
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
