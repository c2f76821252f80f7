"""Robotics Toolbox for Python: `ETS.ik_LM`, its solver in C++."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from roboticstoolbox import Robot
from roboticstoolbox.models.URDF.URDFRobot import URDF_read


class RoboticsToolbox:
    """`ik_LM` of the chain's elementary transforms, which is quicker than the robot's method of that name.

    Defaults: method "chan", k = 1, up to 100 searches of 30 iterations, joint limits respected. Its tolerance is
    on E = ½(p² + w r²), position p [m] and rotation r [rad] summed up with weights: those here are the loosest that
    hold the tolerance in metres and ten times that in radians, and quicker than its default weights of 1.
    """

    WEIGHTS = (1.0, 1.0, 1.0, 0.01, 0.01, 0.01)

    def __init__(self, arm: dict[str, Any], tolerance: float = 1e-4) -> None:
        links, name, _ = URDF_read(Path(arm["urdf"]))
        self._chain = Robot(links, name=name).ets(start=arm["base"], end=arm["tip"])
        self._weights = np.array(self.WEIGHTS)
        self._tolerance = 0.5 * tolerance**2
        lower, upper = self._chain.qlim
        if not (np.allclose(lower, arm["lower"]) and np.allclose(upper, arm["upper"])):
            raise ValueError(f"it read other joint limits: {lower} .. {upper}")

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._chain.ik_LM(target, q0=start, tol=self._tolerance, mask=self._weights)

    def answer(self, solved: Any) -> np.ndarray:
        return solved.q


class Forward(RoboticsToolbox):
    """`ETS.eval` of all configurations, in one call."""

    def targets(self, matrices: np.ndarray) -> np.ndarray:
        return matrices

    def starts(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> np.ndarray:
        return self._chain.eval(starts)

    def answers(self, solved: np.ndarray) -> tuple[np.ndarray, None]:
        return solved, None
