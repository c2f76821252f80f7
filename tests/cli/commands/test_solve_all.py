"""`pinik solve-all`: every branch with its angles, as a table and as JSON."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

import pinik
from judge import is_good
from robots import load_quietly

TWO_LINK = ("solve-all", "two_link", "--frame", "tip")
POSE = ("solve-all", "ur5", "--frame", "tool0", "--position", "0.4", "0.1", "0.4", "--rpy", "180", "0", "90", "--deg")


def elbows(x: float, y: float) -> list[tuple[float, float]]:
    """Both answers of the arm of 0.5 m and 0.4 m, by the law of cosines [rad]."""
    bend = math.acos((x * x + y * y - 0.25 - 0.16) / 0.4)
    return [(math.atan2(y, x) - math.atan2(0.4 * math.sin(b), 0.5 + 0.4 * math.cos(b)), b) for b in (bend, -bend)]


@pytest.mark.parametrize("method", ["dls", "two_bone"])
def test_the_table_has_both_elbows(run, method):
    result = run(*TWO_LINK, "--position", "0.4", "0.3", "0", "--method", method, "--deg")
    assert result.status == 0
    assert result.out.startswith("2 answers")
    rows = {line.split()[0]: line.split()[2:] for line in result.out.splitlines() if line.startswith("joint")}
    found = sorted(zip(*([float(word) for word in rows[name]] for name in ("joint1", "joint2")), strict=True))
    assert np.array(found) == pytest.approx(np.degrees(sorted(elbows(0.4, 0.3))), abs=2e-3)
    distance = [float(word) for word in re.search(r"^distance +deg (.*)$", result.out, re.MULTILINE)[1].split()]
    assert distance == sorted(distance)


def test_json_is_the_dictionary_of_the_branches(run):
    told = run(*POSE, "--json").json
    robot = load_quietly("ur5")
    branches = pinik.solve_all(robot, "tool0", position=[0.4, 0.1, 0.4], rpy=[math.pi, 0, math.pi / 2])
    expected = json.loads(json.dumps(branches.to_dict()))
    assert {**told, "time_s": 0} == {**expected, "time_s": 0}
    assert len(told["branches"]) == 8
    asked = {"frame": "tool0", "position": [0.4, 0.1, 0.4], "rpy": [math.pi, 0, math.pi / 2]}
    assert all(is_good(robot, asked, np.array(row["q"]), (1e-8, 1e-8)) for row in told["branches"])


def test_whole_turns_are_counted(run):
    text = run(*POSE).out
    counts = re.search(r"^with whole turns +(.*)$", text, re.MULTILINE)[1].split()
    branches = load_quietly("ur5").solve_all("tool0", [0.4, 0.1, 0.4], rpy=[math.pi, 0, math.pi / 2])
    assert [int(count) for count in counts] == [len(list(branches.wound(index))) for index in range(8)]


def test_without_an_answer_the_status_is_1(run):
    result = run(*TWO_LINK, "--position", "4", "0", "0")
    assert result.status == 1
    assert "unreachable" in result.out
    told = run(*TWO_LINK, "--position", "4", "0", "0", "--json")
    assert told.status == 1
    assert told.json["branches"] == []
    assert told.json["status"] == "UNREACHABLE"


def test_infinitely_many(run):
    told = run("solve-all", "panda", "--frame", "panda_link8", "--position", "0.4", "0.1", "0.4", "--json").json
    assert told["redundancy"] == 4
    assert told["estimate_missing"] is None
    assert not told["complete"]
    shown = run("solve-all", "panda", "--frame", "panda_link8", "--position", "0.4", "0.1", "0.4").out
    assert "infinitely many" in shown
    assert f"{len(told['branches'])}\n" not in shown.splitlines()[0]


def test_options_reach_the_search(run):
    one = run(*TWO_LINK, "--position", "0.4", "0.3", "0", "--restarts", "0", "--json").json
    assert (one["starts"], len(one["branches"])) == (1, 1)
    held = run(
        *TWO_LINK, "--position", "0.4", "0.3", "0", "--start", "joint2=1.98231", "--lock", "joint2", "--json"
    ).json
    assert {row["angles"]["joint2"] for row in held["branches"]} == {1.98231}
    python = run(*TWO_LINK, "--position", "0.4", "0.3", "0", "--engine", "python", "--json").json
    assert python["engine"] == "python"


def test_targets_from_stdin(run):
    told = run(
        "solve-all", "two_link", "--targets", "-", "--json", stdin='[{"frame": "tip", "position": [0.4, 0.3, 0]}]'
    )
    assert len(told.json["branches"]) == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--position", "0.4", "0.3", "0", "--frame", "nowhere"), "nowhere"),
        (("--position", "0.4", "0.3", "0", "--restarts", "-1"), "--restarts"),
        (("--position", "0.4", "0.3", "0", "--choose", "nearest"), "--choose"),
        (("--targets", "-"), "--frame"),
        ((), "no target"),
    ],
)
def test_slips_are_named(run, words, message):
    result = run(*TWO_LINK, *words)
    assert (result.status, result.out) == (2, "")
    assert message in result.err


def test_a_solver_of_ones_own_that_fails_is_one_sentence(run, tmp_path, monkeypatch):
    (tmp_path / "failing_one.py").write_text(
        "from dataclasses import dataclass\nimport pinik\n\n"
        "@dataclass(frozen=True)\nclass Failing(pinik.JacobianSolver):\n"
        "    name = 'failing'\n\n    def direction(self, J, at):\n        raise ZeroDivisionError('not today')\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    result = run(*TWO_LINK, "--position", "0.4", "0.3", "0", "--method", "failing_one:Failing")
    assert (result.status, result.out) == (2, "")
    assert "the solver failed: ZeroDivisionError" in result.err
