"""pinik: `solve`, what `prepare` makes, and `solve_many`, with their defaults."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pinocchio

import pinik


class PinikArm:
    """What the rows of pinik have in common: the robot, and its whole configurations."""

    def __init__(self, arm: dict[str, Any], method: str) -> None:
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        self._robot = pinik.load(arm["urdf"])
        self._tip, self._method = arm["tip"], method
        self._places = [self._robot.model.joints[self._robot.model.getJointId(name)].idx_q for name in arm["joints"]]

    def target(self, matrix: np.ndarray) -> pinocchio.SE3:
        return pinocchio.SE3(matrix)

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = self._robot.neutral()
        whole[self._places] = q
        return whole

    def answer(self, q: np.ndarray) -> np.ndarray:
        return q[self._places]


class Solve(PinikArm):
    """`robot.solve` from the given start."""

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        return self._robot.solve(self._tip, placement=target, method=self._method, q0=start).q


class SolveFromOwnStarts(PinikArm):
    """`robot.solve` from a start that pinik chooses near the target."""

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        return self._robot.solve(self._tip, placement=target, method=self._method, q0="nearest").q


class SolvePrepared(PinikArm):
    """A question prepared once, called with a placement and the given start."""

    def __init__(self, arm: dict[str, Any], method: str) -> None:
        super().__init__(arm, method)
        self._ask = pinik.prepare(self._robot, pinik.Target(self._tip, placement=np.eye(4)), method)

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        return self._ask(target, start).q


class SolveMany(PinikArm):
    """`pinik.solve_many` over all targets at once, from the given starts."""

    def __init__(self, arm: dict[str, Any], method: str, threads: int) -> None:
        super().__init__(arm, method)
        self._threads, self._solve_many = threads, pinik.solve_many

    def targets(self, matrices: list[np.ndarray]) -> np.ndarray:
        return np.array(matrices)

    def starts(self, q: np.ndarray) -> np.ndarray:
        whole = np.tile(self._robot.neutral(), (len(q), 1))
        whole[:, self._places] = q
        return whole

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> Any:
        return self._solve_many(self._robot, self._tip, targets, q0=starts, threads=self._threads, method=self._method)

    def answers(self, solved: Any) -> tuple[list[list[float]], np.ndarray]:
        return solved.q[:, self._places].tolist(), solved.time
