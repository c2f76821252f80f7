"""The examples run, and what they print is true."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pinik
from judge import assert_honest

ROOT = Path(__file__).parents[1]


def test_every_answer_of_the_tour_is_what_it_says(monkeypatch):
    spec = importlib.util.spec_from_file_location("tour", ROOT / "examples" / "tour.py")
    tour = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "tour", tour)  # its dataclass looks itself up
    spec.loader.exec_module(tour)
    for question in tour.questions():
        for solution in tour.answers(question):
            assert_honest(solution, question.targets)


def test_the_tour_shows_every_robot_by_every_method_plainly_when_piped():
    done = subprocess.run(
        [sys.executable, ROOT / "examples" / "tour.py"],
        capture_output=True,
        check=False,
        encoding="utf-8",
        env={"PATH": "", "PYTHONPATH": str(ROOT / "src"), "PYTHONIOENCODING": "utf-8"},
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "\x1b" not in done.stdout
    sections = done.stdout.split("\n\n")[1:-1]
    assert [section.split(":")[0] for section in sections] == ["arm", "lion", "panda", "arm"]
    for section in sections:
        rows = [line.split()[:2] for line in section.splitlines()[2:]]
        assert [name for name, _ in rows if name in pinik.SOLVERS] == list(pinik.SOLVERS)
    for section in sections[:3]:
        for method in ("ccd", "pinv", "dls"):
            assert re.search(rf"^  {method} +converged ", section, re.MULTILINE), section
    unreachable = sections[3]
    assert len(re.findall(r"^  \w+ +unreachable ", unreachable, re.MULTILINE)) == len(pinik.SOLVERS)
    assert "beyond its chain's reach" in unreachable
