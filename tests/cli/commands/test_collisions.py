from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

import pinik
from urdf_texts import joint, link, robot

BALL = '<collision><geometry><sphere radius="0.3"/></geometry></collision>'
AHEAD = '<origin xyz="0.5 0 0"/>'
URDF = robot(
    link("a", BALL),
    link("b", BALL),
    link("c", BALL),
    link("bare"),
    joint("j1", "a", "b", AHEAD, '<axis xyz="0 0 1"/>'),
    joint("j2", "b", "c", AHEAD, '<axis xyz="0 0 1"/>'),
    joint("f", "c", "bare", kind="fixed", limit=""),
)
CELL = robot(link("wall", '<collision><geometry><box size="0.1 9 9"/></geometry></collision>'))


@pytest.fixture
def arm(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF)
    (tmp_path / "cell.urdf").write_text(CELL)
    return str(tmp_path / "arm.urdf")


def test_the_pairs_and_what_touches_are_those_of_python(run, ur5):
    answer = run("collisions", "ur5", "--set", "elbow_joint=2.9", "--json").json
    q = ur5.configuration({"elbow_joint": 2.9})
    assert answer["q"] == pytest.approx(q.tolist())
    assert answer["source"] == "srdf"
    assert [tuple(pair) for pair in answer["counting"]] == list(ur5.collision_pairs.counting)
    assert {tuple(one["pair"]): one["reason"] for one in answer["left_out"]} == dict(ur5.collision_pairs.left_out)
    touching = ur5.collisions(q)
    assert touching
    assert [(tuple(one["pair"]), one["depth_m"]) for one in answer["collisions"]] == [
        (one.pair, one.depth) for one in touching
    ]
    assert answer["clearance_m"] == -touching[0].depth


def test_the_text_says_which_count_why_not_and_what_touches(run, arm):
    free, bent = run("collisions", arm), run("collisions", arm, "--set", "j1=150", "--deg")
    assert "1 of 3 pairs of links count; pinik found out which" in free.out
    assert "left out: 2 adjacent" in free.out
    assert "without collision shapes, so they touch nothing: bare" in free.out
    assert "nothing touches; the nearest are a and c, 0.4000 m apart" in free.out
    rows = [line.split() for line in free.out.splitlines()]
    assert ["a", "c", "counts"] in rows
    assert ["a", "b", "adjacent"] in rows
    # c's centre is 0.5 m from b's, which is 0.5 m from a's, at 30°.
    depth = 0.6 - np.linalg.norm([0.5 + 0.5 * np.cos(np.radians(150)), 0.5 * np.sin(np.radians(150))])
    assert ["a", "c", f"{depth:.4f}"] in [line.split() for line in bent.out.splitlines()]


def test_a_world_is_avoided_by_its_links(run, arm, tmp_path):
    answer = run("collisions", arm, "--world", tmp_path / "cell.urdf", "--json").json
    assert [one["pair"] for one in answer["collisions"]] == []
    assert answer["nearest"] == ["b", "wall"]
    assert answer["nearest_with_world"] is True
    assert answer["clearance_m"] == pytest.approx(0.5 - 0.3 - 0.05, abs=1e-6)
    assert run("collisions", arm, "--json").json["nearest_with_world"] is False


def test_an_object_is_told_from_a_link_of_its_name(run, arm, tmp_path):
    """The object c goes 0.2 m into b, whose ball ends at 0.8 m; the link c is free of a."""
    box = '<collision><origin xyz="0.5 0 0.6"/><geometry><box size="0.2 0.2 1.0"/></geometry></collision>'
    (tmp_path / "same.urdf").write_text(robot(link("c", box)))
    words = ("collisions", arm, "--world", tmp_path / "same.urdf")
    (touch,) = run(*words, "--json").json["collisions"]
    assert (touch["pair"], touch["with_world"]) == (["b", "c"], True)
    assert "b        the object c" in run(*words).out


def test_the_srdf_that_is_written_disables_what_does_not_count(run, arm, tmp_path):
    out = tmp_path / "arm.srdf"
    assert run("collisions", arm, "--write-srdf", out).status == 0
    disabled = ElementTree.parse(out).getroot()
    assert [one.attrib for one in disabled] == [
        {"link1": "a", "link2": "b", "reason": "Adjacent"},
        {"link1": "b", "link2": "c", "reason": "Adjacent"},
    ]
    again = pinik.load(arm).collision_pairs  # the file lies beside the URDF now
    assert again.source == "srdf"
    assert again.counting == (("a", "c"),)


def test_where_no_pair_counts_it_says_so(run, tmp_path):
    (tmp_path / "two.urdf").write_text(robot(link("a", BALL), link("b", BALL), joint("j", "a", "b")))
    text = run("collisions", tmp_path / "two.urdf").out
    assert "0 of 1 pair of links count" in text
    assert "nothing can touch: no pair counts" in text
    answer = run("collisions", tmp_path / "two.urdf", "--json").json
    assert (answer["clearance_m"], answer["nearest"], answer["nearest_points"]) == (None, None, None)


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (("asr_twodof",), 2, "'asr_twodof' has no collision shapes"),
        (("ur5", "--world", "nowhere.urdf"), 3, "--world nowhere.urdf: .*no such file"),
        (("ur5", "--write-srdf", "/nowhere/out.srdf"), 2, "--write-srdf /nowhere/out.srdf: no such folder"),
        (("ur5", "--set", "elbow=1"), 2, "no joint 'elbow'"),
        (("nobody",), 3, "no robot 'nobody'"),
    ],
)
def test_what_cannot_be_answered_is_an_error(run, arguments, status, words):
    done = run("collisions", *arguments)
    assert done.status == status
    assert done.out == ""
    assert re.search(words, done.err)
