"""One virtual environment per peer, made once in the user's cache folder."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import platformdirs

from .peer_list import Peer

__all__ = ["CannotInstallError", "python_of"]


class CannotInstallError(RuntimeError):
    """A peer's packages could not be installed; the message says why."""


def python_of(peer: Peer) -> Path:
    """The interpreter that has the peer's packages; its environment is made if it is not there yet.

    Raises:
        CannotInstallError: pip could not install the packages.
    """
    if not peer.requirements:
        return Path(sys.executable)
    home = _home(peer)
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    finished = home / "finished"
    if not finished.exists():
        shutil.rmtree(home, ignore_errors=True)
        print(f"making an environment for {peer.label}: {home}", file=sys.stderr)
        try:
            _run([sys.executable, "-m", "venv", str(home)])
            pip = [str(python), "-m", "pip", "--quiet", "--no-input", "--disable-pip-version-check"]
            _run([*pip, "install", *peer.requirements])
        except CannotInstallError:
            shutil.rmtree(home, ignore_errors=True)
            raise
        finished.touch()
    return python


def _home(peer: Peer) -> Path:
    """A folder that is another one for other versions."""
    cache = os.environ.get("PINIK_CACHE_DIR") or platformdirs.user_cache_dir("pinik", appauthor=False)
    what = "\n".join([sys.version, *peer.requirements])
    return Path(cache) / "peers" / f"{peer.key}-{hashlib.sha256(what.encode()).hexdigest()[:12]}"


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        said = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        errors = [line for line in said if line.startswith("ERROR")] or said
        raise CannotInstallError(errors[-1] if errors else f"{command[0]} ended with status {done.returncode}")
