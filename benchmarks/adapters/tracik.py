"""TRAC-IK, as pytracik binds it."""

from __future__ import annotations

from typing import Any

import numpy as np
from trac_ik import TracIK


class Tracik:
    """`TracIK.ik` as its documentation shows it: solver type "Speed", 5 ms at most.

    Its tolerance holds for each of the six rows of the twist alone, so a tolerance divided by √3 is the loosest
    that keeps the distance within it.
    """

    def __init__(self, arm: dict[str, Any], tolerance: float = 1e-4) -> None:
        self._solver = TracIK(
            arm["base"], arm["tip"], arm["urdf"], timeout=0.005, epsilon=tolerance / 3**0.5, solver_type="Speed"
        )
        # It reads limits in single precision, and would stop up to 1e-7 rad beyond them.
        self._solver.joint_limits = (arm["lower"], arm["upper"])

    def target(self, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return matrix[:3, 3].copy(), matrix[:3, :3].copy()

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: tuple[np.ndarray, np.ndarray], start: np.ndarray) -> Any:
        return self._solver.ik(*target, start)

    def answer(self, solved: Any) -> Any:
        return solved
