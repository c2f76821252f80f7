"""Build pinik's sdist and its wheels into dist/, and try the compiled wheel in a fresh environment without a compiler.

The compiled wheel is built from the sdist and repaired by auditwheel, which leaves Pinocchio's libraries where they
are: pip installs them as cmeel's wheels, and the engine finds them by its own RPATH. A pure wheel lies beside it, for
machines for which there is no compiled one. Then the engine's tests are run outside the checkout.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
DIST = ROOT / "dist"
SHARED = ("tests", "benchmarks", "tools", "urdf")
COMPILERS = ("c++", "g++", "clang++", "cmake", "ninja")
PIP = ("-m", "pip", "--quiet", "--no-input", "--disable-pip-version-check")


def settings() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["cibuildwheel"]


def run(*command: str | Path, cwd: Path = ROOT, **environment: str) -> None:
    """Run a command without the checkout's PYTHONPATH."""
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([*map(str, command)], cwd=cwd, env=inherited | environment, check=True)


def only(folder: Path, pattern: str) -> Path:
    (found,) = folder.glob(pattern)
    return found


def build(work: Path) -> Path:
    """The sdist, the pure wheel and the compiled wheel in dist/; returns the compiled one."""
    python = sys.executable
    shutil.rmtree(DIST, ignore_errors=True)
    run(python, "-m", "build", "--no-isolation", "--sdist", "--outdir", DIST, ".")
    sdist = only(DIST, "*.tar.gz")
    wheel = (python, *PIP, "wheel", "--no-deps", "--no-build-isolation")
    run(*wheel, "--config-settings", "wheel.cmake=false", "--wheel-dir", DIST, sdist)
    # What was compiled before is only linked again.
    compiled = ("--config-settings", f"build-dir={ROOT}/build/wheels/{{wheel_tag}}")
    run(*wheel, *compiled, "--wheel-dir", work / "raw", sdist)
    raw = only(work / "raw", "*.whl")
    if sys.platform != "linux":
        return Path(shutil.copy(raw, DIST))
    repair = settings()["linux"]["repair-wheel-command"].format(dest_dir=work / "repaired", wheel=raw)
    run("sh", "-c", repair, PATH=f"{Path(python).parent}{os.pathsep}{os.environ['PATH']}")
    return Path(shutil.copy(only(work / "repaired", "*.whl"), DIST))


def without_compiler(folder: Path) -> str:
    """A PATH with the few commands that the tests need, and none that compiles."""
    folder.mkdir()
    for name in ("sh", "env", "git", "uname"):
        if found := shutil.which(name):
            (folder / name).symlink_to(found)
    assert not any(shutil.which(name, path=str(folder)) for name in COMPILERS)
    return str(folder)


def try_out(wheel: Path, work: Path) -> None:
    """Install the wheel into a fresh environment, and run the engine's tests there, far from the checkout."""
    run(sys.executable, "-m", "venv", work / "venv")
    python = work / "venv" / "bin" / "python"
    path = without_compiler(work / "bin")
    config = settings()
    run(python, *PIP, "install", "--only-binary", ":all:", wheel, *config["test-requires"], PATH=path, cwd=work)
    run(python, "-m", "pip", "check", PATH=path, cwd=work)
    elsewhere = work / "elsewhere"
    for name in SHARED:
        shutil.copytree(ROOT / name, elsewhere / name)
    shutil.copy(ROOT / "pyproject.toml", elsewhere)
    command = config["test-command"].format(project=elsewhere)
    environment = {"PATH": f"{python.parent}{os.pathsep}{path}", "PINIK_REQUIRE_NATIVE": "1"}
    run("/bin/sh", "-c", command, cwd=elsewhere, **environment)


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="pinik-wheels-") as folder:
        wheel = build(Path(folder))
        try_out(wheel, Path(folder))
    for path in sorted(DIST.iterdir()):
        print(f"{path.stat().st_size / 1e6:6.2f} MB  {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
