"""Mutation testing of rooms of src/pinik with mutmut: which changes of their code does no test notice?

    python tools/mutants.py solvers problem

mutmut works in a copy of the checkout, build/mutants, and a second run goes on where the first one stopped. It changes
functions as they are called, so what runs only while pinik is imported (the defaults of parameters) always survives.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
COPY = ROOT / "build" / "mutants"
COPIED = ("src", "tests", "tools", "benchmarks", "urdf", "pyproject.toml")
# The quickest tests that cover each room; a mutant that outlives them may still die in the whole suite.
TESTS = {
    "solvers": ["tests/solvers", "tests/solving/test_within.py", "tests/solving/test_at_once.py"],
    "problem": ["tests/problem", "tests/solving/test_scale.py"],
    "solving": ["tests/solving"],
    "description": ["tests/description/test_reader.py", "tests/description/test_packages.py", "tests/test_loading.py"],
}


def main(rooms: list[str]) -> int:
    for room in rooms:
        folder = COPY / room
        for name in COPIED:
            source, target = ROOT / name, folder / name
            if source.is_dir():
                shutil.copytree(source, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                folder.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, target)
        with (folder / "pyproject.toml").open("a") as file:
            file.write(_settings(room))
        mutmut = [sys.executable, "-m", "mutmut"]
        subprocess.run([*mutmut, "run"], cwd=folder, check=False)
        subprocess.run([*mutmut, "results"], cwd=folder, check=False)
        print(f"To see one: cd {folder.relative_to(ROOT)} && {sys.executable} -m mutmut show NAME")
    return 0


def _settings(room: str) -> str:
    return f"""
[tool.mutmut]
source_paths = ["src/"]
only_mutate = ["src/pinik/{room}/*"]
pytest_add_cli_args_test_selection = {TESTS[room]!r}
pytest_add_cli_args = ["-p", "no:cacheprovider", "-x", "--timeout=60"]
also_copy = ["urdf", "tools", "benchmarks", "tests", "pyproject.toml"]
"""


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
