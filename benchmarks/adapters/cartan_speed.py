"""cartan: `solve_ik_speed`, projected Levenberg-Marquardt with restarts, in C++."""

from __future__ import annotations

from typing import Any

import cartan
import numpy as np


class Cartan:
    """`solve_ik_speed`, the fastest of its solvers, with its own budget of iterations.

    It takes files with one leaf and without massless inertias, so it reads the arm alone.
    """

    def __init__(self, arm: dict[str, Any], tolerance: float = 1e-4) -> None:
        loaded = cartan.load_urdf(arm["chain"])
        self._chain = loaded.chain
        if loaded.metadata.joint_names != arm["joints"]:
            raise ValueError(f"it read other joints: {loaded.metadata.joint_names}")
        self._config = cartan.IkConfig(position_tol=tolerance, orientation_tol=10 * tolerance)

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return cartan.solve_ik_speed(self._chain, cartan.SE3.from_matrix(target), start, self._config).q

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved
