"""EAIK: closed forms of arms with at most six revolute joints that decompose into known subproblems."""

from __future__ import annotations

from typing import Any

import numpy as np
from eaik.IK_URDF import UrdfRobot
from urchin import URDF


class EaikArm:
    """What the rows of EAIK have in common.

    It places the last joint's frame, with axes that are the base's at zero: the target is moved there, untimed. It
    marks answers that only come near as `is_LS` (least squares); they are wrong ones and are passed over.
    """

    def __init__(self, arm: dict[str, Any]) -> None:
        if len(arm["joints"]) > 6:
            raise ValueError(f"it takes at most six joints, and this arm has {len(arm['joints'])}")
        self._robot = UrdfRobot(arm["chain"])
        if not self._robot.hasKnownDecomposition():
            raise ValueError("it knows no decomposition of this arm")
        at_zero = URDF.load(arm["chain"], lazy_load_meshes=True).link_fk()
        tip = next(placement for link, placement in at_zero.items() if link.name == arm["tip"])
        self._tip_to_last = np.linalg.inv(tip) @ self._robot.fwdKin(np.zeros(len(arm["joints"])))
        self._lower, self._upper = np.array(arm["lower"]), np.array(arm["upper"])

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix @ self._tip_to_last

    def start(self, q: np.ndarray) -> np.ndarray:
        return q

    def answer(self, solved: np.ndarray | None) -> np.ndarray | None:
        return solved


class First(EaikArm):
    """The bare closed form: the first answer of `IK`, whatever the limits and the start."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return first_right(self._robot.IK(target))


class Nearest(EaikArm):
    """What a user writes around it: whole turns towards the start, limits, and the answer nearest to the start."""

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        found = self._robot.IK(target)
        q = found.Q[~found.is_LS]
        q += 2 * np.pi * np.round((start - q) / (2 * np.pi))
        q += 2 * np.pi * ((q < self._lower).astype(float) - (q > self._upper))
        q = q[((q >= self._lower) & (q <= self._upper)).all(axis=1)]
        return q[np.abs(q - start).max(axis=1).argmin()] if len(q) else None


class All(EaikArm):
    """Every answer, whatever the limits, one after the other in a row as long as the start, which is not looked at."""

    def start(self, q: np.ndarray) -> np.ndarray:
        self._row = np.full(len(q), np.nan)
        return q

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        found = self._robot.IK(target)
        return found.Q[~found.is_LS]

    def answer(self, solved: np.ndarray) -> np.ndarray:
        self._row[: solved.size] = solved.ravel()
        return self._row


class Many(EaikArm):
    """`IK_batched` over all targets, and the first answer of each."""

    def __init__(self, arm: dict[str, Any], threads: int) -> None:
        super().__init__(arm)
        self._threads = threads

    def targets(self, matrices: np.ndarray) -> np.ndarray:
        return matrices @ self._tip_to_last

    def starts(self, q: np.ndarray) -> np.ndarray:
        return q

    def solve_all(self, targets: np.ndarray, starts: np.ndarray) -> np.ndarray:
        first = np.full(starts.shape, np.nan)
        for row, found in zip(first, self._robot.IK_batched(targets, self._threads), strict=True):
            answer = first_right(found)
            if answer is not None:
                row[:] = answer
        return first

    def answers(self, solved: np.ndarray) -> tuple[np.ndarray, None]:
        return solved, None


def first_right(found: Any) -> np.ndarray | None:
    """The first answer that is not a least-squares one."""
    for q, wrong in zip(found.Q, found.is_LS, strict=True):
        if not wrong:
            return q
    return None
