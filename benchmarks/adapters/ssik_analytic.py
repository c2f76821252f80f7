"""ssik: analytic solutions by the module that `ssik build` writes for an arm."""

from __future__ import annotations

import contextlib
import importlib.util
import io
from pathlib import Path
from typing import Any

import numpy as np
from ssik.cli import main as ssik


class Ssik:
    """The module of the arm's own URDF, asked for the one solution nearest to the start (its documented quick call)."""

    def __init__(self, arm: dict[str, Any]) -> None:
        urdf = Path(arm["urdf"])
        module = urdf.with_name(f"{urdf.stem}_ik.py")
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            words = ["build", str(urdf), "--base", arm["base"], "--ee", arm["tip"], "--out", str(module)]
            status = ssik([*words, "--no-validate"])
        if status:
            raise RuntimeError(f"ssik build failed: {said.getvalue().strip().splitlines()[-1]}")
        specification = importlib.util.spec_from_file_location(module.stem, module)
        self._arm = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(self._arm)

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._arm.solve(target, max_solutions=1, q_seed=start)

    def answer(self, solved: Any) -> Any:
        return solved[0].q if solved else None


class All(Ssik):
    """Every answer, one after the other in a row as long as the start, which is not looked at.

    It gives all whole turns inside the limits; those are taken together, untimed.
    """

    def start(self, q: np.ndarray) -> np.ndarray:
        self._row = np.full(len(q), np.nan)
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._arm.solve(target)

    def answer(self, solved: Any) -> Any:
        found = np.array([each.q for each in solved])
        found = np.unique(np.round(found - 2 * np.pi * np.round(found / (2 * np.pi)), 9), axis=0).ravel()
        self._row[: len(found)] = found
        return self._row
