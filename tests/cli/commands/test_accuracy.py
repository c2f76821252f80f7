from __future__ import annotations

import sys

import pytest

from pinik.cli.reports.accuracy_plots import draw_accuracy, draw_spread, draw_straight_arm
from pinik.cli.reports.method_style import method_colors
from pinik.studies.thesis import METHODS

METHOD_COLORS = method_colors(METHODS)
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
        (("--joints", 1), "--joints must be a whole number from 2 to 50; got 1"),
        (("--joints", 51), "--joints must be a whole number from 2 to 50; got 51"),
        (("--digits", 0), "--digits must be a whole number from 1 to 10; got 0"),
        (("--digits", 11), "--digits must be a whole number from 1 to 10; got 11"),
        (("--problems", 0), "--problems must be a whole number of at least 1"),
        (("--edge", 1.5), "above 0 and at most 1"),
        (("--param", "alpha=1"), "--param must be METHOD.NAME=VALUE"),
        (("--param", "jtt.alpha=1"), "did you mean 'jt'"),
        (("--param", "jt.alpha"), "--param must be NAME=VALUE"),
        (("--param", 'ccd.stiffness={"joint7": 0}'), "--param ccd.stiffness cannot be set"),
        (("--param", "jt.lambda=1"), "no parameter 'lambda'"),
        (("--engine", "fast"), "no engine 'fast'"),
    ],
)
def test_wrong_usage_says_what_would_have_been_right(run, arguments, words):
    result = run("accuracy", *arguments)
    assert (result.status, result.out) == (2, "")
    assert words in result.err


@pytest.mark.parametrize("option", ["--plot", "--plot-straight", "--plot-spread"])
def test_a_picture_is_drawn_or_refused_before_anything_runs(run, option, tmp_path, monkeypatch):
    picture = tmp_path / "picture.png"
    result = run(*QUICK, option, picture)
    assert result.status == 0
    assert result.out.startswith("chain7")
    assert picture.read_bytes().startswith(b"\x89PNG")
    refused = {"none/a.png": "no such folder", "a.bmpx": "svg", "folder.png": "this is a folder"}
    (tmp_path / "folder.png").mkdir()
    for name, words in refused.items():
        result = run(*QUICK, option, tmp_path / name)
        assert (result.status, result.out) == (2, "")
        assert f"{option} {tmp_path / name}: " in result.err
        assert words in result.err
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert f"{option} needs matplotlib: pip install 'pinik[plots]'" in run(*QUICK, option, tmp_path / "b.png").err


def test_two_pictures_in_one_file_are_refused(run, tmp_path):
    result = run(*QUICK, "--plot", tmp_path / "a.png", "--plot-spread", tmp_path / "." / "a.png")
    assert (result.status, result.out) == (2, "")
    assert "each picture needs a file of its own" in result.err


def made_answer():
    """What `pinik accuracy --json` prints, with figures that are easily told apart."""

    def row(case, method, digits):
        value = 10.0 * digits + list(METHOD_COLORS).index(method) + (100.0 if case == "edge" else 0.0)
        return {"case": case, "method": method, "digits": digits, "engine": "native",
                "iterations": value, "time_s": value / 1e6}  # fmt: skip

    outline = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]
    answers = dict.fromkeys(METHOD_COLORS, outline)
    ways = {"outline": outline, "iterations": 3, "position_error_m": 0.25}
    return {
        "robot": "chain2", "joints": 2, "length_m": 1.0, "problems": 1,
        "rows": [row(case, m, d) for case in ("near", "edge") for m in METHOD_COLORS for d in (1, 2)],
        "examples": [
            {"case": case, "position": [0.5, 0, 0], "start": outline, "answers": answers}
            for case in ("near", "edge")
        ],
        "straight": [
            {"method": m, "place": place, "restarted": ways | {"status": "CONVERGED"},
             "alone": ways | {"status": "CONVERGED" if m == "ccd" else "STALLED"}}
            for place in (0.5, 0.75) for m in METHOD_COLORS
        ],
        "spread": [
            {"method": m, "stiffness": weights, "shares": None if m == "jt" else [0.25, 0.75],
             "moving_joints": None if m == "jt" else 1.6}
            for weights in ({}, {"joint2": 0.1}) for m in METHOD_COLORS
        ],
    }  # fmt: skip


def test_a_line_for_each_method_in_its_colour():
    figure = draw_accuracy(made_answer())
    for row, extra in ((0, 0.0), (1, 100.0)):
        for panel in figure.axes[3 * row + 1 : 3 * row + 3]:
            for k, (line, (method, color)) in enumerate(zip(panel.lines, METHOD_COLORS.items(), strict=True)):
                assert (line.get_label(), line.get_color()) == (method, color)
                assert line.get_xdata().tolist() == [1, 2]
                assert line.get_ydata() == pytest.approx([10.0 + k + extra, 20.0 + k + extra])


def test_who_is_there_and_who_is_stuck():
    titles = [panel.get_title() for panel in draw_straight_arm(made_answer()).axes]
    assert titles[:4] == ["ccd: there in 3 sweeps"] + [f"{m}: stuck 0.25 m off" for m in ("jt", "pinv", "dls")]


def test_bars_are_shares_and_a_method_that_solved_nothing_says_so():
    panels = draw_spread(made_answer()).axes
    for panel, method in zip(panels, METHOD_COLORS, strict=True):
        heights = [bar.get_height() for bar in panel.patches]
        assert heights == ([0.0] * 4 if method == "jt" else [25.0, 75.0, 25.0, 75.0])
    assert panels[1].get_title() == "jt: none solved → none solved joints' worth"


def test_a_method_that_solves_no_drag_has_dashes(run):
    options = ("accuracy", "--problems", 1, "--digits", 1, "--param", "jt.alpha=100")
    result = run(*options)
    assert result.err == ""
    assert any(line.split() == ["jt", "none", "0", "%", *"-" * 9] for line in result.out.splitlines())
    jt = next(own for own in run(*options, "--json").json["spread"] if own["method"] == "jt")
    assert (jt["solved"], jt["shares"], jt["moving_joints"]) == (0.0, None, None)
