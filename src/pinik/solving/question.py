"""A question: compiled targets with the options to solve for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..model.limits import Limits
from ..model.robot_model import RobotModel
from ..problem.problem import Problem
from ..problem.reach import Bounds, bounds_of
from ..problem.targets import Target
from ..shapes.collisions import Guard
from ..solvers.base import JacobianSolver, Solver
from .options import Options

__all__ = ["Question", "check_joint_names"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Question:
    """Compiled targets with the options to solve for them. A question never changes, so any thread may read it.

    Attributes:
        problem: The targets, compiled.
        options: The options.
        limits: The joint limits, enabled or disabled according to the options.
        guard: Finds what touches of what must not; None if nothing is to be avoided.
    """

    problem: Problem
    options: Options
    limits: Limits
    guard: Guard | None = None

    @classmethod
    def of(cls, robot: RobotModel, targets: Target | Sequence[Target], options: Options) -> Question:
        """Compile a question.

        Raises:
            UnknownNameError: There is no such frame or joint.
            InputError: The method cannot solve for these targets, or a joint named in its parameters cannot be set; or
                something is to be avoided, and the robot has no collision shapes.
            MissingExtraError: Collision shapes are meshes, and trimesh, which reads them, is not installed.
        """
        if not isinstance(robot, RobotModel):
            raise InputError(f"robot must be what pinik.load returns; got {robot!r}")
        solver = options.method
        check_joint_names(robot, solver)
        for name in options.choose_weights:
            robot.settable_joint(name)
        at_target = isinstance(solver, JacobianSolver) and solver.target_jacobian
        problem = Problem(
            robot,
            targets,
            locked=(*options.locked, *solver.held),
            target_jacobian=at_target,
            tolerance=options.tolerance,
        )
        solver.check(problem)
        guard = options.avoid.guard(robot, options.engine)
        return cls(problem, options, Limits.of(robot, options.limits), guard)

    @property
    def robot(self) -> RobotModel:
        """The robot."""
        return self.problem.robot

    @property
    def solver(self) -> Solver:
        """The method with its parameters."""
        return self.options.method

    def touches(self, q: Array) -> bool:
        """Whether anything that is to be avoided touches at q (nq,)."""
        return self.guard is not None and self.guard.touches(q)

    def active_limits(self, q: Array) -> dict[str, str]:
        """Joint name → "lower", "upper" or "both", for the joints at a limit that can move a target."""
        free, robot = self.problem.free, self.robot
        return {name: side for name, side in self.limits.active(q).items() if free[robot.joint(name).idx_v]}

    @cached_property
    def bounds(self) -> list[Bounds | None]:
        """The bounds on the distance of each target's frame from the first joint of its chain."""
        return bounds_of(self.problem, self.limits)


def check_joint_names(robot: RobotModel, solver: Solver) -> None:
    """Check that the joints named in a solver's parameters exist, can be set, and have an angle if one is given."""
    for parameter, value in solver.parameters.items():
        if isinstance(value, Mapping):
            for name in value:
                joint = robot.settable_joint(name)
                if parameter == "rest_posture" and not joint.has_one_axis:
                    raise InputError(f"rest_posture: joint {name!r} must have one axis; it is {joint.kind}")
