"""Solvers added to `pinik.SOLVERS` as CONTRIBUTING.md describes: every front of pinik takes them."""

from __future__ import annotations

import colorsys
import itertools
import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import pinik
from judge import plain_placement
from pinik.cli import main
from pinik.cli.reports.method_style import iteration_word, method_colors
from pinik.studies.accuracy import accuracy, problems
from pinik.studies.ball_chain import BallChain, ProgramChase
from pinik.studies.chain import planar_chain
from pinik.studies.comparison import COMPARISONS, compare
from pinik.studies.spread import drags, firmer_towards_the_tip, spread
from pinik.studies.straight_arm import pull_inwards
from pinik.studies.thesis import PRESETS, contest
from pinik.viewer.protocol.messages import apply
from pinik.viewer.protocol.setup import apply_setup, read_setup, write_setup
from pinik.viewer.protocol.state import hello_message, session_state
from pinik.viewer.simulation.session import Session
from stand_ins import Clock

FOUR = ("ccd", "jt", "pinv", "dls")
PLACE = (0.3, 0.1, 0.8)
ASKED = ("solve", "arm", "--frame", "tip", "--position", *PLACE)


@dataclass(frozen=True, kw_only=True)
class Marquardt(pinik.JacobianSolver):
    """The solver that CONTRIBUTING.md adds."""

    name = "marquardt"
    damping: float = pinik.parameter(0.01, "μ", low=1e-9)

    def direction(self, J, e):
        A = J.T @ J
        return np.linalg.solve(A + self.damping * np.diag(A.diagonal() + 1e-9), J.T @ e)


@dataclass(frozen=True, kw_only=True)
class Idle(pinik.SweepingSolver):
    """A method that changes nothing, without stiffness weights and with a field made without `parameter`."""

    name = "idle"
    mood: str = "lazy"

    def sweep(self, q, *_):
        return q, 1


@dataclass(frozen=True, kw_only=True)
class Failing(pinik.JacobianSolver):
    """A method with a bug."""

    name = "failing"

    def direction(self, J, e):
        raise OSError("no licence")


@pytest.fixture(autouse=True)
def _registered(monkeypatch):
    for solver in (Marquardt, Idle):
        monkeypatch.setitem(pinik.SOLVERS, solver.name, solver)


@pytest.fixture
def run(capsys):
    """Run one command line; gives back exit status, stdout and stderr."""

    def run_here(*arguments):
        status = main([str(argument) for argument in arguments])
        return status, *capsys.readouterr()

    return run_here


def reaches(robot, q, place=PLACE):
    return np.linalg.norm(plain_placement(robot, "tip", q).translation - place) <= 1e-4


# The command line


def test_solve_takes_its_name_and_its_parameters(run, arm):
    status, out, err = run(*ASKED, "--method", "marquardt", "--param", "damping=0.2", "--json")
    answer = json.loads(out)
    assert (status, err) == (0, "")
    assert (answer["method"], answer["parameters"]["damping"]) == ("marquardt", 0.2)
    assert reaches(arm, np.array(answer["q"]))


def test_solve_says_when_it_misses_and_when_it_fails(run, monkeypatch):
    assert run(*ASKED, "--method", "idle", "--restarts", 0)[0] == 1
    monkeypatch.setitem(pinik.SOLVERS, "failing", Failing)
    status, out, err = run(*ASKED, "--method", "failing")
    assert (status, out, err) == (2, "", "error: --method failing: the solver failed: OSError: no licence\n")


def test_the_help_of_solve_lists_it_although_it_came_after_the_import(run):
    status, out, err = run("solve", "--help")
    lines = [line.strip() for line in out.splitlines()]
    assert (status, err) == (0, "")
    assert "damping: μ (at least 1e-09; default 0.01)" in lines[lines.index("marquardt:") :]
    assert "mood (default lazy)" in lines[lines.index("idle:") :]


def test_a_mistyped_name_is_suggested(run):
    assert "no method 'marquard'; did you mean 'marquardt'" in run(*ASKED, "--method", "marquard")[2]


