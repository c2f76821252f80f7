"""Virtual environments for what pinik is compared with, made once in the user's cache folder."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import platformdirs

__all__ = ["CannotInstallError", "python_with"]


class CannotInstallError(RuntimeError):
    """Packages could not be installed; the message says why."""


def python_with(requirements: Sequence[str], key: str) -> Path:
    """The interpreter that has these packages, pinik's own for none; its environment is made if it is not there yet.

    Args:
        requirements: As pip takes them.
        key: What the environment's folder is called after.

    Raises:
        CannotInstallError: pip could not install the packages.
    """
    if not requirements:
        return Path(sys.executable)
    home = _home(requirements, key)
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    finished = home / "finished"
    if not finished.exists():
        shutil.rmtree(home, ignore_errors=True)
        print(f"making an environment for {key}: {home}", file=sys.stderr)
        try:
            _run([sys.executable, "-m", "venv", str(home)])
            pip = [str(python), "-m", "pip", "--quiet", "--no-input", "--disable-pip-version-check"]
            _run([*pip, "install", *requirements])
        except CannotInstallError:
            shutil.rmtree(home, ignore_errors=True)
            raise
        finished.touch()
    return python


def _home(requirements: Sequence[str], key: str) -> Path:
    """A folder that is another one for other versions."""
    cache = os.environ.get("PINIK_CACHE_DIR") or platformdirs.user_cache_dir("pinik", appauthor=False)
    what = "\n".join([sys.version, *requirements])
    return Path(cache) / "peers" / f"{key}-{hashlib.sha256(what.encode()).hexdigest()[:12]}"


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        said = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        errors = [line for line in said if line.startswith("ERROR")] or said
        raise CannotInstallError(errors[-1] if errors else f"{command[0]} ended with status {done.returncode}")
