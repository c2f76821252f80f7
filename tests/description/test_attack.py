"""Mutated robots are refused in words, or placed as yourdfpy places them; `tools/attack_urdf.py` tries more."""

from __future__ import annotations

import contextlib
import importlib
import os
import signal
import sys
import tempfile
import types
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from urdf_attack.corpus import robots
from urdf_attack.mutations import Case, mutated
from urdf_attack.report import Report
from urdf_attack.workers import Worker

from urdf_texts import chain, link, pair, robot

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


def test_the_guided_attack_leaves_nothing_in_the_working_directory(tmp_path, monkeypatch):
    """libFuzzer writes the input that it stopped at wherever its artifact_prefix says."""
    given: list[str] = []
    atheris = types.ModuleType("atheris")
    atheris.instrument_imports = lambda include: contextlib.nullcontext()
    atheris.Setup = lambda arguments, _one: given.extend(arguments)
    atheris.Fuzz = lambda: None
    monkeypatch.setitem(sys.modules, "atheris", atheris)
    monkeypatch.delitem(sys.modules, "urdf_attack.guided", raising=False)
    (tmp_path / "here").mkdir()
    (tmp_path / "temporary").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    guided = importlib.import_module("urdf_attack.guided")
    guided.attack(5, 0, 1.0, Report("", Path("build/attack")))
    [prefix] = [word.partition("=")[2] for word in given if word.startswith("-artifact_prefix=")]
    assert Path(prefix).parent == tmp_path / "temporary"
    assert not any((tmp_path / "here").iterdir())