def test_compare_shows_it_beside_the_four_without_figures_of_the_thesis(run, tmp_path):
    picture = tmp_path / "bars.png"
    status, out, err = run("compare", "--steps", 1, "--plot", picture, "--json")
    rows = json.loads(out)["rows"]
    assert (status, err) == (0, "")
    assert [row["method"] for row in rows[:6]] == [*FOUR, "marquardt", "idle"]
    assert all((row["thesis"] is None) == (row["method"] not in FOUR) for row in rows)
    assert all(row["efficiency"] == 1.0 for row in rows if row["method"] == "marquardt" and row["motion"] == "curve")
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert " marquardt " in run("compare", "--steps", 1)[1]


@pytest.mark.parametrize("reading", ["literal", "bones"])
def test_the_thesis_keeps_its_own_four(run, reading):
    status, out, err = run("compare", "--preset", "thesis", "--reading", reading, "--steps", 1, "--json")
    assert (status, err) == (0, "")
    assert {row["method"] for row in json.loads(out)["rows"]} == set(FOUR)


def test_accuracy_measures_and_draws_it(run, tmp_path):
    pictures = [tmp_path / f"{name}.png" for name in ("costs", "straight", "spread")]
    options = zip(("--plot", "--plot-straight", "--plot-spread"), pictures, strict=True)
    quick = ("accuracy", "--problems", 1, "--digits", 2)
    status, out, err = run(*quick, *itertools.chain(*options), "--json")
    answer = json.loads(out)
    assert (status, err) == (0, "")
    assert list(answer["parameters"]) == [*FOUR, "marquardt", "idle"]
    solved = {row["method"]: row["solved"] for row in answer["rows"]}
    assert (solved["marquardt"], solved["idle"]) == (1.0, 0.0)
    weighted = [own["method"] for own in answer["spread"] if own["stiffness"]]
    assert weighted == [*FOUR, "marquardt"]  # "idle" takes no weights
    assert all(picture.read_bytes().startswith(b"\x89PNG") for picture in pictures)
    table = [line.split() for line in run(*quick)[1].splitlines()]
    assert any(words[:3] == ["near", "marquardt", "steps"] for words in table)
    assert any(words[:3] == ["near", "idle", "sweeps"] for words in table)


