from __future__ import annotations

import resource
import subprocess
import sys

SOLVE = ["solve", "arm", "--frame", "tip", "--position", "0.3", "0.1", "0.8"]
HEAVY = ("yourdfpy", "trimesh", "meshcat", "scipy", "matplotlib", "IPython")


def modules_after(environment: dict[str, str], arguments: list[str]) -> set[str]:
    script = (
        "import sys\nfrom pinik.cli import main\n"
        f"status = main({arguments!r})\n"
        "sys.stderr.write('\\n'.join(sys.modules))\nsys.exit(status)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=30, check=True
    )
    return set(done.stderr.split())


def processor_time_of_children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def test_solving_imports_nothing_that_it_does_not_need(environment):
    for options in ([], ["--json"]):
        assert modules_after(environment, SOLVE + options).isdisjoint((*HEAVY, "rich"))


def test_solving_answers_soon_from_a_cold_start(environment):
    """0.8 s are allowed; processor time stands for them, as wall time belongs to whatever else the machine does."""
    seconds = []
    for _ in range(3):
        before = processor_time_of_children()
        subprocess.run(
            [sys.executable, "-m", "pinik", *SOLVE], env=environment, check=True, stdout=subprocess.DEVNULL, timeout=30
        )
        seconds.append(processor_time_of_children() - before)
    assert min(seconds) < 0.8
