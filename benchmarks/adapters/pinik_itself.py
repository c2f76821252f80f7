"""pinik: `solve`, what `prepare` makes, `track`, `solve_many` and `placements`."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import pinik


class PinikArm:
    """What the rows of pinik have in common: the robot, its whole configurations, and options that differ."""

    def __init__(self, arm: dict[str, Any], method: str | None = None, tolerance: float | None = None) -> None:
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        self._robot = pinik.load(arm["urdf"])
        self._tip = arm["tip"]
        self._places = [self._robot.model.joints[self._robot.model.getJointId(name)].idx_q for name in arm["joints"]]
        self._options: dict[str, Any] = {}
        if method is not None:
            self._options["method"] = method
        if tolerance is not None:
            self._options["tolerance"] = (tolerance, 10 * tolerance)

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = self._robot.neutral()
        whole[self._places] = q
        return whole

    def answer(self, q: np.ndarray) -> np.ndarray:
        return q[self._places]

    def targets(self, matrices: np.ndarray) -> np.ndarray:
        return matrices

    def starts(self, q: np.ndarray) -> np.ndarray:
        whole = np.tile(self._robot.neutral(), (len(q), 1))
        whole[:, self._places] = q
        return whole


class Solve(PinikArm):
    """`robot.solve` from the given start, with its defaults."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._robot.solve(self._tip, placement=target, q0=start).q


class SolveWithOptions(PinikArm):
    """`robot.solve` from the given start, with a method or a tolerance."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._robot.solve(self._tip, placement=target, q0=start, **self._options).q


class SolveFromOwnStarts(PinikArm):
    """`robot.solve` from a start that pinik chooses near the target."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._robot.solve(self._tip, placement=target, q0="nearest").q


class SolvePrepared(PinikArm):
    """A question prepared once, called with a placement and the given start."""

    def __init__(self, arm: dict[str, Any], tolerance: float | None = None) -> None:
        super().__init__(arm, tolerance=tolerance)
        self._ask = pinik.prepare(self._robot, pinik.Target(self._tip, placement=np.eye(4)), **self._options)

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        return self._ask(target, start).q


class SolveMany(PinikArm):
    """`pinik.solve_many` over all targets at once, from the given starts."""

    def __init__(self, arm: dict[str, Any], threads: int) -> None:
        super().__init__(arm)
        self._threads, self._solve_many = threads, pinik.solve_many

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> Any:
        return self._solve_many(self._robot, self._tip, targets, q0=starts, threads=self._threads)

    def answers(self, solved: Any) -> tuple[np.ndarray, np.ndarray]:
        return solved.q[:, self._places], solved.time


class Track(PinikArm):
    """`pinik.track` along the whole path, in one call."""

    def __init__(self, arm: dict[str, Any]) -> None:
        super().__init__(arm)
        self._track = pinik.track

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> np.ndarray:
        return self._track(self._robot, self._tip, targets, starts[0]).q

    def answers(self, solved: np.ndarray) -> tuple[np.ndarray, None]:
        return solved[:, self._places], None


class Placement(PinikArm):
    """`robot.placement`, one configuration a call."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> Any:
        return self._robot.placement(self._tip, start)

    def answer(self, solved: Any) -> np.ndarray:
        return solved.homogeneous


class Placements(PinikArm):
    """`robot.placements` of all configurations, in one call."""

    def __init__(self, arm: dict[str, Any]) -> None:
        super().__init__(arm)
        self._placements = self._robot.placements

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> np.ndarray:
        return self._placements(self._tip, starts)

    def answers(self, solved: np.ndarray) -> tuple[np.ndarray, None]:
        return solved, None