def test_every_command_runs_with_the_solver_of_contributing_registered_before_the_import(tmp_path):
    page = (Path(__file__).parents[1] / "CONTRIBUTING.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    commands = [
        [*map(str, ASKED), "--method", "marquardt"],
        ["solve", "--help"],
        ["fk", "arm", "--frame", "tip"],
        ["compare", "--steps", "1", "--plot", str(tmp_path / "a.png")],
        ["accuracy", "--problems", "1", "--digits", "1", "--plot", str(tmp_path / "b.png")],
    ]
    script = f"""{blocks[0]}
{blocks[1]}
import pinik.cli
assert "marquardt" in pinik.SOLVERS
assert [pinik.cli.main(command) for command in {commands!r}] == [0] * {len(commands)}
"""
    path = os.pathsep.join([str(Path(pinik.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    environment = os.environ | {"PYTHONPATH": path}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


# The live view


def test_a_session_offers_it_runs_it_and_tells_its_parameters(arm):
    session = Session(arm, ["marquardt", "dls"], clock=Clock())
    assert {"marquardt", "idle"} <= set(session.offered)
    apply(session, {"type": "ball", "index": 0, "position": list(PLACE)})
    apply(session, {"type": "step"})
    first = session_state(session)["instances"][0]
    assert (first["method"], first["status"]) == ("marquardt", "CONVERGED")
    assert [one["name"] for one in first["parameters"]][-1] == "damping"
    assert reaches(arm, session.instances[0].q)
    json.dumps(session_state(session), allow_nan=False)


def test_the_page_s_menu_has_it_and_the_page_can_choose_it(arm):
    session = Session(arm, clock=Clock())
    menu = {one["name"]: one["title"] for one in hello_message("1", session.methods, [], "5f")["methods"]}
    assert (menu["marquardt"], menu["idle"]) == ("marquardt", "idle")
    apply(session, {"type": "method", "instance": 3, "method": "marquardt"})
    apply(session, {"type": "parameter", "instance": 3, "name": "damping", "value": 0.5})
    apply(session, {"type": "method", "instance": 2, "method": "idle"})
    apply(session, {"type": "step"})
    assert session.instances[3].solver == Marquardt(damping=0.5)
    other = Session(arm, clock=Clock())
    apply_setup(other, read_setup(write_setup(session)))
    assert other.instances[3].solver == Marquardt(damping=0.5)


# Python


def test_every_front_of_the_library_takes_its_name(arm):
    assert reaches(arm, arm.solve("tip", PLACE, method="marquardt", damping=0.1).q)
    target = pinik.Target("tip", PLACE)
    assert reaches(arm, pinik.solve(arm, target, "marquardt").q)
    assert reaches(arm, pinik.prepare(arm, target, "marquardt")(PLACE).q)
    assert reaches(arm, list(pinik.iterate(arm, target, "marquardt"))[-1].q)
    many = pinik.solve_many(arm, "tip", np.array([PLACE, PLACE]), method="marquardt")
    assert all(reaches(arm, q) for q in many.q)
    assert not arm.solve("tip", PLACE, method="idle", restarts=0)


def test_the_studies_run_it(arm):
    chosen = contest(arm, "tip", "tuned")
    assert chosen.methods == (*FOUR, "marquardt", "idle")
    (row,) = compare(arm, "tip", ["marquardt"], chosen.begin, chosen.rules, steps=3, comparisons=COMPARISONS[:1])
    assert (row.method, row.efficiency) == ("marquardt", 1.0)
    chain = planar_chain(4)
    solvers = {"marquardt": Marquardt()}
    (cost,) = accuracy(chain, solvers, {"near": problems(chain, "near", 1)}, [3], repeats=1)
    assert (cost.method, cost.solved) == ("marquardt", 1.0)
    assert all(pull.restarted.success for pull in pull_inwards(chain, solvers))
    asked = drags(chain, 5)
    assert spread(chain, Idle(), asked, {}).solved == 0.0
    assert spread(chain, Marquardt(), asked, firmer_towards_the_tip(chain)).solved == 1.0


def test_the_thesis_s_program_refuses_it(arm):
    chain = BallChain.of(arm, "tip", arm.neutral())
    rest = {"unit": 1.0, "tolerance": 0.05, "alpha": 0.01, "damping": 1.1, "max_angle": 0.2, "max_iterations": 1}
    with pytest.raises(pinik.UnknownNameError, match="no method of the thesis 'marquardt'"):
        ProgramChase("marquardt", chain, **rest)
    for reading in PRESETS["thesis"]:
        chosen = contest(arm, "tip", "thesis", reading)
        assert chosen.methods == FOUR
        with pytest.raises(pinik.UnknownNameError, match="no method 'marquardt'"):
            chosen.begin("marquardt", COMPARISONS[0], arm.neutral())


# How it looks


def test_any_number_of_methods_have_colours_that_can_be_told_apart():
    usual = method_colors(FOUR)
    colors = method_colors([*FOUR, *(f"mine{k}" for k in range(8))])
    assert {name: colors[name] for name in FOUR} == usual
    hues = sorted(colorsys.rgb_to_hls(*(int(c[k : k + 2], 16) / 255 for k in (1, 3, 5)))[0] for c in colors.values())
    gaps = np.diff([*hues, hues[0] + 1.0])
    assert gaps.min() > 1.0 / 24


def test_iterations_of_a_sweeping_method_are_sweeps():
    assert [iteration_word(name) for name in ("idle", "ccd")] == ["sweeps", "sweeps"]
    assert [iteration_word(name) for name in ("marquardt", "dls")] == ["steps", "steps"]
