from __future__ import annotations

import resource
import subprocess
import sys

from start_up import SOLVE, modules_after

HEAVY = ("yourdfpy", "trimesh", "meshcat", "scipy", "matplotlib", "IPython")

IMPORTING = 0.3  # seconds that Pinocchio and numpy alone take, where the 0.8 s below were set


def processor_time(environment: dict[str, str], *arguments: str) -> float:
    """What another Python takes, user and system [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], env=environment, check=True, stdout=subprocess.DEVNULL, timeout=30)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def test_solving_imports_nothing_that_it_does_not_need(environment):
    for options in ([], ["--json"]):
        assert modules_after(environment, SOLVE + options).isdisjoint((*HEAVY, "rich"))


def test_solving_answers_soon_from_a_cold_start(environment):
    """0.8 s are allowed; processor time stands for them, as wall time belongs to whatever else the machine does.

    A machine that is slow at the moment, by the time that importing Pinocchio takes on it, is allowed more.
    """
    imports, solves = [], []
    for _ in range(3):
        imports.append(processor_time(environment, "-c", "import numpy, pinocchio"))
        solves.append(processor_time(environment, "-m", "pinik", *SOLVE))
    assert min(solves) < 0.8 * max(1.0, min(imports) / IMPORTING)
