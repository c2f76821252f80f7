"""Pink: quadratic programs of weighted tasks, step after step."""

from __future__ import annotations

from typing import Any

import numpy as np
import pink
import pinocchio
from pink.limits import ConfigurationLimit
from pink.tasks import FrameTask


class Pink:
    """The documented loop, `solve_ik` and `integrate_inplace`, until the task's error is small.

    It is a velocity controller: here its steps are whole ones (dt = 1 s, no velocity limits), its QP solver is DAQP,
    and joints beside the arm are taken out of the model. It has no restarts of its own: 100 steps from the start.
    """

    STEPS = 100
    DT = 1.0  # [s]

    def __init__(self, arm: dict[str, Any]) -> None:
        model = pinocchio.buildModelFromUrdf(arm["urdf"])
        others = [i for i in range(1, model.njoints) if model.names[i] not in arm["joints"]]
        self._model = pinocchio.buildReducedModel(model, others, pinocchio.neutral(model))
        self._data = self._model.createData()
        self._task = FrameTask(arm["tip"], position_cost=1.0, orientation_cost=1.0, lm_damping=1e-2)
        self._limits = [ConfigurationLimit(self._model)]
        self._places = [self._model.joints[self._model.getJointId(joint)].idx_q for joint in arm["joints"]]

    def target(self, matrix: np.ndarray) -> pinocchio.SE3:
        return pinocchio.SE3(matrix)

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = np.empty(self._model.nq)
        whole[self._places] = q
        return whole

    def solve(self, target: pinocchio.SE3, start: np.ndarray) -> np.ndarray:
        configuration = pink.Configuration(self._model, self._data, start)
        self._task.set_target(target)
        tasks = [self._task]
        for _ in range(self.STEPS):
            velocity = pink.solve_ik(
                configuration, tasks, self.DT, solver="daqp", limits=self._limits, safety_break=False
            )
            configuration.integrate_inplace(velocity, self.DT)
            error = self._task.compute_error(configuration)
            if np.linalg.norm(error[:3]) < 1e-4 and np.linalg.norm(error[3:]) < 1e-3:
                break
        return configuration.q

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved[self._places]
