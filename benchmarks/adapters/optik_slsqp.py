"""OptIK: SLSQP on an error in SE(3), with random restarts, in Rust."""

from __future__ import annotations

from typing import Any

import numpy as np
import optik


class Optik:
    """`Robot.ik` in the mode "speed".

    Its objective is p² + r², position p [m] and rotation r [rad], so the tolerance holds for both. Weights that let
    the rotation be ten times as far off make it slower.
    """

    def __init__(self, arm: dict[str, Any], threads: int, tolerance: float = 1e-4) -> None:
        self._robot = optik.Robot.from_urdf_file(arm["urdf"], arm["base"], arm["tip"])
        self._robot.set_parallelism(threads)
        lower, upper = self._robot.joint_limits()
        if not (np.allclose(lower, arm["lower"]) and np.allclose(upper, arm["upper"])):
            raise ValueError(f"it read other joint limits: {lower} .. {upper}")
        self._config = optik.SolverConfig(solution_mode="speed", tol_f=tolerance**2)

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._robot.ik(self._config, target, start)

    def answer(self, solved: Any) -> Any:
        return solved[0]
