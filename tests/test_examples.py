"""The examples run, and what they print is true."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pinik

ROOT = Path(__file__).parents[1]


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
