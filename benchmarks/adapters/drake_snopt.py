"""Drake: its InverseKinematics program, solved by SNOPT."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.math import RotationMatrix
from pydrake.multibody.inverse_kinematics import InverseKinematics
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.solvers import SnoptSolver, SolverOptions


class Drake:
    """A position and an orientation constraint, joint limits as bounds, no cost.

    A program belongs to its target and is made beforehand, which is not timed. The bounds leave SNOPT room for the
    violations that it allows itself. It has no restarts of its own: one solve from the given start.
    """

    POSITION, ORIENTATION = 5e-5, 5e-4  # [m] each axis, [rad]

    def __init__(self, arm: dict[str, Any]) -> None:
        self._plant = MultibodyPlant(time_step=0.0)
        parser = Parser(self._plant)
        parser.AddModels(arm["urdf"])
        base = self._plant.world_frame()
        if arm["base"] != "world":
            base = self._plant.GetFrameByName(arm["base"])
            self._plant.WeldFrames(self._plant.world_frame(), base)
        self._plant.Finalize()
        self._base, self._tip = base, self._plant.GetFrameByName(arm["tip"])
        joints = [self._plant.GetJointByName(joint) for joint in arm["joints"]]
        self._places = [joint.position_start() for joint in joints]
        self._context = self._plant.CreateDefaultContext()
        for index in self._plant.GetJointIndices():
            joint = self._plant.get_joint(index)
            if joint.num_positions() and joint.name() not in arm["joints"]:
                joint.Lock(self._context)
        self._rest = self._plant.GetPositions(self._context)
        self._solver = SnoptSolver()
        self._options = SolverOptions()
        self._options.SetOption(SnoptSolver.id(), "Major feasibility tolerance", 1e-7)

    def target(self, matrix: np.ndarray) -> InverseKinematics:
        program = InverseKinematics(self._plant, self._context)
        place = matrix[:3, 3]
        program.AddPositionConstraint(self._tip, np.zeros(3), self._base, place - self.POSITION, place + self.POSITION)
        program.AddOrientationConstraint(
            self._base, RotationMatrix(matrix[:3, :3]), self._tip, RotationMatrix(), self.ORIENTATION
        )
        return program

    def start(self, q: np.ndarray) -> np.ndarray:
        whole = self._rest.copy()
        whole[self._places] = q
        return whole

    def solve(self, target: InverseKinematics, start: np.ndarray) -> Any:
        return self._solver.Solve(target.prog(), start, self._options).get_x_val()

    def answer(self, solved: np.ndarray) -> np.ndarray:
        return solved[self._places]
