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
    on E = ½(p² + r²), position p [m] and rotation r [rad] summed up; ½(1e-4)² is the loosest that holds 1e-4 m.
    """

    TOLERANCE = 0.5 * 1e-4**2

    def __init__(self, arm: dict[str, Any]) -> None:
        links, name, _ = URDF_read(Path(arm["urdf"]))
        self._chain = Robot(links, name=name).ets(start=arm["base"], end=arm["tip"])
        lower, upper = self._chain.qlim
        if not (np.allclose(lower, arm["lower"]) and np.allclose(upper, arm["upper"])):
            raise ValueError(f"it read other joint limits: {lower} .. {upper}")

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._chain.ik_LM(target, q0=start, tol=self.TOLERANCE)

    def answer(self, solved: Any) -> np.ndarray:
        return solved.q
