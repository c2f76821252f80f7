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
from urdf_texts import joint, link, robot

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
    facts = re.findall(r"^(\d) +(joint\d) +(\S+) deg ", result.out, re.MULTILINE)
    assert [number for number, _, _ in facts] == ["1", "2"]
    for number, name, by in facts:
        values = {joint: abs(float(rows[joint][int(number) - 1])) for joint in rows}
        assert (name, float(by)) == (max(values, key=values.get), pytest.approx(max(values.values()), abs=1e-3))
    assert float(facts[0][2]) <= float(facts[1][2])


def test_a_slide_that_moves_most_is_told_in_metres(run, tmp_path):
    """A slide along x carries a hinge about z with a bar of 0.4 m, whose end shall be at (1, 0.1)."""
    names = ("base", "cart", "bar", "tip")
    parts = [
        joint("slide", "base", "cart", '<axis xyz="1 0 0"/>', kind="prismatic"),
        joint("elbow", "cart", "bar", '<axis xyz="0 0 1"/>'),
        joint("end", "bar", "tip", '<origin xyz="0.4 0 0"/>', kind="fixed", limit=""),
    ]
    (tmp_path / "r.urdf").write_text(robot(*map(link, names), *parts))
    shown = run("solve-all", tmp_path / "r.urdf", "--frame", "tip", "--position", "1", "0.1", "0", "--deg").out
    bend = math.asin(0.25)
    assert re.search(rf"^1 +slide +{1.0 - 0.4 * math.cos(bend):.5f} m ", shown, re.MULTILINE)
    assert re.search(rf"^2 +elbow +{math.degrees(math.pi - bend):.3f} deg ", shown, re.MULTILINE)


POINT = ("solve-all", "panda", "--frame", "panda_hand_tcp", "--position", "0.4", "-0.3", "0.35")
PANDA = (*POINT, "--rpy", "3.1", "0", "0.5")


def test_families_are_lines_of_text_and_arcs_of_json(run):
    told, shown = run(*PANDA, "--families", "--json").json, run(*PANDA, "--families").out
    panda = load_quietly("panda")
    families = panda.solve_all("panda_hand_tcp", [0.4, -0.3, 0.35], rpy=[3.1, 0, 0.5]).families
    assert len(families) > 1
    assert told["families"] == json.loads(json.dumps([family.to_dict() for family in families]))
    lines = [line for line in shown.splitlines() if line.startswith("family")]
    assert lines == [f"family {k}  {family}" for k, family in enumerate(families, 1)]
    arcs = [np.array(arc["angles"]) for family in told["families"] for arc in family["arcs"]]
    for branch in told["branches"]:  # lies on one of them, nearer than half of the space between two points
        angles = np.array([branch["angles"][name] for name in told["families"][0]["joint_names"]])
        gaps = [np.linalg.norm(arc - angles, axis=1).min() / np.linalg.norm(arc[1] - arc[0]) for arc in arcs]
        assert min(gaps) < 0.51
    assert "families" not in run(*PANDA, "--json").json
    assert "family" not in run(*PANDA).out


def test_where_there_are_no_families_it_says_why(run):
    assert "no families: the answers are isolated" in run(*POSE, "--families").out
    assert run(*POSE, "--families", "--json").json["families"] == []
    assert "no families: the answers have more than one dimension" in run(*POINT, "--families").out
    assert "famil" not in run(*TWO_LINK, "--position", "4", "0", "0", "--families").out


def test_json_is_the_dictionary_of_the_branches(run):
    told = run(*POSE, "--json").json
    ur5 = load_quietly("ur5")
    branches = pinik.solve_all(ur5, "tool0", position=[0.4, 0.1, 0.4], rpy=[math.pi, 0, math.pi / 2])
    expected = json.loads(json.dumps(branches.to_dict()))
    assert {**told, "time_s": 0} == {**expected, "time_s": 0}
    assert len(told["branches"]) == 8
    asked = {"frame": "tool0", "position": [0.4, 0.1, 0.4], "rpy": [math.pi, 0, math.pi / 2]}
    assert all(is_good(ur5, asked, np.array(row["q"]), (1e-8, 1e-8)) for row in told["branches"])


def test_whole_turns_are_counted(run):
    text = run(*POSE).out
    assert "with whole turns" in text
    counts = re.findall(r"^\d +\w+ +\S+ deg +\d+ +\d+ +(\d+)$", text, re.MULTILINE)
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
