"""frankik: the analytic solution of the Franka arm, for sampled values of its seventh joint."""

from __future__ import annotations

from typing import Any

import numpy as np
from frankik import FrankaKinematics, RobotType


class Frankik:
    """`FrankaKinematics.inverse` from the given start; the answer nearest to it among those found.

    It places panda_link8, although its `forward` answers with the hand's tool frame.
    """

    def __init__(self, arm: dict[str, Any], **sampling: Any) -> None:
        if arm["name"] != "panda":
            raise ValueError("it knows the Franka arms alone")
        self._arm, self._sampling = FrankaKinematics(RobotType.PANDA), sampling

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return self._arm.inverse(target, q0=start, **self._sampling)

    def answer(self, solved: np.ndarray | None) -> np.ndarray | None:
        return solved
