"""Mutated robots are refused in words, or placed as yourdfpy places them; `tools/attack_urdf.py` tries more."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from urdf_attack.corpus import robots
from urdf_attack.mutations import Case, mutated
from urdf_attack.workers import Worker

from urdf_texts import chain, link, pair, robot

TOOL = Path(__file__).parents[2] / "tools" / "attack_urdf.py"
ROBOTS = robots()


@pytest.fixture(scope="module")
def worker() -> Iterator[Worker]:
    """A process that judges inputs: 5 s of computing, 2 GB and the robot's own folders are all that each may take."""
    one = Worker()
    yield one
    one.close()


@settings(max_examples=400, deadline=None, suppress_health_check=list(HealthCheck))
@given(random=st.randoms(use_true_random=False))
def test_a_mutated_robot_is_refused_in_words_or_stands_where_yourdfpy_has_it(worker, random):
    case = mutated(random, ROBOTS)
    outcome = worker.judged(case)
    assert not outcome.is_fault, f"{outcome.kind}: {outcome.words}\n{case.written[:20_000]!r}"


def case(written: str, meant: str | None = None, harmless: bool = False) -> Case:
    return Case(written.encode(), (meant or written).encode(), harmless, shapes=True)


# Each is an input that the attack must tell from a good one, else it finds nothing.
@pytest.mark.parametrize(
    ("given", "kind"),
    [
        (case(pair()), "agreed"),
        (case(pair().replace("revolute", "hinge")), "refused"),
        (case(pair('<origin xyz="0 0 1"/>'), meant=pair('<origin xyz="0 0 1.001"/>')), "disagreed"),
        (case(pair('<axis xyz="0 0 1"/>'), meant=pair('<axis xyz="0 0 -1"/>')), "disagreed"),
        (case(pair(), meant=robot(link("a"))), "disagreed"),
        (case(pair(), meant="<robot"), "unread"),
        (case(pair().replace('joint name="', 'joint name="x'), meant=pair('<axis xyz="0 0 -1"/>')), "renamed"),
        (case(pair().replace("revolute", "hinge"), harmless=True), "stopped"),
        (case(chain(3_000, "fixed")), "agreed"),
    ],
)
def test_the_attack_tells_outcomes_apart(worker, given, kind):
    assert worker.judged(given).kind == kind


def test_the_attack_goes_on_after_a_crash(worker):
    os.kill(worker.process_id, signal.SIGKILL)
    assert worker.judged(case(pair())).kind == "crashed"
    assert worker.judged(case(pair())).kind == "agreed"


ATHERIS = """
import contextlib, sys

def instrument_imports(include):
    assert "pinik" not in sys.modules, "pinik would not be instrumented"
    return contextlib.nullcontext()

class FuzzedDataProvider:
    def __init__(self, data):
        self.data = data

    def ConsumeUInt(self, count):
        taken, self.data = self.data[:count], self.data[count:]
        return int.from_bytes(taken, "little")

    def remaining_bytes(self):
        return len(self.data)

def Setup(arguments, one):
    global attacked
    attacked = one
    print(*arguments, sep="\\n")

def Fuzz():
    for data in (b"", b"\\x00" * 400, b"\\xff" * 400, bytes(range(256)), bytes(range(255, 0, -1))):
        attacked(data)
"""


def test_the_guided_attack_instruments_pinik_and_leaves_nothing_in_the_working_directory(tmp_path):
    """A stand-in for atheris runs the command on a few inputs; pinik must not be imported before atheris watches.

    libFuzzer writes the input that it stopped at wherever its artifact_prefix says.
    """
    here, temporary, modules = tmp_path / "here", tmp_path / "temporary", tmp_path / "modules"
    for folder in (here, temporary, modules):
        folder.mkdir()
    (modules / "atheris.py").write_text(ATHERIS)
    surroundings = {**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": os.pathsep.join([str(modules), *sys.path])}
    command = [sys.executable, "-W", "ignore", str(TOOL), "--atheris", "--count", "5"]
    done = subprocess.run(command, cwd=here, env=surroundings, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "5 inputs" in done.stdout
    [prefix] = [word.partition("=")[2] for word in done.stdout.split() if word.startswith("-artifact_prefix=")]
    assert Path(prefix).parent == temporary
    assert not any(here.iterdir())
