"""Build pinik's sdist and its wheels into dist/, and try each wheel in a fresh environment without a compiler.

auditwheel repairs the compiled wheel, and leaves Pinocchio's libraries where they are: pip installs them as cmeel's
wheels, and the engine finds them by its own RPATH. A pure wheel lies beside it, for machines for which there is no
compiled one. Tests are run in both environments, outside the checkout: the engine's in one, those of Python's in the
other.

The engine is compiled only once: `make` has left its objects in build/. That the sdist, from which the pure wheel is
built, would give the same engine follows from its files, which are those of the checkout.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
import tomllib
import zipfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
DIST = ROOT / "dist"
SHARED = ("tests", "benchmarks", "tools", "urdf")
COMPILERS = ("c++", "g++", "clang++", "cmake", "ninja")
PIP = ("-m", "pip", "--quiet", "--no-input", "--disable-pip-version-check")
WITHOUT_ENGINE = (
    "tests/test_loading.py",
    "tests/solvers",
    "tests/closed_form",
    "tests/solving/test_front.py",
    "tests/solving/test_native.py",
)

USE_THE_PURE_WHEEL = """
import pinik
robot = pinik.load("arm")
solution = robot.solve("tip", position=[0.6, 0.3, 0.7])
assert solution.success and solution.engine == "python", solution
try:
    robot.solve("tip", position=[0.6, 0.3, 0.7], engine="native")
except pinik.EngineError as error:
    assert "it was not built when pinik was installed" in str(error), error
else:
    raise AssertionError("the pure wheel has an engine")
"""


class Wheels(NamedTuple):
    compiled: Path
    pure: Path


def settings() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["cibuildwheel"]


def run(*command: str | Path, cwd: Path = ROOT, **environment: str) -> None:
    """Run a command without the checkout's PYTHONPATH."""
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([*map(str, command)], cwd=cwd, env=inherited | environment, check=True)


def only(folder: Path, pattern: str) -> Path:
    (found,) = folder.glob(pattern)
    return found


def build(work: Path) -> Wheels:
    """The sdist, the compiled wheel and the pure wheel in dist/."""
    python = sys.executable
    shutil.rmtree(DIST, ignore_errors=True)
    run(python, "-m", "build", "--no-isolation", "--sdist", "--outdir", DIST, ".")
    sdist = only(DIST, "*.tar.gz")
    compare_with_checkout(sdist)
    wheel = (python, *PIP, "wheel", "--no-deps", "--no-build-isolation")
    run(*wheel, "--config-settings", "wheel.cmake=false", "--wheel-dir", DIST, sdist)
    pure = only(DIST, "*.whl")
    run(*wheel, "--config-settings", f"build-dir={ROOT}/build/{{wheel_tag}}", "--wheel-dir", work / "raw", ROOT)
    raw = only(work / "raw", "*.whl")
    if sys.platform == "linux":
        repair = settings()["linux"]["repair-wheel-command"].format(dest_dir=work / "repaired", wheel=raw)
        run("sh", "-c", repair, PATH=f"{Path(python).parent}{os.pathsep}{os.environ['PATH']}")
        raw = only(work / "repaired", "*.whl")
    compiled = Path(shutil.copy(raw, DIST))
    compare(compiled, pure)
    run(python, "-m", "twine", "check", "--strict", *sorted(DIST.iterdir()))
    return Wheels(compiled, pure)


def compare_with_checkout(sdist: Path) -> None:
    """The sdist holds the checkout's files as they are, but for what builds it on a forge, and nothing else."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    tracked = {name for name in listed.split("\0") if name and not name.startswith(".ci/")}
    held = {}
    with tarfile.open(sdist) as archive:
        for member in archive:  # in the archive's order, as every step back would unpack it anew
            if file := archive.extractfile(member):
                held[member.name.partition("/")[2]] = file.read()
    del held["PKG-INFO"]
    assert set(held) == tracked, sorted(set(held) ^ tracked)
    differ = [name for name in tracked if held[name] != (ROOT / name).read_bytes()]
    assert not differ, differ


def compare(compiled: Path, pure: Path) -> None:
    """The compiled wheel has the engine and what auditwheel notes; all else is the pure wheel's, and pinik's own."""
    whole, plain = ({name for name in zipfile.ZipFile(path).namelist() if name[-1] != "/"} for path in (compiled, pure))
    added = {name for name in whole - plain if ".dist-info/sboms/" not in name}
    assert [name.startswith("pinik/_native.") for name in added] == [True], added
    assert plain <= whole, plain - whole


def without_compiler(folder: Path) -> str:
    """A PATH with the few commands that the tests need, and none that compiles."""
    folder.mkdir()
    for name in ("sh", "env", "git", "uname"):
        if found := shutil.which(name):
            (folder / name).symlink_to(found)
    assert not any(shutil.which(name, path=str(folder)) for name in COMPILERS)
    return str(folder)


def try_out(wheel: Path, work: Path, *commands: str, **environment: str) -> None:
    """Install the wheel into a fresh environment, and run the commands there, far from the checkout."""
    started = time.monotonic()
    work.mkdir()
    run(sys.executable, "-m", "venv", work / "venv")
    python = work / "venv" / "bin" / "python"
    path = without_compiler(work / "bin")
    run(python, *PIP, "install", "--only-binary", ":all:", wheel, *settings()["test-requires"], PATH=path, cwd=work)
    run(python, "-m", "pip", "check", PATH=path, cwd=work)
    elsewhere = work / "elsewhere"
    for name in SHARED:
        shutil.copytree(ROOT / name, elsewhere / name)
    shutil.copy(ROOT / "pyproject.toml", elsewhere)
    for command in commands:
        script = command.format(project=elsewhere)
        run("/bin/sh", "-c", script, cwd=elsewhere, PATH=f"{python.parent}{os.pathsep}{path}", **environment)
    print(f"{wheel.name} passed in {time.monotonic() - started:.0f} s", flush=True)


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="pinik-wheels-") as folder:
        work = Path(folder)
        wheels = build(work)
        try_out(wheels.compiled, work / "compiled", settings()["test-command"], PINIK_REQUIRE_NATIVE="1")
        use = work / "use.py"
        use.write_text(USE_THE_PURE_WHEEL, "utf-8")
        pytest = f"python -m pytest -q -p no:cacheprovider {' '.join(WITHOUT_ENGINE)}"
        try_out(wheels.pure, work / "pure", f"python {use}", pytest)
    for path in sorted(DIST.iterdir()):
        print(f"{path.stat().st_size / 1e6:6.2f} MB  {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
