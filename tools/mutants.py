"""Mutation testing of rooms of src/pinik with mutmut: which changes of their code does no test notice?

    python tools/mutants.py solvers problem
    python tools/mutants.py solving --sample 200 --seed 1

mutmut works in a copy of the checkout, build/mutants, and a second run goes on where the first one stopped; a sample is
run anew each time. mutmut changes functions as they are called, so what runs only while pinik is imported (the defaults
of parameters) always survives.
"""

from __future__ import annotations

import argparse
import filecmp
import os
import random
import shutil
import subprocess
import sys
from collections import Counter
from contextlib import chdir
from pathlib import Path

ROOT = Path(__file__).parents[1]
COPY = ROOT / "build" / "mutants"
COPIED = ("src", "tests", "tools", "benchmarks", "urdf", "docs", "pyproject.toml")
# Tests that take seconds, measure time, start threads, or start processes, which mutmut cannot follow.
SLOW = {
    "solving": (
        *("agrees_in_its_verdict", "any_chain", "asked_often", "catalogue", "ctrl_c", "dls_rests", "few_kinds"),
        *("jitter", "more_iterations", "moved_30_cm", "never_farther", "no_target", "positions_rotations"),
        *("single_solves", "stretched_out", "than_a_block", "thread", "changes_nothing and python"),
    ),
    "description": (
        *("anything_heavy", "every_robot_loads", "many_mends", "never_opened", "side_by_side", "standard_input"),
        *("thousands", "too_long"),
    ),
}
# [s] for one test, by the clock on the wall: a busy machine takes many times as long. mutmut itself bounds mutants.
LONGEST = 600
# What runs in a process of its own, where mutmut cannot follow.
NOT_MUTATED = ("src/pinik/description/xacro_process.py",)
# The quickest tests that cover each room; a mutant that outlives them may still die in the whole suite.
TESTS = {
    "solvers": [
        *("tests/solvers", "tests/closed_form/test_robot_bones.py"),
        *("tests/solving/test_within.py", "tests/solving/test_at_once.py"),
    ],
    "problem": ["tests/problem", "tests/solving/test_within.py", "tests/solving/test_scale.py"],
    "solving": [
        "tests/solving",
        *(f"--ignore=tests/solving/test_{name}.py" for name in ("attack", "certificate", "native", "native_build")),
        *(f"--ignore=tests/solving/test_{name}.py" for name in ("native_equivalence", "polish", "track_equivalence")),
        *("-k", f"not ({' or '.join(SLOW['solving'])})"),
    ],
    "description": [
        *("tests/description", "tests/test_loading.py"),
        *(f"--ignore=tests/description/test_{name}.py" for name in ("attack", "own_robots")),
        *("-k", f"not ({' or '.join(SLOW['description'])})"),
    ],
}


def main() -> int:
    """The exit status is 1 if the tests fail without any change, or mutmut was stopped before it tried all mutants."""
    asked = argparse.ArgumentParser(description="Tell which changes of the code of rooms no test notices.")
    asked.add_argument("rooms", nargs="+", choices=TESTS, metavar="ROOM", help=f"one of {', '.join(TESTS)}")
    asked.add_argument("--sample", type=int, metavar="N", help="try N changes of each room instead of all")
    asked.add_argument("--seed", type=int, default=1, help="the choice of the sample (default: 1)")
    asked.add_argument("--processes", type=int, metavar="N", help="at once (default: one for each core)")
    options = asked.parse_args()
    processes = [] if options.processes is None else ["--max-children", str(options.processes)]
    is_whole = True
    for room in options.rooms:
        folder = _copy(room)
        _check_names_of_tests(folder, room)
        names = [] if options.sample is None else _sample(folder, room, options.sample, options.seed)
        subprocess.run([sys.executable, "-m", "mutmut", "run", *processes, *names], cwd=folder, check=False)
        is_whole = _report(folder, room, names) and is_whole
    return 0 if is_whole else 1


def _copy(room: str) -> Path:
    """A copy of the checkout, set up for the mutants of a room."""
    folder = COPY / room
    for name in COPIED:
        source, target = ROOT / name, folder / name
        if source.is_dir():
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(source, target, dirs_exist_ok=True, ignore=ignored, copy_function=_copy_if_changed)
        else:
            folder.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
    with (folder / "pyproject.toml").open("a") as file:
        file.write(_settings(room))
    return folder


def _copy_if_changed(source: str, target: str) -> None:
    """Copy a file as a new one: mutmut keeps its mutants of a file that is older than they are."""
    if not (os.path.exists(target) and filecmp.cmp(source, target, shallow=False)):
        shutil.copyfile(source, target)


def _settings(room: str) -> str:
    return f"""
[tool.mutmut]
source_paths = ["src/"]
only_mutate = ["src/pinik/{room}/*"]
do_not_mutate = {[*NOT_MUTATED]!r}
pytest_add_cli_args_test_selection = {TESTS[room]!r}
pytest_add_cli_args = ["-p", "no:cacheprovider", "-x", "--timeout={LONGEST}"]
also_copy = {[name for name in COPIED if name != "src"]!r}
timeout_multiplier = 4.0
timeout_constant = 5.0
"""


def _check_names_of_tests(folder: Path, room: str) -> None:
    """Refuse tests whose names change when they are collected again: mutmut would take them for failed ones."""
    collect = f"""
import pytest
class Names:
    def pytest_collection_modifyitems(self, items):
        collected.append({{item.nodeid for item in items}})
collected = []
for _ in range(2):
    pytest.main(["--collect-only", "-qqq", *{TESTS[room]!r}], plugins=[Names()])
assert collected[0] == collected[1], f"these tests change their names: {{collected[0] - collected[1]}}"
"""
    own = {**os.environ, "PYTHONPATH": "src"}
    subprocess.run([sys.executable, "-c", collect], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=own)


def _sample(folder: Path, room: str, size: int, seed: int) -> list[str]:
    """The names of some of a room's mutants, each as likely as any other."""
    with chdir(folder):  # where mutmut looks for its settings
        from mutmut.mutation.file_mutation import mutate_file_contents
        from mutmut.utils.format_utils import get_mutant_name

        names = [
            get_mutant_name(path, mutant)
            for path in sorted(Path("src/pinik", room).rglob("*.py"))
            if str(path) not in NOT_MUTATED
            for mutant in mutate_file_contents(str(path), path.read_text()).mutant_names
        ]
    return random.Random(seed).sample(names, min(size, len(names)))


def _report(folder: Path, room: str, names: list[str]) -> bool:
    """Print what became of the mutants, of all or of those with these names, and list those that no test noticed.

    Returns:
        Whether all of them were tried.
    """
    listed = subprocess.run(
        [sys.executable, "-m", "mutmut", "results", "--all", "true"],
        cwd=folder, check=False, capture_output=True, text=True,
    ).stdout  # fmt: skip
    fates = dict(line.strip().rsplit(": ", 1) for line in listed.splitlines() if ": " in line)
    fates = {name: fate for name, fate in fates.items() if not names or name in names}
    for name, fate in fates.items():
        if fate != "killed":
            print(f"    {name}: {fate}")
    print(f"{room}: {', '.join(f'{count} {fate}' for fate, count in Counter(fates.values()).most_common())}")
    print(f"To see one: cd {folder.relative_to(ROOT)} && {sys.executable} -m mutmut show NAME")
    return bool(fates) and "not checked" not in fates.values()


if __name__ == "__main__":
    sys.exit(main())
