from __future__ import annotations

import os
import pty
import subprocess
import sys

import pytest

from pinik.cli.reports.comparison_plot import draw_comparison
from pinik.studies.thesis import TABLE

QUICK = ("compare", "--steps", 3)


def test_every_method_in_every_comparison_with_the_thesis_s_figures_beside(run):
    answer = run(*QUICK, "--json").json
    assert (answer["robot"], answer["frame"], answer["preset"]) == ("arm", "tip", "tuned")
    assert (answer["bones"], answer["joints"]) == (6, 12)
    cells = {(row["comparison"], row["method"]): row for row in answer["rows"]}
    assert set(cells) == {(number, method) for number in ("1", "2", "3", "4", "2b", "4b") for method in TABLE}
    for (number, method), row in cells.items():
        cell = TABLE[method][number[0]]
        assert row["thesis"] == {"time_s": cell.time, "iterations": cell.iterations, "efficiency": cell.efficiency}
        assert row["time_of_thesis"] == pytest.approx(row["time_s"] / cell.time)
        assert row["limits"] is (number[0] in "34")
    assert all(row["efficiency"] == 1.0 for row in answer["rows"] if "b" not in row["comparison"])


def test_the_same_seed_gives_the_same_figures_but_times(run):
    def figures(seed):
        answer = run("compare", "--preset", "thesis", "--steps", 2, "--seed", seed, "--json").json
        timed = ("time_s", "time_of_thesis")
        return [{key: value for key, value in row.items() if key not in timed} for row in answer["rows"]]

    assert figures(3) == figures(3)
    assert figures(3) != figures(4)


def test_the_thesis_s_parameters_are_said_in_metres(run):
    answer = run("compare", "--preset", "thesis", "--steps", 1, "--json").json
    assert answer["unit_m"] == pytest.approx(1.2 / 7)
    assert answer["tolerance_m"] == pytest.approx(0.05 * 1.2 / 7)
    assert answer["parameters"]["dls"]["damping"] == pytest.approx(1.1 * 1.2 / 7)
    assert answer["mismatch"]["efficiency_points"] > 0.0


def test_the_table_has_a_line_for_each_row_and_says_what_it_means(run):
    result = run("compare", "--preset", "thesis", "--reading", "printed-axes", "--steps", 1)
    lines = result.out.splitlines()
    assert sum(" dls " in line for line in lines) == 6
    assert "as printed" in lines[0]
    assert "Mean difference from the thesis in 1 to 4" in result.out
    assert result.err == ""


def test_a_preset_s_parameter_is_changed(run):
    options = ("compare", "--preset", "thesis", "--steps", 1, "--json")
    usual, changed = run(*options).json, run(*options, "--param", "dls.damping=0.5").json
    assert changed["parameters"] == usual["parameters"] | {"dls": usual["parameters"]["dls"] | {"damping": 0.5}}


def test_another_robot_and_frame(run):
    answer = run("compare", "--robot", "panda", "--frame", "panda_link8", "--steps", 1, "--json").json
    assert (answer["robot"], answer["frame"], answer["joints"]) == ("panda", "panda_link8", 7)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--preset", "thesi"), "did you mean 'thesis'"),
        (("--preset", "tuned", "--reading", "literal"), "reading of preset 'tuned'"),
        (("--frame", "tipp"), "did you mean 'tip'"),
        (("--frame", "base"), "the chain of joints that moves it has no length"),
        (("--steps", 0), "--steps must be a whole number of at least 1"),
        (("--pieces", 0), "--pieces must be a whole number of at least 1"),
        (("--engine", "fast"), "engine"),
        (("--preset", "thesis", "--engine", "native"), "which is in Python"),
        (("--preset", "thesis", "--reading", "bones", "--param", "jt.alpha=1"), "the thesis's own program"),
        (("--preset", "thesis", "--reading", "bones", "--robot", "panda"), "two hinges about one point"),
    ],
)
def test_wrong_usage_says_what_would_have_been_right(run, arguments, words):
    result = run("compare", *arguments)
    assert (result.status, result.out) == (2, "")
    assert words in result.err


def test_without_matplotlib_a_plot_names_the_line_that_installs_it(run, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    result = run(*QUICK, "--plot", tmp_path / "bars.png")
    assert (result.status, result.out) == (2, "")
    assert "pip install 'pinik[plots]'" in result.err


class TestPlot:
    @pytest.fixture(autouse=True)
    def _with_matplotlib(self):
        pytest.importorskip("matplotlib")

    def test_bars_are_drawn(self, run, tmp_path):
        assert run(*QUICK, "--plot", tmp_path / "bars.png").status == 0
        assert (tmp_path / "bars.png").read_bytes().startswith(b"\x89PNG")
        assert run(*QUICK, "--plot", tmp_path / "bars.svg").status == 0
        assert "<svg" in (tmp_path / "bars.svg").read_text()

    def test_a_bar_is_a_row_and_the_outline_beside_it_the_thesis_s(self, run):
        answer = run(*QUICK, "--json").json
        iterations, efficiency = draw_comparison(answer).axes[1:3]
        for panel, ours, theirs, factor in (
            (iterations, "counted_iterations", "iterations", 1.0),
            (efficiency, "efficiency", "efficiency", 100.0),
        ):
            filled, outlined = panel.containers[::2], panel.containers[1::2]
            for method, bars, outlines in zip(TABLE, filled, outlined, strict=True):
                rows = [row for row in answer["rows"] if row["method"] == method]
                assert bars.get_label() == method
                assert [bar.get_height() for bar in bars] == pytest.approx([factor * row[ours] for row in rows])
                assert [bar.get_height() for bar in outlines] == pytest.approx(
                    [factor * row["thesis"][theirs] for row in rows]
                )

    def test_a_plot_that_cannot_be_written_is_refused_before_anything_runs(self, run, tmp_path):
        assert "no such folder" in run(*QUICK, "--plot", tmp_path / "none" / "bars.png").err
        assert "png" in run(*QUICK, "--plot", tmp_path / "bars.bmpx").err


def test_progress_shows_on_a_terminal_and_only_there(environment):
    """The bar is on stderr, where a terminal is; stdout stays the answer's."""
    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "pinik", "compare", "--steps", "30", "--json"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=follower, env=environment | {"TERM": "xterm"}
    ) as process:
        os.close(follower)
        assert process.stdout is not None
        shown = b""
        out = b""
        while True:
            try:
                part = os.read(leader, 65536)
            except OSError:
                break
            if not part:
                break
            shown += part
        out = process.stdout.read()
        process.wait(timeout=60)
    os.close(leader)
    assert b"tuned, defaults" in shown
    assert out.startswith(b'{"schema": 1')
    assert out.count(b"\n") == 1
