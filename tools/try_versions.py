"""Build, install and try pinik under every other Python that it supports and that is found here.

For each of them this makes a virtual environment under build/versions/, builds pinik's wheel with its engine, installs
it there, and runs the tests of what depends on the Python most: loading, solving in both engines, and the command line.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "versions"
TESTS = (
    "tests/test_loading.py",
    "tests/description",
    "tests/solving/test_front.py",
    "tests/solving/test_native.py",
    "tests/solving/test_prepared.py",
    "tests/cli/test_streams.py",
    "tests/cli/commands/test_solve.py",
    "tests/cli/commands/test_check.py",
)
_PREFIX = "Programming Language :: Python :: 3."


def supported() -> list[str]:
    """The versions that pyproject.toml names, such as "3.12"."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return ["3." + name.removeprefix(_PREFIX) for name in project["classifiers"] if name.startswith(_PREFIX)]


def find(version: str) -> str | None:
    """A Python of this version that can make virtual environments: on the PATH, or among those of pyenv."""
    on_path = shutil.which(f"python{version}")
    homes = [os.environ.get("PYENV_ROOT", ""), Path.home() / ".pyenv"]
    of_pyenv = [path for home in homes if home for path in Path(home).glob(f"versions/{version}.*/bin/python")]
    check = f"import ensurepip, venv, sys; sys.exit('{version}' != '%d.%d' % sys.version_info[:2])"
    for candidate in filter(None, [on_path, *of_pyenv]):
        if subprocess.run([candidate, "-c", check], capture_output=True, check=False).returncode == 0:
            return str(candidate)
    return None


def run(*command: str | Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([*map(str, command)], cwd=ROOT, env=environment, check=True)


def try_version(version: str, python: str) -> None:
    folder = FOLDER / version
    shutil.rmtree(folder, ignore_errors=True)
    run(python, "-m", "venv", folder / "venv")
    inside = folder / "venv" / "bin" / "python"
    pip = (inside, "-m", "pip", "--quiet", "--quiet", "--no-input", "--disable-pip-version-check")
    run(*pip, "wheel", "--no-deps", "--wheel-dir", folder / "wheels", ROOT)
    (wheel,) = (folder / "wheels").glob("*.whl")
    run(*pip, "install", f"{wheel}[dev]")
    run(inside, "-m", "pytest", "--quiet", "-p", "no:cacheprovider", *TESTS)


def main() -> int:
    failed = []
    for version in supported():
        if version == f"{sys.version_info.major}.{sys.version_info.minor}":
            continue
        python = find(version)
        if python is None:
            print(f"Python {version} is not found here, so pinik is not tried under it", flush=True)
            continue
        print(f"Trying pinik under Python {version} (several minutes, as its engine is compiled)", flush=True)
        try:
            try_version(version, python)
        except subprocess.CalledProcessError as error:
            failed.append(version)
            print(f"Python {version}: {error}", flush=True)
    if failed:
        print(f"pinik fails under Python {' and '.join(failed)}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
