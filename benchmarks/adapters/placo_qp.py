"""PlaCo: quadratic programs of its kinematics solver, step after step."""

from __future__ import annotations

from typing import Any

import numpy as np
import placo


class Placo:
    """The documented loop: `solver.solve(True)`, `robot.update_kinematics()`, until the task's errors are small.

    One soft frame task, joint limits on, velocity limits off, a little regularization as its documentation advises.
    It has no restarts of its own: 100 steps from the given start.
    """

    STEPS = 100

    def __init__(self, arm: dict[str, Any]) -> None:
        self._robot = placo.RobotWrapper(arm["urdf"], placo.Flags.ignore_collisions)
        self._solver = placo.KinematicsSolver(self._robot)
        self._solver.mask_fbase(True)
        self._solver.enable_joint_limits(True)
        self._solver.enable_velocity_limits(False)
        self._task = self._solver.add_frame_task(arm["tip"], np.eye(4))
        self._task.configure("tip", "soft", 1.0, 1.0)
        self._solver.add_regularization_task(1e-6)
        for joint in self._robot.joint_names():
            if joint not in arm["joints"]:
                self._solver.mask_dof(joint)
        self._places = [self._robot.get_joint_offset(joint) for joint in arm["joints"]]
        self._q = self._robot.neutral_state().q
        self._position, self._orientation = self._task.position(), self._task.orientation()

    def target(self, matrix: np.ndarray) -> np.ndarray:
        return matrix

    def start(self, q: np.ndarray) -> np.ndarray:
        self._q[self._places] = q
        return self._q.copy()

    def solve(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        robot, solver = self._robot, self._solver
        robot.state.q = start
        self._task.T_world_frame = target
        robot.update_kinematics()
        for _ in range(self.STEPS):
            solver.solve(True)
            robot.update_kinematics()
            if self._position.error_norm() < 1e-4 and self._orientation.error_norm() < 1e-3:
                break
        return robot.state.q

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved[self._places]
