"""`pinik reach`: maps, lists of places and bases, as text, JSON, files and pictures."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import pinik

CIRCLE = Path(__file__).parents[3] / "examples" / "circle.csv"
RING = ("reach", "two_link", "--frame", "tip", "--cell", "0.1")


def test_a_map_of_two_hinges_is_the_ring(run):
    answer = run(*RING, "--by", "solving", "--json")
    assert answer.status == 0
    told = answer.json
    assert (told["schema"], told["robot"], told["frame"], told["by"]) == (1, "two_link", "tip", "solving")
    assert told["shape"] == [19, 19, 1]
    ring = told["workspaces"]["any"]
    assert ring["volume_m3"] == pytest.approx(ring["cells"] * 1e-3)
    assert ring["volume_m3"] / 0.1 == pytest.approx(np.pi * 0.8, abs=0.1)
    np.testing.assert_allclose(ring["bounds"], [[-0.95, -0.95, -0.05], [0.95, 0.95, 0.05]], atol=1e-9)
    assert set(told["workspaces"]) == {"any"}
    assert 0.19 < told["manipulability"]["largest"] <= 0.2 + 1e-6


def test_both_ways_are_compared(run):
    told = run(*RING, "--by", "both", "--samples", "100000", "--json").json
    assert told["agreement"]["only_this"] == 0
    assert 0 < told["agreement"]["only_other"] < 80
    text = run(*RING, "--by", "both", "--samples", "100000").out
    assert "both ways reach" in text


def test_a_map_goes_to_a_file_and_is_shown_from_it(run, tmp_path):
    file, slices, picture, page = (tmp_path / name for name in ("ring.npz", "ring.svg", "ring.png", "ring.html"))
    made = run(*RING, "--samples", "50000", "--output", file, "--json")
    assert made.status == 0
    shown = run("reach", "two_link", "--map", file, "--slices", slices, "--picture", picture, "--page", page, "--json")
    assert shown.status == 0, shown.err
    assert shown.json["workspaces"] == made.json["workspaces"]
    assert str(pinik.ReachMap.load(file)) in run("reach", "two_link", "--map", file).out
    assert slices.read_bytes().startswith(b"<?xml")
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert b"<title>What tip of two_link can reach</title>" in page.read_bytes()


def test_a_map_from_a_file_goes_to_a_file_of_another_format(run, tmp_path):
    file, other = tmp_path / "ring.npz", tmp_path / "ring.parquet"
    run(*RING, "--samples", "50000", "--output", file)
    assert run("reach", "two_link", "--map", file, "--output", other).status == 0
    assert str(pinik.ReachMap.load(other)) == str(pinik.ReachMap.load(file))


def test_a_map_of_another_robot_is_refused(run, tmp_path):
    run(*RING, "--samples", "500", "--output", tmp_path / "ring.npz")
    answer = run("reach", "panda", "--map", tmp_path / "ring.npz", "--picture", tmp_path / "a.png")
    assert (answer.status, answer.out) == (2, "")
    assert "ring.npz is a map of two_link, and the robot is panda" in answer.err


def test_a_list_of_places(run, tmp_path):
    answer = run("reach", "panda", CIRCLE, "--frame", "panda_hand_tcp", "--json")
    assert answer.status == 0
    assert (answer.json["reached"], answer.json["success"]) == (101, True)
    row = answer.json["targets"][3]
    assert row["reached"] is True
    assert 0 < row["score"] <= 1
    places = tmp_path / "places.jsonl"
    places.write_text("\n".join(json.dumps(place) for place in ([0.3, 0.3, 0.0], [2.0, 0.0, 0.0])))
    missed = run("reach", "two_link", places, "--frame", "tip")
    assert missed.status == 1
    assert [line.split()[4] for line in missed.out.splitlines()[1:3]] == ["yes", "no"]
    assert "1 of 2 targets reached" in missed.out
    mean, lowest = map(
        float, re.search(r"mean score ([\d.]+), with 0 .* lowest of the others ([\d.]+)", missed.out).groups()
    )
    assert mean == pytest.approx(lowest / 2, abs=0.006)
    told = run("reach", "two_link", places, "--frame", "tip", "--json").json
    assert told["targets"][1]["manipulability"] is None


def test_places_for_the_base(run, tmp_path):
    places = tmp_path / "places.csv"
    places.write_text("x,y,z\n2.0,1.0,0.0\n2.3,1.2,0.0\n")
    answer = run(*RING, places, "--samples", "50000", "--bases", "4", "--json")
    assert answer.status == 0, answer.err
    best = answer.json["bases"][0]
    assert (best["solved"], best["reached"], answer.json["targets"]) == (2, 2, 2)
    away = np.linalg.norm(np.array([[2.0, 1.0, 0.0], [2.3, 1.2, 0.0]]) - best["position"], axis=1)
    assert ((away > 0.1) & (away < 0.9)).all()
    text = run(*RING, places, "--samples", "50000", "--bases", "4", "--deg")
    assert "yaw [deg]" in text.out
    run(*RING, "--samples", "50000", "--output", tmp_path / "ring.npz")
    again = run("reach", "two_link", places, "--map", tmp_path / "ring.npz", "--bases", "4", "--json")
    assert again.json["bases"] == answer.json["bases"]
    straight = run(*RING, places, "--samples", "50000", "--bases", "4", "--lock", "joint2", "--json")
    assert straight.json["bases"][0]["solved"] < 2, "of what the map promises, a locked elbow misses some"
    far = run(*RING, places, "--samples", "100", "--bases", "1", "--box", 0, 0, 0.5, 0.1, 0.1, 0.6)
    assert far.status == 1
    assert "no base reaches" in far.out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--by", "luck"], "'sampling', 'solving', 'both'"),
        (["--cell", "0"], "--cell"),
        (["--samples", "many"], "--samples"),
        (["--by", "solving", "--samples", "10"], "--samples"),
        (["--output", "map.txt"], ".npz"),
        (["--output", "/no/such/folder/map.npz"], "--output"),
        (["--slices", "slices.nothing"], "--slices"),
        (["--bases", "3"], "list of places"),
        (["--quantity", "colour", "--picture", "a.png", "--samples", "10"], "share"),
        (["--workspace", "everything", "--picture", "a.png", "--samples", "10"], "dexterous"),
        (["--resume"], "--resume"),
        (["--branches"], "--branches"),
        (["--workspace", "2"], "--workspace must be a name or a share in (0, 1]; got 2.0"),
        ([CIRCLE, "--output", "map.npz"], "--map and --output are for maps"),
        ([CIRCLE, "--map", "map.npz"], "--map and --output are for maps"),
    ],
)
def test_wrong_options_are_refused_in_words(run, options, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answer = run(*RING, *options)
    assert (answer.status, answer.out) == (2, "")
    assert words in answer.err
    assert answer.err.count("\n") == 1


@pytest.mark.parametrize(
    "option", [("--workers", 2), ("--by", "solving"), ("--resume",), ("--cell", 0.05), ("--branches",)]
)
def test_what_makes_maps_is_refused_where_none_is_made(run, option):
    listed = run("reach", "panda", CIRCLE, "--frame", "panda_hand_tcp", *option)
    words = f"error: {option[0]} is for maps; leave out the list of places, or ask for --bases\n"
    assert (listed.status, listed.err) == (2, words)
    kept = run("reach", "two_link", "--map", "map.npz", *option)
    assert (kept.status, kept.err) == (2, f"error: {option[0]} is for making a map; --map reads one that was made\n")


def test_a_map_that_is_not_there_is_named(run, tmp_path):
    answer = run("reach", "two_link", "--map", tmp_path / "none.npz")
    assert (answer.status, answer.out) == (2, "")
    assert "no such file" in answer.err


def test_the_frame_must_be_given(run):
    answer = run("reach", "two_link")
    assert answer.status == 2
    assert "--frame" in answer.err
