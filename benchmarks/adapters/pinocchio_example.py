"""Pinocchio's own example of inverse kinematics (CLIK), as its documentation has it, and its forward kinematics."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio
from numpy.linalg import norm, solve


class PinocchioExample:
    """The example's loop with its constants; it knows no limits and no restarts.

    The example places a joint, so the target is moved from the tip to the joint that carries it, untimed.
    """

    EPS, IT_MAX, DT, DAMP = 1e-4, 1000, 1e-1, 1e-12

    def __init__(self, arm: dict[str, Any]) -> None:
        self._model = pinocchio.buildModelFromUrdf(arm["urdf"])
        self._data = self._model.createData()
        tip = self._model.frames[self._model.getFrameId(arm["tip"], pinocchio.BODY)]
        self._joint, self._tip_to_joint = tip.parentJoint, tip.placement.inverse()
        self._places = [self._model.joints[self._model.getJointId(joint)].idx_q for joint in arm["joints"]]

    def target(self, matrix: np.ndarray) -> pinocchio.SE3:
        return pinocchio.SE3(matrix) * self._tip_to_joint

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = pinocchio.neutral(self._model)
        whole[self._places] = q
        return whole

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        model, data, joint, q = self._model, self._data, self._joint, start
        for _ in range(self.IT_MAX + 1):
            pinocchio.forwardKinematics(model, data, q)
            away = data.oMi[joint].actInv(target)
            error = pinocchio.log(away).vector
            if norm(error) < self.EPS:
                break
            J = pinocchio.computeJointJacobian(model, data, q, joint)
            J = -np.dot(pinocchio.Jlog6(away.inverse()), J)
            v = -J.T.dot(solve(J.dot(J.T) + self.DAMP * np.eye(6), error))
            q = pinocchio.integrate(model, q, v * self.DT)
        return q

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved[self._places]


class Forward(PinocchioExample):
    """`forwardKinematics` and `updateFramePlacement`, one configuration a call."""

    def __init__(self, arm: dict[str, Any]) -> None:
        super().__init__(arm)
        self._frame = self._model.getFrameId(arm["tip"], pinocchio.BODY)

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        pinocchio.forwardKinematics(self._model, self._data, start)
        return pinocchio.updateFramePlacement(self._model, self._data, self._frame).homogeneous

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved
