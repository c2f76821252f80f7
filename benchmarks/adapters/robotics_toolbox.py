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
    hold 1e-4 m and 1e-3 rad, and quicker than its default weights of 1 with the same tolerance.
    """

    TOLERANCE = 0.5 * 1e-4**2
    WEIGHTS = (1.0, 1.0, 1.0, 0.01, 0.01, 0.01)

    def __init__(self, arm: dict[str, Any]) -> None:
        links, name, _ = URDF_read(Path(arm["urdf"]))
        self._chain = Robot(links, name=name).ets(start=arm["base"], end=arm["tip"])
        self._weights = np.array(self.WEIGHTS)
        lower, upper = self._chain.qlim
        if not (np.allclose(lower, arm["lower"]) and np.allclose(upper, arm["upper"])):
            raise ValueError(f"it read other joint limits: {lower} .. {upper}")

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._chain.ik_LM(target, q0=start, tol=self.TOLERANCE, mask=self._weights)

    def answer(self, solved: Any) -> np.ndarray:
        return solved.q
