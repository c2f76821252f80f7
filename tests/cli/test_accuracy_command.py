from __future__ import annotations

import sys

import pytest

QUICK = ("accuracy", "--problems", 2, "--digits", 2)


def test_every_method_near_and_at_the_edge_to_every_digit(run):
    result = run(*QUICK, "--json")
    answer = result.json
    assert (result.status, result.err) == (0, "")
    assert [(row["case"], row["method"], row["digits"]) for row in answer["rows"]] == [
        (case, method, digits)
        for case in ("near", "edge")
        for method in ("ccd", "jt", "pinv", "dls")
        for digits in (1, 2)
    ]
    assert all(row["tolerance_m"] == pytest.approx(10.0 ** -row["digits"]) for row in answer["rows"])
    assert [example["case"] for example in answer["examples"]] == ["near", "edge"]
    near, edge = answer["examples"]
    for example, away in ((near, 0.5), (edge, 0.999)):
        assert sum(x * x for x in example["position"]) ** 0.5 == pytest.approx(away)
        for outline in example["answers"].values():
            assert len(outline) == 8
            assert outline[-1] == pytest.approx(example["position"][:2], abs=1e-4)
    assert len(answer["straight"]) == 8
    assert [bool(own["stiffness"]) for own in answer["spread"]] == [False] * 4 + [True] * 4


def test_the_tables_have_a_line_for_each_method(run):
    result = run(*QUICK)
    lines = result.out.splitlines()
    assert lines[0] == "chain7: 7 hinges in a plane, 1 m, no limits, no restarts; medians of 2 problems"
    assert sum(line.startswith(("near ", "edge ")) for line in lines) == 8
    assert sum(line.startswith(("50 %", "93 %")) for line in lines) == 8
    assert sum(" weighted " in line for line in lines) == 4
    assert result.err == ""


def test_another_chain_and_another_engine(run):
    answer = run(*QUICK, "--joints", 3, "--edge", 0.9, "--engine", "python", "--json").json
    assert (answer["robot"], answer["joints"], answer["edge"]) == ("chain3", 3, 0.9)
    assert {row["engine"] for row in answer["rows"]} == {"python"}


def test_a_method_s_parameter_is_changed_and_the_others_are_not(run):
    usual, changed = run(*QUICK, "--json").json, run(*QUICK, "--param", "jt.alpha=0.05", "--json").json
    assert changed["parameters"]["jt"] == usual["parameters"]["jt"] | {"alpha": 0.05}
    for before, after in zip(usual["rows"], changed["rows"], strict=True):
        if before["method"] == "jt":
            assert after["iterations"] > 2 * before["iterations"]
        else:
            assert after["iterations"] == before["iterations"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--joints", 1), "--joints is a whole number of at least 2"),
        (("--joints", 51), "--joints is at most 50"),
        (("--digits", 0), "--digits is a whole number of at least 1"),
        (("--digits", 11), "--digits at most 10"),
        (("--problems", 0), "--problems is a whole number of at least 1"),
        (("--edge", 1.5), "above 0 and at most 1"),
        (("--param", "alpha=1"), "--param takes METHOD.NAME=VALUE"),
        (("--param", "jtt.alpha=1"), "near: 'jt'"),
        (("--param", "jt.alpha"), "--param takes NAME=VALUE"),
        (("--param", "jt.lambda=1"), "no parameter of 'jt' 'lambda'"),
        (("--engine", "fast"), "no engine 'fast'"),
    ],
)
def test_wrong_usage_says_what_would_have_been_right(run, arguments, words):
    result = run("accuracy", *arguments)
    assert (result.status, result.out) == (2, "")
    assert words in result.err


@pytest.mark.parametrize("option", ["--plot", "--plot-straight", "--plot-spread"])
def test_a_picture_is_drawn_or_refused_before_anything_runs(run, option, tmp_path, monkeypatch):
    assert run(*QUICK, option, tmp_path / "picture.png").status == 0
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
    assert f"{option} {tmp_path / 'none' / 'a.png'}: there is no such folder" in (
        run(*QUICK, option, tmp_path / "none" / "a.png").err
    )
    assert "svg" in run(*QUICK, option, tmp_path / "a.bmpx").err
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert f"{option} needs matplotlib: pip install 'pinik[plots]'" in run(*QUICK, option, tmp_path / "b.png").err
