from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import pinik
from pinik.cli import main

PACKAGE_PARENT = Path(pinik.__file__).resolve().parents[1]


class Result(NamedTuple):
    status: int
    out: str
    err: str

    @property
    def json(self) -> dict[str, Any]:
        def refuse(word: str) -> None:
            raise AssertionError(f"{word} is no JSON")

        return json.loads(self.out, parse_constant=refuse)


Run = Callable[..., Result]


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run one command line in this process; what compiled code writes is seen too."""

    def run_here(*arguments: object, stdin: str = "") -> Result:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin.encode())))
        capfd.readouterr()
        status = main([str(argument) for argument in arguments])
        return Result(status, *capfd.readouterr())

    return run_here


@pytest.fixture(scope="session")
def environment() -> dict[str, str]:
    """For a process of its own: this package, and no say of the surroundings in colours and widths."""
    meddling = (
        "COLUMNS",
        "FORCE_COLOR",
        "GITHUB_ACTIONS",
        "NO_COLOR",
        "PY_COLORS",
        "PYTHONIOENCODING",
        "PYTHONWARNINGS",
    )
    kept = {name: value for name, value in os.environ.items() if name not in meddling}
    path = os.pathsep.join(filter(None, [str(PACKAGE_PARENT), os.environ.get("PYTHONPATH")]))
    return kept | {"PYTHONPATH": path}


@pytest.fixture(scope="session")
def run_process(environment: dict[str, str]) -> Run:
    """Run one command line in a process of its own."""

    def run_there(*arguments: object, stdin: str = "", **variables: str) -> Result:
        done = subprocess.run(
            [sys.executable, "-m", "pinik", *map(str, arguments)],
            input=stdin.encode(),
            capture_output=True,
            env=environment | variables,
            timeout=60,
            check=False,
        )
        return Result(done.returncode, done.stdout.decode(), done.stderr.decode())

    return run_there
