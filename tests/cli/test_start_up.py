from __future__ import annotations

import resource
import subprocess
import sys

from start_up import SOLVE, modules_after

HEAVY = ("yourdfpy", "trimesh", "meshcat", "scipy", "matplotlib", "IPython")
# Modules of Python that are slow to load, and that few runs need; only what numpy and Pinocchio import is free.
ON_DEMAND = (
    "concurrent.futures", "difflib", "hashlib", "html", "logging", "multiprocessing", "numpy.polynomial", "socket",
    "ssl", "subprocess", "tempfile", "zipfile",
)  # fmt: skip
EXTRAS = (
    "dask",
    "distributed",
    "h5py",
    "matplotlib",
    "PIL",
    "pyarrow",
    "rich",
    "tornado",
    "trimesh",
    "typer",
    "yourdfpy",
)
FEW = 250  # modules of others than numpy and Pinocchio; there are about 205
TIMES = 6.0  # as long as importing numpy and Pinocchio; it takes about 3.4 times as long


def test_solving_imports_nothing_that_it_does_not_need(environment):
    for options in ([], ["--json"]):
        assert modules_after(environment, SOLVE + options).isdisjoint((*HEAVY, "rich", "tornado"))


def test_importing_pinik_imports_no_extra_and_no_slow_module_that_few_runs_need(environment):
    script = "import sys, numpy, pinocchio; free = {*sys.modules}; import pinik; print(*sys.modules.keys() - free)"
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=60, check=True
    )
    assert {*done.stdout.split()}.isdisjoint({*ON_DEMAND, *EXTRAS})


def test_a_command_imports_no_module_of_another_command(environment):
    loaded = modules_after(environment, ["fk", "arm", "--frame", "tip"])
    prefix = "pinik.cli.commands."
    assert {name for name in loaded if name.startswith(prefix)} == {prefix + "fk"}
    assert loaded.isdisjoint(("rich", "statistics", "pinik.studies.thesis", "pinik.cli.reports.plots"))


def test_solving_imports_few_modules_of_others_beside_numpy_and_pinocchio(environment):
    script = "import sys, numpy, pinocchio; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=60, check=True
    )
    others = {name for name in modules_after(environment, SOLVE) if name.partition(".")[0] != "pinik"}
    assert len(others - set(done.stdout.split())) < FEW


def test_solving_from_a_cold_start_takes_a_few_times_as_long_as_its_imports(environment):
    """Both in processor time, in turns, each at its best of several: whatever else the machine does slows down both."""

    def processor_time(*arguments: str) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [sys.executable, *arguments]
        subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, timeout=60)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    imports, solves = [], []
    for _ in range(4):
        imports.append(processor_time("-c", "import numpy, pinocchio"))
        solves.append(processor_time("-m", "pinik", *SOLVE))
    assert min(solves) < TIMES * min(imports)
